"""Which of the grasps that can be come to is taken, and when another stance is better."""

import math
from collections.abc import Callable, Generator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from common.geometry import compose, inverse
from common.messages import WorldObject
from common.scene import load_scene
from services.manipulation.arm.arm_model import Pose
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution import grasp_choice
from services.manipulation.execution.robot import Failure, Robot
from services.manipulation.grasps.grasp import POOR, Grasp
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.target import Target
from services.manipulation.planning.planning_scene import target_of
from services.manipulation.planning.stances import other_stance
from tests.unit.test_manipulation_stances import CONFIG, HOME, PLANNER, REST, TABLE, bottle

POOR_ONE = Grasp(Pose(np.zeros(3), np.eye(3)), 0.03, 0.01, 0.0, "poor", on_surface=True, worth=POOR - 0.1)
FOUND = WorldObject("pliers", "tool", "red", (0.6, 0.0, 0.87), size=(0.18, 0.05, 0.012))
TARGET = Target("pliers", "tool", (0.6, 0.0, 0.87), 0.0, (0.18, 0.05, 0.012))
ELSEWHERE = (1.0, 2.0, 0.5)


def choose(
    monkeypatch: pytest.MonkeyPatch, grasp: Grasp, stance: Any, tried: list[Grasp], sent: bool = False
) -> Generator[None, None, Any]:
    """The choice where the best grasp from here is `grasp`, and `stance` is the answer to where a better one is."""

    def work(fn: Callable[..., Any], *args: Any) -> Generator[None, None, Any]:
        yield
        return stance if fn is grasp_choice.other_stance else SimpleNamespace(grasp=grasp)

    robot = SimpleNamespace(
        config=ManipulationConfig(), io=SimpleNamespace(household=load_scene("apartment")), base=(0.0, 0.0, 0.0),
        joints=np.zeros(7), work=work, source=SimpleNamespace(objects=list),
        sent_to={FOUND.label: [ELSEWHERE]} if sent else {},
    )  # fmt: skip
    monkeypatch.setattr(grasp_choice, "planner_of", lambda robot: None)
    return grasp_choice.chosen(cast(Robot, robot), FOUND, TARGET, [[]], tried, [])


def end(steps: Generator[None, None, Any]) -> Any:
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            return stop.value


def test_what_is_hardly_held_from_here_is_taken_from_the_stance_that_holds_it_better(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pytest.raises(Failure) as failed:
        end(choose(monkeypatch, POOR_ONE, ELSEWHERE, []))
    assert (failed.value.code, failed.value.stance) == ("UNREACHABLE", ELSEWHERE)


@pytest.mark.parametrize(
    ("grasp", "stance", "tried", "sent"),
    [
        (POOR_ONE, None, [], False),
        (POOR_ONE, ELSEWHERE, [POOR_ONE], False),
        (POOR_ONE, ELSEWHERE, [], True),
        (replace(POOR_ONE, worth=POOR), ELSEWHERE, [], False),
        (replace(POOR_ONE, on_surface=False), ELSEWHERE, [], False),
    ],
    ids=["no better stance", "after a try", "sent there already", "good enough", "by rule"],
)
def test_it_is_taken_from_here_where_nothing_is_gained_elsewhere(
    monkeypatch: pytest.MonkeyPatch, grasp: Grasp, stance: Any, tried: list[Grasp], sent: bool
) -> None:
    assert end(choose(monkeypatch, grasp, stance, tried, sent)).grasp is grasp


@pytest.mark.parametrize(("worth", "told"), [(POOR, True), (POOR - 0.1, False)])
def test_the_stance_has_a_good_grasp_of_those_known_in_reach(
    monkeypatch: pytest.MonkeyPatch, worth: float, told: bool
) -> None:
    found, base = bottle(0.0, 0.0), (TABLE.center[0], TABLE.center[1] - 1.6, math.pi / 2)
    seen = replace(target_of(found, base, HOME), shape="round")
    grasp = replace(candidates(seen, PLANNER.arm.forward, PLANNER.arm.widest)[0], on_surface=True, worth=worth)
    monkeypatch.setattr(PLANNER, "candidates", lambda target: [[grasp]])
    lifts = CONFIG.approach_distance, CONFIG.lift_height, CONFIG.reach
    stance = other_stance(PLANNER, HOME, found, [found], [base], REST, *lifts, None, seen)
    assert (stance is not None) is told
    if stance is not None:
        # The same grasp, from there.
        x, y, _ = compose(inverse(stance), compose(base, (*grasp.pose.position[:2], 0.0)))
        assert math.hypot(x - PLANNER.arm.forward, y) < CONFIG.reach


def test_the_far_side_is_left_out_only_where_the_hand_holds_it_better_so(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = replace(TARGET, shape="irregular")
    for whole, front, family in ((-0.6, 0.3, "long"), (-0.2, -0.6, "irregular"), (0.1, 0.3, "irregular")):
        worth = {"irregular": whole, "long": front}
        monkeypatch.setattr(PLANNER, "_on_surface", lambda t, w=worth: [replace(POOR_ONE, worth=w[t.family])])
        assert PLANNER._believed(seen).family == family
