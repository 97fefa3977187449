"""A bench for the hand: objects on a table in the real simulation, manipulation, and the robot in front of them."""

import json
import math
from typing import Any

import msgspec
import mujoco
import numpy as np

from common import messages as m
from common import topics
from common.approach import EDGE_DISTANCE, STAND_OFF
from common.bus.memory import MemoryBus, MemoryIo
from common.config import Config
from common.geometry import Pose2, compose, inverse, yaw_quat
from common.household import told
from common.scene import ObjectSpec, Scene, body_name
from common.time.clock import ManualClock
from common.time.lockstep import DT, InProcess
from evaluation.watch import Watch
from judge.effects import Effect
from judge.evidence import Want
from judge.goal import Goal
from judge.observer import WATCH
from services.manipulation.config import ManipulationConfig
from services.manipulation.service import ManipulationService
from services.sim import truth
from services.sim.config import SimConfig
from services.sim.service import SimService

STANCES = 2
"""Times that the base moves to where manipulation says, as the brain has it."""


class Bench:
    """One object, and perhaps `others`, on one table of a chosen height, the robot in front of it; unless `known`, no
    object is in the household.
    """

    def __init__(
        self, scene: Scene, spec: ObjectSpec, height: float, seed: int, config: ManipulationConfig,
        simulation: Any = SimService, others: tuple[ObjectSpec, ...] = (), known: bool = True,
    ) -> None:  # fmt: skip
        surface = next(r for r in scene.receptacles if r.kind == "table")
        x, y, _ = surface.center
        table = msgspec.structs.replace(surface, center=(x, y, height))
        receptacles = tuple(table if r is surface else r for r in scene.receptacles)
        alone = msgspec.structs.replace(scene, objects=(spec, *others), receptacles=receptacles)
        self.spec = spec
        self.bus, clock = MemoryBus(), ManualClock()
        household = told(alone) if known else msgspec.structs.replace(told(alone), things=())
        home: dict[str, Any] = {"household": household, "seed": seed, "clock": clock}
        sim_io = MemoryIo(self.bus, "sim", simulation.READS, simulation.WRITES, world=alone, **home)
        sim_io.out_stamp = -1
        # No navigation corrects the odometry here.
        exact = SimConfig(odometry_slip=0.0, odometry_veer=0.0, odometry_noise=0.0)
        self.sim = simulation(exact, sim_io)
        self.world = InProcess(self.sim, sim_io, clock)
        io = MemoryIo(self.bus, "manipulation", ManipulationService.READS, ManipulationService.WRITES, **home)
        self.world.add(ManipulationService(config, io), io)
        io = MemoryIo(self.bus, Watch.NAME, Watch.READS, Watch.WRITES, world=alone, **home)
        watch = Watch(Config(), io)
        self.world.add(watch, io)
        self.observer = watch.observer
        self.goal = Goal((Want(spec.name, (scene.delivery,)),))

    def stand(self, base: tuple[float, float, float]) -> None:
        """Put the base there at rest, with what it holds."""
        physics = self.sim.physics
        data = physics.data
        held = truth.holding(physics)
        was = tuple(float(v) for v in data.qpos[physics.qpos_at[:3]])
        data.qpos[physics.qpos_at[:3]] = base
        if held:
            at = physics.model.body(body_name(self.spec)).jntadr[0]
            at = physics.model.jnt_qposadr[at]
            x, y, yaw = compose(base, compose(inverse(was), (data.qpos[at], data.qpos[at + 1], 0.0)))
            turned = np.empty(4)
            mujoco.mju_mulQuat(turned, np.array(yaw_quat(yaw)), data.qpos[at + 3 : at + 7].copy())
            data.qpos[at : at + 2], data.qpos[at + 3 : at + 7] = (x, y), turned
        self.sim.drivers.put(base)
        for _ in range(30):
            self.world.advance()

    def look(self) -> m.ObjectRef:
        """What a perception without error would say of the object."""
        placed, spec = self.sim.physics.placements[0], self.spec
        return m.ObjectRef(
            label=spec.name, kind=spec.kind, position=placed.position, orientation=yaw_quat(placed.yaw), size=spec.size
        )

    def run(
        self, text: str, goal_id: str, ref: m.ObjectRef | None = None, patience: float = 60.0
    ) -> m.ManipulationStatus:
        """Send a goal about the object as it is described, and step the world until the goal ends."""
        goal = m.ManipulationGoal(goal=text, id=goal_id, object=ref or self.look())
        self.bus.send(topics.MANIPULATION_GOAL, goal)
        for _ in range(round(patience * 100)):
            self.world.advance()
            status = msgspec.json.decode(self.bus.last[topics.MANIPULATION_STATUS.key], type=m.ManipulationStatus)
            if status.goal_id == goal_id and status.status in ("done", "failed"):
                return status
        return m.ManipulationStatus(status="failed", code="TIMEOUT", detail=f"{patience:.0f} s")

    def truth(self) -> dict[str, Any]:
        """The answer of `sim/truth`."""
        answer = self.bus.get(topics.SIM_TRUTH)
        found: dict[str, Any] = json.loads(answer or b"{}")
        return found

    def rest(self, seconds: float) -> None:
        """Let robot time pass."""
        for _ in range(round(seconds / DT)):
            self.world.advance()

    def before_it(self, rng: np.random.Generator) -> Pose2:
        """Where navigation would have the base stand for the object, off by a random error."""
        placed = self.sim.physics.placements[0]
        x, y, _ = placed.position
        surface = next(r for r in self.sim._io.world.receptacles if r.name == placed.on)
        along = max(surface.approach, key=lambda a: a[0] * (x - surface.center[0]) + a[1] * (y - surface.center[1]))
        facing = math.atan2(-along[1], -along[0])
        half = surface.size[0] / 2 if along[0] else surface.size[1] / 2
        inset = half - (along[0] * (x - surface.center[0]) + along[1] * (y - surface.center[1]))
        distance = max(rng.uniform(STAND_OFF - 0.01, STAND_OFF + 0.09), inset + EDGE_DISTANCE - 0.04)
        side = rng.uniform(-0.05, 0.05)
        bx = x - distance * math.cos(facing) - side * math.sin(facing)
        by = y - distance * math.sin(facing) + side * math.cos(facing)
        return bx, by, facing + rng.uniform(-0.05, 0.05)

    def there_and_back(self, ref: m.ObjectRef | None = None) -> str:
        """Grab it, from where manipulation says that the base has to stand if need be, carry it home, let go: `ok`, or
        the stage and reason of the failure; and what was hit meanwhile.
        """
        self.observer.begin()
        ended = self._there_and_back(ref)
        return "; hit: ".join([ended, *self.observer.conclude(self.goal).hits])

    def _there_and_back(self, ref: m.ObjectRef | None) -> str:
        grabbed = self.run("grab", "b.1", ref)
        for n in range(STANCES):
            if grabbed.stance is not None:
                self.stand(grabbed.stance)
                grabbed = self.run("grab", f"b.1{n}", self.look())
        if grabbed.status != "done":
            return f"grab {grabbed.code}: {grabbed.detail}"
        if why := self.observer.shortfall(Goal(effects=(Effect("holds", self.spec.name),))):
            return f"grab: false success, {why}"
        self.stand((0.0, 0.0, 0.0))
        released = self.run("release", "b.2", ref)
        if released.status != "done":
            return f"release {released.code}: {released.detail}"
        self.rest(WATCH)
        why = self.observer.shortfall(self.goal)
        return f"release: false success, {why}" if why else "ok"
