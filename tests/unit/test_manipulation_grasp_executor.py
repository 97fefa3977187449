"""What is felt of a grasp on its way to the carry pose."""

import itertools
from collections.abc import Generator
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from msgspec.structs import replace

from common.messages import ManipulationGoal, WorldObject
from common.robot.grip import Grip
from services.manipulation.arm.arm_model import Pose
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution import grasp_executor
from services.manipulation.execution.grasp_executor import MISSED
from services.manipulation.execution.robot import Failure, Robot
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.grasped_object import attach
from services.manipulation.grasps.target import Target
from services.manipulation.planning.plan_grab import GrabPlan

GRASP = Grasp(Pose(np.array([0.5, 0.0, 0.6]), np.eye(3)), 0.027, 0.01, 0.0, "handle", on_surface=True)
TARGET = Target("trowel", "tool", (0.55, 0.0, 0.6), 0.0, (0.31, 0.07, 0.03))
FOUND = WorldObject("trowel", "tool", "green", (0.55, 0.0, 0.6), size=TARGET.size)
AT = np.zeros(7)


def grab(monkeypatch: pytest.MonkeyPatch, carried: Grip) -> str:
    """Grab what is 30.7 mm wide between the pads until the carry, and then as is felt by `carried`."""

    def nothing(*_: Any, **__: Any) -> Generator[None, None, Any]:
        yield
        return AT

    def carry(robot: Any, plan: Any) -> Generator[None, None, None]:
        yield
        robot.grip = carried

    def aimed(robot: Any, plan: Any, *_: Any) -> Generator[None, None, Any]:
        yield
        return plan

    robot = SimpleNamespace(
        config=ManipulationConfig(), grip=Grip(0.0307, 25.0), joints=AT, now=0.0, phase="", grasped=None,
        sent_to={}, met_before=[], contacts=SimpleNamespace(clear=lambda: None),
        source=SimpleNamespace(remember=lambda *_: None), move_gripper=nothing, travel=nothing, follow=nothing,
        at_rest=nothing, guard=lambda *_: None,
    )  # fmt: skip
    hand = SimpleNamespace(share=lambda width: 0.0, open=0.085)
    monkeypatch.setattr(grasp_executor, "planner_of", lambda robot: SimpleNamespace(arm=SimpleNamespace(hand=hand)))
    for name, fake in (("aimed", aimed), ("close", nothing), ("_carry", carry), ("_set_back", nothing)):
        monkeypatch.setattr(grasp_executor, name, fake)
    monkeypatch.setattr(grasp_executor, "insert_share", lambda *_: 1.0)
    monkeypatch.setattr(grasp_executor, "check_width", lambda *_: None)
    plan = GrabPlan(GRASP, [], [AT], [AT] * 4, [], attach(TARGET, GRASP), doubt=0.029)
    steps = grasp_executor._execute_grab(cast(Robot, robot), plan, ManipulationGoal(goal="grab"), FOUND, [])
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            return str(stop.value)


def test_what_has_turned_its_narrow_side_between_the_pads_on_the_way_is_held(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "26.1 mm" in grab(monkeypatch, Grip(0.0261, 25.0))


@pytest.mark.parametrize("carried", [Grip(0.015, 25.0), Grip(0.0, 12.0)], ids=["slides off", "is gone"])
def test_what_slips_on_the_way_is_not(monkeypatch: pytest.MonkeyPatch, carried: Grip) -> None:
    with pytest.raises(Failure) as failed:
        grab(monkeypatch, carried)
    assert failed.value.code == "SLIPPED"


@pytest.mark.parametrize(("moved", "tries"), [(0.0, 1), (2 * MISSED, 4)])
def test_where_the_hand_has_closed_on_nothing_it_does_not_try_again_by_the_same_sighting(
    moved: float, tries: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`moved`: how far [m] it is seen from where it was seen before, each time."""
    seen, stance, attempts = itertools.count(), (0.1, 0.2, 0.3), []

    def nothing(*_: Any, **__: Any) -> Generator[None, None, Any]:
        yield
        return AT

    def sighted(*_: Any, **__: Any) -> Generator[None, None, WorldObject]:
        yield
        return replace(FOUND, position=(0.55 + moved * next(seen), 0.0, 0.6))

    def chosen(*_: Any, **__: Any) -> Generator[None, None, GrabPlan]:
        yield
        return GrabPlan(GRASP, [], [AT], [AT] * 4, [], attach(TARGET, GRASP))

    def empty(robot: Any, plan: Any, *_: Any) -> Generator[None, None, str]:
        yield
        attempts.append(plan)
        raise Failure("EMPTY_GRASP", "width 0.0 mm")

    def elsewhere(robot: Any, found: Any, failure: Failure) -> Generator[None, None, None]:
        yield
        raise Failure(failure.code, failure.detail, (), stance)

    log = SimpleNamespace(info=lambda *_, **__: None, warning=lambda *_, **__: None)
    robot = SimpleNamespace(
        config=ManipulationConfig(), grip=Grip(0.0, 0.0), base=(0.0, 0.0, 0.0), now=0.0, phase="", grasped=None,
        sent_to={}, met_before=[], contacts=SimpleNamespace(clear=lambda: None), move_gripper=nothing,
        io=SimpleNamespace(household=None, publish=lambda *_: None, log=log),
    )  # fmt: skip
    fakes = {
        "sighted": sighted, "chosen": chosen, "_execute_grab": empty, "look_elsewhere": elsewhere, "go_home": nothing,
        "target_of": lambda *_: TARGET, "surroundings": lambda *_: [], "touched_from": lambda *_: [],
        "shown": lambda *_: None,
    }  # fmt: skip
    for name, fake in fakes.items():
        monkeypatch.setattr(grasp_executor, name, fake)
    with pytest.raises(Failure) as failed:
        list(grasp_executor.grab(cast(Robot, robot), ManipulationGoal(goal="grab"), ""))
    assert (failed.value.code, len(attempts)) == ("EMPTY_GRASP", tries)
    assert failed.value.stance == (stance if tries == 1 else None)
