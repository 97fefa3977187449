"""What lies is grasped so that the hand can stand it up again."""

import math
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from pytest import MonkeyPatch

from common.bus.memory import MemoryBus, MemoryIo
from common.messages import WorldObject
from services.manipulation.arm.arm_model import Obstacle, Pose
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution import grasp_choice
from services.manipulation.execution.robot import Failure, Robot, Steps
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.grasped_object import attach
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import PlanError
from services.manipulation.planning.object_source import ObjectSource
from services.manipulation.planning.plan_grab import GrabPlan, plan_grab
from services.manipulation.planning.plan_place import can_be_set_down
from services.manipulation.planning.planning_scene import SLAB, target_of
from tests.unit.test_manipulation_stances import HOME, PLANNER, REST

CONFIG = ManipulationConfig()
TRAY = 0.46
"""Height [m] of the surface on which it is to stand."""


def bottle(top: float) -> Target:
    """A bottle that lies on a surface of that height [m] before the robot, its neck away from it."""
    return Target("bottle", "bottle", (0.68, 0.0, top + 0.0355), 0.0, (0.2, 0.071, 0.071), math.pi / 2, "round")


def planned(target: Target, stand_on: float | None) -> GrabPlan:
    table = Obstacle((0.8, 0.0, target.bottom - SLAB / 2), (0.5, 1.0, SLAB), 0.0)
    return plan_grab(
        PLANNER, target, [[table]], REST, CONFIG.approach_distance, CONFIG.lift_height, CONFIG.reach, frozenset(), [],
        stand_on,
    )  # fmt: skip


def test_from_a_low_surface_it_is_taken_so_that_it_can_be_stood_up() -> None:
    plan = planned(bottle(TRAY), TRAY)
    assert plan.grasped.rotation[2, 2] < 0.3, "the hand comes from the side or from above once it stands"
    assert can_be_set_down(PLANNER, plan.grasped, TRAY, REST)


def test_a_mug_on_its_head_is_taken_so_that_it_can_be_turned_over() -> None:
    mug = Target("mug", "mug", (0.68, 0.0, TRAY + 0.05), 0.4, (0.066, 0.066, 0.1), math.pi)
    plan = planned(mug, TRAY)
    assert plan.grasp.turns_over
    assert can_be_set_down(PLANNER, plan.grasped, TRAY, REST)


def test_where_it_can_only_be_laid_down_the_plan_says_so() -> None:
    high = bottle(0.78)
    with pytest.raises(PlanError, match="could not be stood up") as failed:
        planned(high, TRAY)
    assert failed.value.code == "UNREACHABLE"
    plan = planned(high, None)
    assert not can_be_set_down(PLANNER, attach(high, plan.grasp), TRAY, REST)


def test_a_hand_that_would_be_in_the_surface_sets_nothing_down() -> None:
    held = planned(bottle(TRAY), TRAY).grasped
    assert not can_be_set_down(PLANNER, replace(held, offset=held.offset * [1, 1, 0]), TRAY, REST)


def test_the_base_is_sent_elsewhere_once_and_then_it_is_taken_as_can_be(monkeypatch: MonkeyPatch) -> None:
    elsewhere, asked = (1.0, 2.0, 0.5), []
    to_be_laid_down = SimpleNamespace(grasp=Grasp(Pose(np.zeros(3), np.eye(3)), 0.07, 0.03, 0.0, "top"))

    def plan(*args: Any) -> SimpleNamespace:
        asked.append(args[-1])
        if args[-1] is not None:
            raise Failure("UNREACHABLE", "could not be stood up")
        return to_be_laid_down

    monkeypatch.setattr(grasp_choice, "plan_grab", plan)
    monkeypatch.setattr(grasp_choice, "other_stance", lambda *args: elsewhere)
    robot = Robot(CONFIG, MemoryIo(MemoryBus(), "manipulation", (), (), household=HOME), ObjectSource(HOME))
    robot.planner = PLANNER

    def work(fn: Callable[..., Any], *args: Any) -> Steps[Any]:
        yield
        return fn(*args)

    monkeypatch.setattr(robot, "work", work)
    found = WorldObject("bottle", "bottle", "red", (0, 0, 0.8), size=(0.2, 0.07, 0.07), tilt=math.pi / 2)

    def choose() -> Any:
        steps = grasp_choice.chosen(robot, found, target_of(found, robot.base, HOME), [[]], frozenset(), [])
        while True:
            try:
                next(steps)
            except StopIteration as done:
                return done.value

    with pytest.raises(Failure) as failed:
        choose()
    assert failed.value.stance == elsewhere
    assert choose() is to_be_laid_down
    assert [height is None for height in asked] == [False, False, True]
