"""One service on a memory bus, stepped by hand."""

from pathlib import Path
from typing import Any, TypeVar

from common import codec
from common import messages as m
from common.clock import ManualClock
from common.memory import MemoryBus, MemoryIo
from common.scene import Scene
from common.topics import Topic

M = TypeVar("M", bound=m.Message)


class Node:
    """The tests of a service add what its peers would send and what they ask."""

    def __init__(
        self, kind: Any, config: Any, scene: Scene, *, lockstep: bool = True, state_dir: Path | None = None
    ) -> None:
        self.bus, self.clock = MemoryBus(), ManualClock()
        self.io = MemoryIo(
            self.bus, kind.NAME, kind.READS, kind.WRITES, scene=scene, clock=self.clock, lockstep=lockstep
        )
        self.io.state_dir = state_dir
        self.service = kind(config, self.io)
        self.tick, self._period = 0, round(100 / kind.HZ)

    @property
    def now(self) -> float:
        """Robot time [s]."""
        return self.tick / 100

    def later(self) -> float:
        """Robot time of the next step: what is sent from now on is of that moment."""
        self.tick += self._period
        return self.now

    def run(self) -> None:
        """The step."""
        self.clock.advance(self.now - self.clock.now())
        self.io.begin(self.tick, self.now)
        self.service.step(self.now)

    def step(self) -> None:
        """The next step, with nothing sent before it."""
        self.later()
        self.run()

    def last(self, topic: Topic[M]) -> M:
        """The newest message on a latched topic."""
        return codec.decode(topic, self.bus.last[topic.key])
