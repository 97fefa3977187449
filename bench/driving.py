"""Simulation and navigation alone in one process, for the benchmarks of driving."""

import time
from typing import Any

import msgspec

from common import config, topics
from common import messages as m
from common.bus.memory import MemoryBus, MemoryIo
from common.household import told
from common.scene import Obstacle, Scene, load_scene
from common.time.clock import ManualClock
from common.time.lockstep import DT, InProcess
from services.navigation.service import NavigationService
from services.sim import truth
from services.sim.service import SimService


class Timed:
    """A service that notes how much CPU time its steps take."""

    def __init__(self, service: Any) -> None:
        self._service, self.HZ = service, service.HZ
        self.seconds: list[float] = []

    def step(self, now: float) -> None:
        began = time.thread_time()
        self._service.step(now)
        self.seconds.append(time.thread_time() - began)


class Driver:
    """A robot that only drives; `goal` sends it somewhere, `truth` and `pose` tell where it is and believes to be."""

    def __init__(
        self,
        scene: str | Scene = "apartment",
        seed: int = 0,
        settings: tuple[str, ...] = (),
        obstacles: tuple[Obstacle | str, ...] = (),
        log_level: str = "error",
    ) -> None:
        self.scene = load_scene(scene) if isinstance(scene, str) else scene
        self.bus, clock = MemoryBus(), ManualClock()
        changes = config.overrides({}, settings)
        ios = []
        for kind in (SimService, NavigationService):
            parameters = config.load(kind.NAME, kind.CONFIG, config.config_dir(), changes)
            io = MemoryIo(
                self.bus, kind.NAME, kind.READS, kind.WRITES, household=told(self.scene), world=self.scene, seed=seed,
                clock=clock, log_level=log_level,
            )  # fmt: skip
            if kind is SimService:
                io.out_stamp = -1
                if obstacles:
                    parameters = msgspec.structs.replace(parameters, obstacles=obstacles)
                self.sim = kind(parameters, io)
            else:
                self.navigation = kind(parameters, io)
            ios.append(io)
        self.world = InProcess(self.sim, ios[0], clock)
        self.timed = Timed(self.navigation)
        self.world.add(self.timed, ios[1])
        self.number = 0
        self.advance(0.2)

    @property
    def now(self) -> float:
        return self.world.clock.now()

    def advance(self, seconds: float) -> None:
        for _ in range(round(seconds / DT)):
            self.world.advance()

    def goal(self, text: str) -> None:
        self.number += 1
        self.bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=text, id=f"drive.{self.number}"))
        self.advance(0.1)

    def status(self) -> m.NavigationStatus:
        return msgspec.json.decode(self.bus.last[topics.NAVIGATION_STATUS.key], type=m.NavigationStatus)

    def feedback(self) -> m.NavigationFeedback:
        return msgspec.json.decode(self.bus.last[topics.NAVIGATION_FEEDBACK.key], type=m.NavigationFeedback)

    def pose(self) -> m.PoseEstimate:
        return msgspec.json.decode(self.bus.last[topics.POSE.key], type=m.PoseEstimate)

    def odometry(self) -> m.Odometry:
        return msgspec.msgpack.decode(self.bus.last[topics.ODOMETRY.key], type=m.Odometry)

    def truth(self) -> dict[str, Any]:
        return truth.report(self.sim.physics, self.now, "")

    def base(self) -> list[float]:
        """Where the base really is."""
        physics = self.sim.physics
        found: list[float] = physics.data.qpos[physics.qpos_at[:3]].tolist()
        return found
