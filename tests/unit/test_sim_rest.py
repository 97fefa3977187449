"""A world in which nothing moves is not worked out, until something does."""

from collections.abc import Callable

import numpy as np
import pytest

from common.scene import load_scene
from common.time.lockstep import DT
from services.sim.physics import GLANCE, Physics


@pytest.fixture(scope="module")
def physics() -> Physics:
    return Physics(load_scene("minimal"), 0)


def worked_out(physics: Physics, ticks: int) -> float:
    """Share of the next ticks, with the arm and base told to stay, that are worked out."""
    home = physics.joints.copy() * 0.0 + physics.data.ctrl[physics.ctrl_at]
    before = float(physics.data.time)
    for _ in range(ticks):
        physics.advance(home, home)
    return (float(physics.data.time) - before) / (ticks * DT)


@pytest.fixture
def resting(physics: Physics) -> Physics:
    physics.reset()
    for _ in range(20):
        worked_out(physics, 10 * GLANCE)
    return physics


def test_of_rest_one_tick_in_ten_is_worked_out_and_nothing_drifts(resting: Physics) -> None:
    before = resting.data.qpos.copy()
    assert worked_out(resting, 20 * GLANCE) == pytest.approx(1 / GLANCE, abs=0.01)
    assert np.abs(resting.data.qpos - before).max() < 1e-6


def shove(physics: Physics) -> None:
    physics.data.qvel[physics.model.nv - 6] = 0.05


def press(physics: Physics) -> None:
    physics.limit_effort(1.0)


def close(physics: Physics) -> None:
    physics.grip(1.0, 20.0)


@pytest.mark.parametrize("cause", [shove, press, close])
def test_what_moves_the_world_is_felt_at_once(resting: Physics, cause: Callable[[Physics], None]) -> None:
    worked_out(resting, 1)
    cause(resting)
    assert worked_out(resting, 3) == pytest.approx(1.0)


def test_what_changes_the_model_is_felt_within_a_tenth_of_a_second(resting: Physics) -> None:
    gravity = resting.model.opt.gravity.copy()
    resting.model.opt.gravity[:] = 3.0, 0.0, -9.81
    try:
        worked_out(resting, GLANCE)
        assert worked_out(resting, 3) == pytest.approx(1.0)
    finally:
        resting.model.opt.gravity[:] = gravity


def test_only_what_is_held_is_worth_the_pass_against_creep(resting: Physics) -> None:
    shove(resting)
    worked_out(resting, 3)
    assert resting.data.ncon > 0
    assert resting.model.opt.noslip_iterations == 0
