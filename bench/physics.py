"""Physics alone, by CPU time: our 10 ms ticks while the robot stands, drives and moves its arm, against a plain mj_step
loop of the same model, with and without sleep."""

import itertools
import time
from collections.abc import Callable
from statistics import median

import msgspec
import mujoco
import numpy as np
from numpy.typing import NDArray

from common.scene import load_scene
from common.time.lockstep import DT
from services.sim.physics import FINE, Physics

SECONDS = 5.0
"""Robot time of a measurement [s]."""
RUNS = 5
"""Measurements, of which the median counts."""
OBJECTS = 12
"""Of the flat's objects, as many as lie about in a lived-in home [count]."""
BASE_TURN, ARM_TURN = 2, 3
"""Of the ten set-points: the base's yaw and the arm's first joint."""
SWING = 0.5
"""Amplitude [rad]."""


def speed(advance: Callable[[], None], seconds_a_call: float) -> float:
    """Median real-time factor over a few runs."""
    factors = []
    for _ in range(RUNS):
        began = time.process_time()
        for _ in range(round(SECONDS / seconds_a_call)):
            advance()
        factors.append(SECONDS / (time.process_time() - began))
    return median(factors)


def swinging(physics: Physics, hold: NDArray[np.float64], joint: int) -> Callable[[], None]:
    """A tick in which the set-point of one of the ten joints goes on along a sine."""
    ticks = itertools.count(1)
    was = hold.copy()

    def advance() -> None:
        wanted = hold.copy()
        wanted[joint] += SWING * np.sin(next(ticks) * DT)
        physics.advance(was, wanted)
        was[:] = wanted

    return advance


def main() -> None:
    scene = load_scene("apartment")
    physics = Physics(msgspec.structs.replace(scene, objects=scene.objects[:OBJECTS]), 0)
    model, data = physics.model, physics.data
    hold = np.array(data.ctrl[physics.ctrl_at])
    print(f"{len(physics.placements)} objects, nv {model.nv}, {model.ngeom} geoms, {1000 * DT / FINE:.0f} ms steps")
    print(f"{'variant':34} {'x real time':>12}")
    physics.advance(hold, hold)
    for _ in range(300):
        physics.advance(hold, hold)
    print(f"{'ours, 10 ms ticks, standing':34} {speed(lambda: physics.advance(hold, hold), DT):12.1f}")
    for what, joint in (("driving", BASE_TURN), ("arm moving", ARM_TURN)):
        print(f"{f'ours, {what}':34} {speed(swinging(physics, hold, joint), DT):12.1f}")
    for _ in range(300):
        physics.advance(hold, hold)
    plain = speed(lambda: mujoco.mj_step(model, data, FINE), 0.01)
    print(f"{'plain mj_step, objects asleep':34} {plain:12.1f}")
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    awake = mujoco.MjData(model)
    awake.qpos[:], awake.ctrl[:] = data.qpos, data.ctrl
    plain = speed(lambda: mujoco.mj_step(model, awake, FINE), 0.01)
    print(f"{'plain mj_step, objects awake':34} {plain:12.1f}")


if __name__ == "__main__":
    main()
