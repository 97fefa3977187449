"""The transport-independent half of `Io`: mailboxes, the worker, ids, randomness, drop counts.

In lockstep every message is stamped with the tick in which it was published and becomes visible to steps of
later ticks only, so that what a step sees does not depend on which process ran first.
"""

import hashlib
import uuid
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Required, TypedDict, TypeVar, Unpack

import numpy as np

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.mailbox import Mailbox
from common.bus.port import Handler, Outside
from common.bus.worker import WORKER_LIMIT, WorkerJob
from common.household import Household
from common.household_edits import edited
from common.logs import Logger
from common.scene import Scene
from common.time.clock import Clock, ManualClock, monotonic
from common.topic import Topic

M = TypeVar("M", bound=m.Message)
R = TypeVar("R")


class Setting(TypedDict, total=False):
    """What an `Io` is made with: the household, the clock, and the seed of its randomness.

    Unless told otherwise: lockstep on a clock of its own, seed 0, no knowledge of the world, errors alone in the log.
    """

    household: Required[Household]
    world: Scene | None
    seed: int
    lockstep: bool
    clock: Clock
    log_level: str


class IoBase:
    """The part of `Io` that is the same on every bus; subclasses add `_send`, `serve` and `peer`."""

    state_dir: Path | None = None
    outside: Outside | None = None
    robot = ""
    _edits: m.HouseholdEdits | None = None

    def __init__(
        self,
        name: str,
        reads: Iterable[Topic[Any]],
        writes: Iterable[Topic[Any]],
        **setting: Unpack[Setting],
    ) -> None:
        self.name, self.seed = name, setting.get("seed", 0)
        self.lockstep, self.clock = setting.get("lockstep", True), setting.get("clock") or ManualClock()
        self._world = setting.get("world")
        self.epoch = uuid.uuid4().hex[:12]
        digest = hashlib.sha256(f"{self.seed}/{name}".encode()).digest()
        self.rng = np.random.default_rng(int.from_bytes(digest[:8], "little"))
        self.log = Logger(name, self.clock, setting.get("log_level", "error"), self._send_log)
        self.drops: Counter[str] = Counter()
        self.tick = 0
        self._boxes: dict[str, Mailbox[Any]] = {t.key: Mailbox(t, self.lockstep) for t in reads}
        self._open_order = tuple(self._boxes.values())
        self.household = setting["household"]
        self.fresh = False
        self.unstamped: list[str] = []
        self._writes = {t.key for t in writes}
        self._worker: ThreadPoolExecutor | None = None
        self._ids = 0
        self._foreign: dict[tuple[str, str], tuple[bytes, Any]] = {}
        self._warned: dict[str, float] = {}

    @property
    def household(self) -> Household:
        """What the robot was told of its home; for services that read the edits, with what people have told since."""
        box = self._boxes.get(topics.HOUSEHOLD_EDITS.key)
        edits = self.latest(topics.HOUSEHOLD_EDITS) if box is not None else None
        if edits is not None and edits is not self._edits:
            self._edits, self._household = edits, edited(self.loaded, edits)
        return self._household

    @household.setter
    def household(self, loaded: Household) -> None:
        self.loaded, self._edits = loaded, None
        self._household = edited(loaded, m.HouseholdEdits())

    def amend(self, edits: m.HouseholdEdits) -> None:
        """Apply edits to `household`, for the service that publishes them."""
        self._edits, self._household = edits, edited(self.loaded, edits)

    @property
    def world(self) -> Scene:
        """The world as it really is, for the simulation and its judges alone.

        Raises:
            LookupError: this process is neither.
        """
        if self._world is None:
            raise LookupError(f"{self.name} is not told what the world is made of; it has to look")
        return self._world

    @world.setter
    def world(self, changed: Scene) -> None:
        self._world = changed

    # --- reading
    def begin(self, tick: int | None, now: float) -> None:
        """Start a step: what was published before `tick` becomes visible; `unstamped`: keys of what had no stamp."""
        if tick is not None:
            self.tick = tick
        self.fresh = False
        self.unstamped.clear()
        for box in self._open_order:
            if not box.waiting:
                continue
            self.fresh = True
            self.unstamped += [box.topic.key] * box.open(tick if self.lockstep else None, now)
            if box.overflow:
                lost, box.overflow = box.overflow, 0
                self.count_drop(box.topic.key, f"{lost} messages over the queue limit", lost)

    def take_all(self, topic: Topic[M]) -> list[M]:
        box: Mailbox[M] = self._boxes[topic.key]
        messages: list[M] = []
        if not (payloads := box.take()):
            return messages
        if topic.keep == "latest":
            # A payload that is none must not bring the one before it a second time.
            return [one] if (one := self.latest(topic)) is not None and box.sound else messages
        for payload in payloads:
            try:
                messages.append(codec.decode(topic, payload))
            except codec.DecodeError as error:
                self.count_drop(topic.key, str(error))
        if topic.command and messages:
            self._note_mission(messages[-1])
        return messages

    def latest(self, topic: Topic[M]) -> M | None:
        box: Mailbox[M] = self._boxes[topic.key]
        try:
            return box.newest()
        except codec.DecodeError as error:
            self.count_drop(topic.key, str(error))
            return box.newest()

    def age(self, topic: Topic[M], now: float) -> float:
        # Decoded first: what is no message keeps nothing fresh.
        if topic.keep == "latest":
            self.latest(topic)
        return now - self._boxes[topic.key].received_at

    def _note_mission(self, message: m.Message) -> None:
        mission, dot, _ = str(getattr(message, "id", "")).partition(".")
        if dot:
            self.log.mission = mission

    # --- writing
    def publish(self, topic: Topic[M], message: M) -> None:
        if topic.key not in self._writes:
            raise ValueError(f"{self.name} does not declare {topic.key} in WRITES")
        self._send(topic, codec.encode(topic, message))

    def _send(self, topic: Topic[Any], payload: bytes) -> None:
        raise NotImplementedError

    def _send_log(self, record: m.LogRecord) -> None:
        """Where log records go beside stderr."""

    def others(self, topic: Topic[M]) -> dict[str, M]:
        """The newest message of every other robot on the router, by its name."""
        found: dict[str, M] = {}
        for name, payload in self._abroad(topic).items():
            known = self._foreign.get((topic.key, name))
            if known is None or known[0] is not payload:
                try:
                    known = payload, codec.decode(topic, payload)
                except codec.DecodeError as error:
                    known = payload, None
                    self.count_drop(f"{name}/{topic.key}", str(error))
                self._foreign[topic.key, name] = known
            if known[1] is not None:
                found[name] = known[1]
        return found

    def beside(self, robot: str) -> "IoBase":
        """An `Io` of this service in the namespace of another robot."""
        raise NotImplementedError

    def _abroad(self, topic: Topic[Any]) -> dict[str, bytes]:
        """The newest payload of every other robot, by its name."""
        raise NotImplementedError

    def serve(self, key: str, handler: Handler) -> None:
        raise NotImplementedError

    def ask(self, key: str, request: bytes = b"") -> WorkerJob[bytes | None]:
        raise NotImplementedError

    def peer(self, name: str) -> str | None:
        raise NotImplementedError

    def has_subscribers(self, topic: Topic[Any]) -> bool:
        """True when somebody subscribes to what this process publishes there."""
        raise NotImplementedError

    def demand(self, topic: Topic[Any], wanted: bool) -> None:
        raise NotImplementedError

    # --- the rest
    def submit(self, fn: Callable[..., R], *args: Any, seconds: float = 0.2) -> WorkerJob[R]:
        if self._worker is None:
            self._worker = ThreadPoolExecutor(1, thread_name_prefix=f"{self.name}-worker")
        return WorkerJob(self._worker.submit(fn, *args), self.clock.now() + seconds, self.lockstep)

    def dispose(self, fn: Callable[[], None]) -> None:
        if self._worker is not None:
            self._worker.submit(fn).result(WORKER_LIMIT)

    def new_id(self, prefix: str) -> str:
        self._ids += 1
        unique = f"{self.seed}-{self._ids}" if self.lockstep else f"{uuid.uuid4().hex[:8]}"
        return f"{prefix}-{unique}"

    def count_drop(self, key: str, reason: str, number: int = 1) -> None:
        self.drops[key] += number
        now = monotonic()
        if now - self._warned.get(key, float("-inf")) >= 1.0:
            self._warned[key] = now
            self.log.warning("dropped", key=key, reason=reason, total=self.drops[key])

    def shutdown(self) -> None:
        if self._worker is not None:
            self._worker.shutdown(wait=False, cancel_futures=True)
