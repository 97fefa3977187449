"""Reach, grasp, lift, carry and put down in real physics, per kind of object: `python -m bench.grasp --trials 10`.

The base stands where navigation would put it, off by a random error; the peer is the same code with one candidate only.
"""

import argparse
import json
import math
import sys
from collections import Counter
from typing import Any

import msgspec
import mujoco
import numpy as np

from common import messages as m
from common import topics
from common.approach import EDGE_DISTANCE, STAND_OFF
from common.bus.memory import MemoryBus, MemoryIo
from common.geometry import compose, inverse, yaw_quat
from common.household import told
from common.kinds import KINDS
from common.scene import ObjectSpec, Scene, body_name, load_scene
from common.time.clock import ManualClock
from common.time.lockstep import DT, InProcess
from evaluation.statistics import percent
from evaluation.watch import Watch, WatchConfig
from judge.effects import Effect
from judge.evidence import Want
from judge.goal import Goal
from judge.observer import WATCH
from services.manipulation.config import ManipulationConfig
from services.manipulation.service import ManipulationService
from services.sim import truth
from services.sim.config import SimConfig
from services.sim.service import SimService


class Bench:
    """One object on one table of a chosen height, the robot in front of it."""

    def __init__(
        self, scene: Scene, spec: ObjectSpec, height: float, seed: int, config: ManipulationConfig,
        simulation: Any = SimService,
    ) -> None:  # fmt: skip
        surface = next(r for r in scene.receptacles if r.kind == "table")
        x, y, _ = surface.center
        table = msgspec.structs.replace(surface, center=(x, y, height))
        receptacles = tuple(table if r is surface else r for r in scene.receptacles)
        alone = msgspec.structs.replace(scene, objects=(spec,), receptacles=receptacles)
        self.spec = spec
        self.bus, clock = MemoryBus(), ManualClock()
        home: dict[str, Any] = {"household": told(alone), "seed": seed, "clock": clock}
        sim_io = MemoryIo(self.bus, "sim", simulation.READS, simulation.WRITES, world=alone, **home)
        sim_io.out_stamp = -1
        # No navigation corrects the odometry here.
        exact = SimConfig(odometry_slip=0.0, odometry_veer=0.0, odometry_noise=0.0)
        self.sim = simulation(exact, sim_io)
        self.world = InProcess(self.sim, sim_io, clock)
        io = MemoryIo(self.bus, "manipulation", ManipulationService.READS, ManipulationService.WRITES, **home)
        self.world.add(ManipulationService(config, io), io)
        io = MemoryIo(self.bus, Watch.NAME, Watch.READS, Watch.WRITES, world=alone, **home)
        watch = Watch(WatchConfig(), io)
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
        self.sim._base.pose, self.sim._base.target = base, None
        self.sim._setpoint[:3] = base
        for _ in range(30):
            self.world.advance()

    def _seen(self) -> m.ObjectRef:
        """What a perception without error would say of the object."""
        placed, spec = self.sim.physics.placements[0], self.spec
        return m.ObjectRef(
            label=spec.name, kind=spec.kind, position=placed.position, orientation=yaw_quat(placed.yaw), size=spec.size
        )

    def run(self, text: str, goal_id: str, patience: float = 60.0) -> m.ManipulationStatus:
        """Send a goal and step the world until it ends."""
        self.bus.send(topics.MANIPULATION_GOAL, m.ManipulationGoal(goal=text, id=goal_id, object=self._seen()))
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


def trial(scene: Scene, spec: ObjectSpec, seed: int, config: ManipulationConfig) -> str:
    """`ok`, or the stage and reason of the failure."""
    rng = np.random.default_rng([seed, 3])
    bench = Bench(scene, spec, float(rng.uniform(0.45, 0.76)), seed, config)
    placed = bench.sim.physics.placements[0]
    x, y, _ = placed.position
    surface = next(r for r in bench.sim._io.world.receptacles if r.name == placed.on)
    along = max(surface.approach, key=lambda a: a[0] * (x - surface.center[0]) + a[1] * (y - surface.center[1]))
    facing = math.atan2(-along[1], -along[0])
    half = surface.size[0] / 2 if along[0] else surface.size[1] / 2
    inset = half - (along[0] * (x - surface.center[0]) + along[1] * (y - surface.center[1]))
    distance = max(rng.uniform(STAND_OFF - 0.01, STAND_OFF + 0.09), inset + EDGE_DISTANCE - 0.04)
    side = rng.uniform(-0.05, 0.05)
    bx = x - distance * math.cos(facing) - side * math.sin(facing)
    by = y - distance * math.sin(facing) + side * math.cos(facing)
    bench.stand((bx, by, facing + rng.uniform(-0.05, 0.05)))
    bench.observer.begin()
    grabbed = bench.run("grab", "b.1")
    if grabbed.status != "done":
        return f"grab {grabbed.code}: {grabbed.detail}"
    if why := bench.observer.shortfall(Goal(effects=(Effect("holds", spec.name),))):
        return f"grab: false success, {why}"
    bench.stand((0.0, 0.0, 0.0))
    released = bench.run("release", "b.2")
    if released.status != "done":
        return f"release {released.code}: {released.detail}"
    bench.rest(WATCH)
    why = bench.observer.shortfall(bench.goal)
    return f"release: false success, {why}" if why else "ok"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=10)
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--peer", action="store_true", help="also run with a single candidate grasp")
    args = parser.parse_args()
    scene = load_scene("apartment")
    configs = {"full": ManipulationConfig()}
    if args.peer:
        configs["one candidate"] = ManipulationConfig(max_candidates=1)
    print(f"{'kind':8} {'variant':14} {'ok':>5} {'of':>4} {'95 %':>12}  failures")
    failed = False
    for kind in args.kinds.split(","):
        spec = next(o for o in scene.objects if o.kind == kind)
        for name, config in configs.items():
            outcomes = Counter(trial(scene, spec, seed, config) for seed in range(args.trials))
            good = outcomes.pop("ok", 0)
            failed |= good < args.trials and name == "full"
            print(
                f"{kind:8} {name:14} {good:5} {args.trials:4} {percent(good, args.trials):>12}  {dict(outcomes) or ''}",
                flush=True,
            )
    sys.exit(int(failed))


if __name__ == "__main__":
    main()
