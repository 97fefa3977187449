"""One service on a memory bus, stepped by hand: the harness of every test that runs a service without processes."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from common import messages as m
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.household import Household
from common.scene import Scene
from common.time.clock import ManualClock
from common.time.lockstep import DT, period_of
from common.topic import Topic

M = TypeVar("M", bound=m.Message)


class Node:
    """A service class made with its configuration; `feed` is what its peers send before each step.

    Args:
        lockstep: as with `--speed max`, where jobs of the worker end at a robot time of their own.
        bus: one that the test shares among several nodes.
        tick: of the moment before the first step, 10 ms each.
    """

    def __init__(
        self,
        kind: Any,
        config: Any,
        household: Household,
        *,
        world: Scene | None = None,
        lockstep: bool = True,
        bus: MemoryBus | None = None,
        tick: int = 0,
        seed: int = 0,
        state_dir: Path | None = None,
    ) -> None:
        self.bus = bus or MemoryBus()
        self.tick, self.period = tick, period_of(kind.HZ)
        self.clock = ManualClock(max(0, tick) * DT)
        self._published = {topic.key: self.bus.tap(topic) for topic in kind.WRITES}
        self._decoded: dict[str, list[Any]] = {}
        self.io = MemoryIo(
            self.bus,
            kind.NAME,
            kind.READS,
            kind.WRITES,
            household=household,
            world=world,
            seed=seed,
            clock=self.clock,
            lockstep=lockstep,
        )
        self.io.state_dir = state_dir
        self.service = kind(config, self.io)

    # --- time
    @property
    def now(self) -> float:
        """Robot time [s]."""
        return self.tick * DT

    def later(self, seconds: float | None = None) -> float:
        """Robot time of the next step, one period on or as told: what is sent from now on is of that moment."""
        self.tick += self.period if seconds is None else round(seconds / DT)
        return self.now

    def feed(self) -> None:
        """What peers send before each step, at `now`."""

    def run(self) -> None:
        """The step."""
        self.clock.advance(self.now - self.clock.now())
        self.io.begin(self.tick, self.now)
        self.service.step(self.now)

    def step(self, seconds: float = 0.0, fed: bool = True) -> None:
        """Every step of so many seconds, at least one; with `fed` False the peers are silent."""
        for _ in range(max(1, round(seconds / (self.period * DT)))):
            self.later()
            if fed:
                self.feed()
            self.run()

    def until(self, probe: Callable[[], Any], limit: float = 400.0) -> float:
        """Step until the probe holds, or fail after `limit` robot seconds; returns the robot seconds that took."""
        start = self.now
        while not probe():
            assert self.now - start < limit, f"did not happen in {limit:.0f} s of robot time: {self.why()}"
            self.step()
        return self.now - start

    def why(self) -> str:
        """What a test that waited in vain should know."""
        return ""

    # --- what comes and goes
    def send(self, topic: Topic[M], message: M) -> None:
        """A message of a peer."""
        self.bus.send(topic, message)

    def count(self, topic: Topic[Any]) -> int:
        """How many messages the service has published there."""
        return len(self._published[topic.key])

    def sent(self, topic: Topic[M]) -> list[M]:
        """Every message that the service has published there."""
        decoded = self._decoded.setdefault(topic.key, [])
        decoded += [codec.decode(topic, payload) for payload in self._published[topic.key][len(decoded) :]]
        return decoded.copy()

    def last(self, topic: Topic[M]) -> M:
        """The newest message on a latched topic."""
        return codec.decode(topic, self.bus.last[topic.key])
