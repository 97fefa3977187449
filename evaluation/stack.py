"""The whole robot in one process: the real services on the in-memory bus, in lockstep."""

import gc
import json
import pkgutil
from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import msgspec

from cli.processes.services import SERVICES
from common import config, topics
from common import messages as m
from common.bus.memory import MemoryIo
from common.household import Household, load_words, told
from common.rendering.backend import choose
from common.scene import Scene, load_scene
from common.time.clock import ManualClock
from common.time.lockstep import DT, InProcess
from evaluation.faults.host import FullDisk, OutageBus
from evaluation.registry import service_class

Swap = Callable[[Any], Any]
"""Takes a service's class and returns the one that runs in its place."""


def replacement(entry: str) -> tuple[str, Any]:
    """The service class that `package.module:Class` names, with its NAME, to take the place of the service so named.

    Raises:
        LookupError: there is no such module or class, or it is no service of the stack.
    """
    try:
        kind = pkgutil.resolve_name(entry)
    except (ImportError, AttributeError, ValueError) as error:
        raise LookupError(f"{entry}: {error}; expected package.module:Class that can be imported") from None
    if isinstance(kind, ModuleType):
        raise LookupError(f"{entry} is a module; expected package.module:Class")
    missing = [n for n in ("NAME", "HZ", "CONFIG", "READS", "WRITES", "step") if not hasattr(kind, n)]
    if missing:
        raise LookupError(f"{entry} has no {', '.join(missing)}; see docs/EXTENDING.md for what a service has")
    if kind.NAME not in paced_services():
        raise LookupError(f"{entry}: no service {kind.NAME!r}; known: {', '.join(paced_services())}")
    return kind.NAME, kind


def paced_services() -> tuple[str, ...]:
    """Every service of the command line's table that follows the simulation in lockstep and starts by default."""
    return tuple(s.name for s in SERVICES if s.paced and not s.needs)


class Stack:
    """A simulation and the services around it; time passes by `tick` and `advance` alone.

    `scene` is the world; without a `household` the robot is told all of it. `replaced` are classes that stand in for
    services, as `package.module:Class`.

    `kill`, `hang` and `start` do to a service object what signals and the supervisor do to its process; `restart_sim`,
    `cut`, `fill_disk` and `jump` are the other things that can happen. What services keep on disk goes to `state_dir`,
    None: nowhere.
    """

    def __init__(
        self,
        scene: Scene | str = "apartment",
        seed: int = 0,
        settings: tuple[str, ...] = (),
        *,
        household: Household | None = None,
        without: tuple[str, ...] = (),
        replaced: tuple[str, ...] = (),
        swaps: Mapping[str, Swap] | None = None,
        state_dir: Path | None = None,
    ) -> None:
        self.scene = load_scene(scene) if isinstance(scene, str) else scene
        self.household = household or told(self.scene, load_words(config.config_dir()))
        self.seed, self._state_dir = seed, state_dir
        kept = ("sim.run=stack", "brain.run=stack") if state_dir else ()
        # Many a run never hears or says anything.
        self._changes = config.overrides({}, ("speech.preload=false", *kept, *settings))
        self._swaps, self._replaced = dict(swaps or {}), dict(replacement(entry) for entry in replaced)
        # One process, one GL library, chosen before anything imports MuJoCo.
        choose("auto")
        self.bus, self._clock = OutageBus(), ManualClock()
        self.members: dict[str, tuple[Any, MemoryIo]] = {}
        self._hung: dict[str, float] = {}
        self._cut_until = self._full_until = float("inf")
        self._disk = FullDisk()
        self.starts: dict[str, int] = {}
        self.sim, sim_io = self._make(service_class("sim"))
        self.world = InProcess(self.sim, sim_io, self._clock)
        self._sim_io = sim_io
        for name in paced_services():
            if name not in without:
                self.start(name)

    def _make(self, kind: Any) -> tuple[Any, MemoryIo]:
        kind = self._swaps.get(kind.NAME, lambda same: same)(kind)
        parameters = config.load(kind.NAME, kind.CONFIG, config.config_dir(), self._changes)
        io = MemoryIo(
            self.bus, kind.NAME, kind.READS, kind.WRITES, household=self.household, seed=self.seed, clock=self._clock,
            world=self.scene if getattr(kind, "KNOWS_WORLD", False) else None, log_level="error",
        )  # fmt: skip
        if kind.NAME == "sim":
            io.out_stamp = -1
        io.state_dir = self._state_dir
        started = self.starts[kind.NAME] = self.starts.get(kind.NAME, 0) + 1
        # Ids of one process never come again from the next one of that name.
        io._ids = (started - 1) * 100_000
        return kind(parameters, io), io

    # --- members
    def start(self, name: str) -> Any:
        """A fresh process of the service joins at the next tick."""
        return self.join(self._replaced.get(name) or service_class(name))

    def join(self, kind: Any) -> Any:
        """Add a participant of any class, such as the examiner; returns it."""
        service, io = self._make(kind)
        self.members[kind.NAME] = service, io
        self.world.add(service, io)
        if self.bus.away and kind.NAME in paced_services():
            self.hang(kind.NAME, self._cut_until - self.now)
        return service

    def kill(self, name: str) -> None:
        """End a service as SIGKILL does: it neither reads nor writes any more, and what it knew is gone."""
        service, io = self.members.pop(name)
        self._hung.pop(name, None)
        self.world.remove(service)
        self.bus.detach(io)
        io.shutdown()
        del service, io
        # What a process had open is closed by the system.
        gc.collect()

    def hang(self, name: str, seconds: float) -> None:
        """Freeze a service as SIGSTOP does, until SIGCONT: its mail piles up meanwhile."""
        self.world.remove(self.members[name][0])
        self._hung[name] = max(self.now + seconds, self._hung.get(name, 0.0))

    def restart_sim(self) -> None:
        """Kill the simulation and start its successor: the world goes on from its checkpoint, and so does time."""
        self.bus.detach(self._sim_io)
        self._sim_io.shutdown()
        self.sim, self._sim_io = self._make(service_class("sim"))
        self.world = InProcess(self.sim, self._sim_io, self._clock)
        self.world.tick = round(self.sim.start_time / DT)
        self._clock.advance(self.world.tick * DT - self.now)
        for name, (service, io) in self.members.items():
            if name not in self._hung:
                self.world.add(service, io)

    def cut(self, seconds: float) -> None:
        """Cut the bus for some time: nobody receives anything, not even the clock, while the world goes on."""
        observers = [io for name, (_, io) in self.members.items() if name not in paced_services()]
        self.bus.outsiders, self.bus.away = observers, True
        self._cut_until = self.now + seconds
        for name in self.members:
            if name in paced_services():
                self.hang(name, seconds)

    def fill_disk(self, seconds: float) -> bool:
        """Fill every disk for so long [s]; True when a write was tried and failed."""
        self._full_until = self.now + seconds
        return self._disk.full(True)

    def close(self) -> None:
        """End every service; worker threads and contexts go with them."""
        self._disk.full(False)
        for service, io in [*self.members.values(), (self.sim, self._sim_io)]:
            if hasattr(service, "close"):
                service.close()
            io.shutdown()

    # --- time
    @property
    def now(self) -> float:
        """Robot time [s]."""
        return self._clock.now()

    def tick(self) -> float:
        """10 ms of the world and of every service that is due."""
        if self.now >= self._cut_until:
            self._cut_until = float("inf")
            self.bus.back()
        if self.now >= self._full_until:
            self._full_until = float("inf")
            self._disk.full(False)
        for name in [n for n, until in self._hung.items() if until <= self.now]:
            del self._hung[name]
            self.world.add(*self.members[name])
        return self.world.advance()

    def jump(self, seconds: float) -> None:
        """Let the clock leap ahead for everybody; the world stays."""
        self.world.tick += round(seconds / DT)

    def advance(self, seconds: float) -> None:
        """Let robot time pass."""
        for _ in range(round(seconds / DT)):
            self.tick()

    # --- looking in from outside
    def state(self) -> m.BrainState:
        """What the brain says it does."""
        return msgspec.json.decode(self.bus.last[topics.BRAIN_STATE.key], type=m.BrainState)

    def truth(self) -> dict[str, Any]:
        """The answer of `sim/truth`."""
        found: dict[str, Any] = json.loads(self.bus.get(topics.SIM_TRUTH) or b"{}")
        return found
