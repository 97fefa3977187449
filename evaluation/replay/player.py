"""Replay of one service on its recorded inputs, in lockstep, on a bus in memory."""

import re
from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from math import inf
from typing import Any, TypeVar

import msgspec

from common import messages as m
from common import topics
from common.bus.mailbox import UNSTAMPED
from common.bus.memory import MemoryBus, MemoryIo
from common.household import Household
from common.recording import Recording, Row
from common.scene import Scene
from common.time.clock import ManualClock
from common.time.lockstep import DT, period_of
from common.topic import Topic

M = TypeVar("M", bound=m.Message)
UNRECORDED = 50
"""Ticks: what was heard that long before the next recorded message came before the recorder."""
RANDOM_ID, SEEDED_ID = re.compile(r"[A-Za-z]+-[0-9a-f]{8}$"), re.compile(r"[A-Za-z]+(-[0-9]+)+$")


class Alive(msgspec.Struct):
    alive: bool


class ReplayIo(MemoryIo):
    """The service's `Io` in a replay: collects what it publishes, takes peers and ids from the recording.

    `ids`: in the order they were made; `seeded`: they end as the seed says, after lockstep.
    """

    def __init__(
        self, *args: Any, ids: list[str], seeded: bool, peers: Iterator[tuple[float, str, str | None]], **kw: Any
    ) -> None:
        self.outputs: list[tuple[float, str, bytes]] = []
        self.first: dict[str, float] = {}
        self._known_ids, self._seeded = ids, seeded
        self._changes, self._next = peers, next(peers, None)
        self._present: dict[str, str] = {}
        super().__init__(*args, **kw)

    def _send(self, topic: Topic[Any], payload: bytes) -> None:
        stamp = self.tick if self.out_stamp is None else self.out_stamp
        self.outputs.append((max(0, stamp) * DT, topic.key, payload))

    def peer(self, name: str) -> str | None:
        while self._next is not None and self._next[0] <= self.clock.now():
            _, who, epoch = self._next
            if epoch is None:
                self._present.pop(who, None)
            else:
                self._present[who] = epoch or self._present.get(who, "")
            self._next = next(self._changes, None)
        return self._present.get(name)

    def has_subscribers(self, topic: Topic[Any]) -> bool:
        """True from the topic's first recorded message on: somebody subscribed by then."""
        return topic.keep != "latest" or self.clock.now() > self.first.get(topic.key, inf) - DT / 2

    def new_id(self, prefix: str) -> str:
        if not self._seeded:
            return self._known_ids.pop(0) if self._known_ids else super().new_id(prefix)
        made = super().new_id(prefix)
        tail = made.removeprefix(prefix)
        return next((i for i in self._known_ids if i.startswith(f"{prefix}-") and i.endswith(tail)), made)


class Player:
    """Steps a service through a recording."""

    def __init__(
        self,
        kind: Any,
        parameters: Any,
        recording: Recording,
        household: Household,
        seed: int,
        world: Scene | None = None,
    ) -> None:
        self.kind, self.recording = kind, recording
        run = recording.facts.get("run", {})
        self.lockstep = run.get("lockstep") == "true"
        self.bus, self.clock = MemoryBus(), ManualClock()
        name = kind.NAME
        self._acks = [a for a in _messages(recording, "sim/ack", m.LockstepAck) if a.name == name and a.tick >= 0]
        self._ticks = self._due()
        self._rows = self._inputs()
        first = self._ticks[0] if self._ticks else 0
        self.clock.advance(max(0, first - 1) * DT if first > 1 else 0.0)
        self.io = ReplayIo(
            self.bus, kind.NAME, kind.READS, kind.WRITES, household=household, world=world, seed=seed, clock=self.clock,
            log_level="error", ids=list(self._ids()), seeded=self.lockstep, peers=_peers(recording),
        )  # fmt: skip
        self.io.robot = run.get("namespace", "")
        self.io.first = {key: span.first for key, span in recording.spans.items()}
        if first > 2 * period_of(kind.HZ):  # the recording starts in the middle of a run
            self.io.tick = first - 1
        self._sim = hasattr(kind, "pace")
        if self._sim:
            self.io.out_stamp = 0
        self.service = kind(parameters, self.io)

    @property
    def seconds(self) -> float:
        """Robot time that the replay covers [s]."""
        return (self._ticks[-1] - self._ticks[0]) * DT if self._ticks else 0.0

    def covers(self, row: Row) -> bool:
        """True when the recording has all outputs of this output's step; without a tick it is a client's message."""
        if not self.lockstep:
            return True
        last = self._ticks[-1] if self._ticks else 0
        return row.tick is not None and row.tick <= self._stamp_at(last)

    def _stamp_at(self, tick: int) -> int:
        """The tick that outputs of a step carry: the simulation's step makes the state of the next one."""
        return tick - 1 if self._sim else tick

    @property
    def exact(self) -> bool:
        """True when the replay sees every input in the same step: it has its tick, or who heard it said when."""
        return self.lockstep and all(row.tick is not None for row in self._rows)

    def _due(self) -> list[int]:
        """The ticks in which the recorded process stepped."""
        recording = self.recording
        if self.lockstep and not hasattr(self.kind, "pace"):
            return sorted({ack.tick for ack in self._acks})
        clocks = _messages(recording, "sim/clock", m.SimClockTick)
        ticks = sorted({c.tick if c.tick >= 0 else round(c.t / DT) for c in clocks})
        if not ticks and recording.rows:
            ticks = list(range(round(recording.rows[0].t / DT), round(recording.rows[-1].t / DT) + 1))
        period = period_of(self.kind.HZ)
        return [tick for tick in ticks if tick % period == 0]

    def _inputs(self) -> list[Row]:
        """What the service reads, in the order of its ticks; what a client put has the tick before its hearing."""
        steps: dict[str, deque[int]] = defaultdict(deque)
        for tick, heard in sorted({ack.tick: ack.heard for ack in self._acks}.items()):
            for key in heard:
                steps[key].append(tick - 1)
        reads, rows = {t.key for t in self.kind.READS}, []
        for row in self.recording.rows:
            if row.key not in reads:
                continue
            if row.tick is None:
                waiting = steps[row.key]
                while waiting and waiting[0] < self._stamp(row) - UNRECORDED:
                    waiting.popleft()
                row = msgspec.structs.replace(row, tick=waiting.popleft() if waiting else None)
            rows.append(row)
        return sorted(rows, key=self._stamp)

    def _ids(self) -> Iterator[str]:
        """Ids that the recorded process made up, in the order they first appeared."""
        pattern, seen = SEEDED_ID if self.lockstep else RANDOM_ID, set[str]()
        writes = {t.key for t in self.kind.WRITES}
        for row in self.recording.rows:
            if row.key in writes and not row.junk:
                found = msgspec.json.decode(row.payload)
                if not isinstance(found, dict):
                    continue
                for field in ("mission_id", "id", "goal_id"):
                    word = str(found.get(field, "")).split(".")[0]
                    if pattern.match(word) and word not in seen:
                        seen.add(word)
                        yield word

    def run(self, progress: Callable[[float], None] = lambda t: None) -> list[tuple[float, str, bytes]]:
        """Step through the whole recording; what the service published: (time, key, payload)."""
        rows = iter(self._rows)
        waiting = next(rows, None)
        for tick in self._ticks:
            while waiting is not None and self._stamp(waiting) < tick:
                self.bus.put(topics.BY_KEY[waiting.key], waiting.payload, self._stamp(waiting))
                waiting = next(rows, None)
            self.io.out_stamp = stamp = self._stamp_at(tick)
            now = stamp * DT
            self.clock.advance(tick * DT - self.clock.now())
            # In lockstep the simulation works out a tick while the others are at the one before.
            self.io.begin(stamp if self.lockstep else tick, now)
            self.service.step(now)
            progress(now)
        return self.io.outputs

    @staticmethod
    def _stamp(row: Row) -> int:
        return row.tick if row.tick is not None else max(UNSTAMPED, round(row.t / DT) - 1)

    def close(self) -> None:
        if hasattr(self.service, "close"):
            self.service.close()
        self.io.shutdown()


def _messages(recording: Recording, key: str, kind: type[M]) -> list[M]:
    return [msgspec.json.decode(row.payload, type=kind) for row in recording.of(key) if not row.junk]


def _peers(recording: Recording) -> Iterator[tuple[float, str, str | None]]:
    """(time, service, epoch): "" when its token was seen, None when it was lost."""
    for row in recording.rows:
        parts = row.key.split("/")
        if parts[0] != "service" or row.junk:
            continue
        if parts[-1] == "alive":
            yield row.t, parts[1], "" if msgspec.json.decode(row.payload, type=Alive).alive else None
        elif parts[-1] == "health":
            yield row.t, parts[1], msgspec.json.decode(row.payload, type=m.Health).epoch
