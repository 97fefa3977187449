"""How far the hand keeps back: only its pads may come near what it grasps, open and closed."""

import numpy as np
import pytest

from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.clearance import GAP, MOST, OUTWARD
from services.manipulation.grasps.grasp import Grasp, approach_rotation
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import Planner
from services.sim.model import own

PLANNER = Planner(own().mjcf, seed=0)
KNUCKLES = 0.0303
"""How far [m] the inner links of the hand stay behind the middle of its pads when these are 50 mm apart."""


def grasp(target: Target, width: float, tilt: float = 0.0) -> Grasp:
    pose = Pose(np.array(target.position), approach_rotation(0.0, tilt))
    return Grasp(pose, width, target.size[2] / 2, tilt, "straight")


def kept_back(target: Target, width: float) -> float | None:
    wanted = grasp(target, width)
    found = PLANNER.clearance.clear(target, wanted)
    if found is None:
        return None
    moved = found.pose.position - wanted.pose.position
    assert moved[1:] == pytest.approx([0.0, 0.0], abs=1e-9), "along the approach alone"
    return -float(moved[0]) - PLANNER.clearance.hand.advance(width)


def box(deep: float) -> Target:
    return Target("box", "box", (0.5, 0.0, 0.5), 0.0, (deep, 0.05, 0.1))


def test_what_the_hand_reaches_around_is_grasped_a_little_beyond_the_middle_of_its_pads() -> None:
    assert kept_back(box(0.05), 0.05) == pytest.approx(OUTWARD, abs=0.001)
    can = Target("can", "can", (0.5, 0.0, 0.5), 0.0, (0.066, 0.066, 0.12))
    assert kept_back(can, 0.066) == pytest.approx(OUTWARD, abs=0.001)


def test_what_lies_at_the_tips_of_the_pads_already_is_grasped_as_it_is() -> None:
    flat = Target("lid", "", (0.5, 0.0, 0.5), 0.0, (0.05, 0.05, 0.012), shape="box")
    above = Pose(np.array([0.5, 0.0, 0.51]), approach_rotation(0.0, np.pi / 2))
    found = PLANNER.clearance.clear(flat, Grasp(above, 0.05, 0.016, np.pi / 2, "from above", on_surface=True))
    assert found is not None
    up = found.pose.position[2] - above.position[2]
    assert up == pytest.approx(PLANNER.clearance.hand.advance(0.05), abs=1e-6)


def test_the_hand_keeps_back_from_a_deep_box_as_far_as_its_knuckles_need() -> None:
    deep = 0.14
    back = kept_back(box(deep), 0.05)
    assert back is not None
    assert GAP <= KNUCKLES + back - deep / 2 <= GAP + 0.005


def test_what_the_pads_would_not_hold_any_more_is_refused() -> None:
    ball = Target("ball", "ball", (0.5, 0.0, 0.5), 0.0, (0.16, 0.05, 0.16))
    assert KNUCKLES - 0.08 + MOST < GAP
    assert kept_back(ball, 0.05) is None


def test_the_turn_of_the_object_counts() -> None:
    along = Target("box", "box", (0.5, 0.0, 0.5), np.pi / 2, (0.05, 0.14, 0.1))
    assert kept_back(along, 0.05) == pytest.approx(kept_back(box(0.14), 0.05) or -1.0, abs=1e-6)


def test_the_pads_of_a_linkage_meet_where_the_grasp_wants_them(monkeypatch: pytest.MonkeyPatch) -> None:
    clearance = PLANNER.clearance
    monkeypatch.setattr(clearance.hand, "advance", lambda width: -0.1 * width)
    found = clearance.clear(box(0.03), grasp(box(0.03), 0.05))
    assert found is not None
    beyond = found.pose.position[0] - 0.5
    assert beyond == pytest.approx(0.005 - OUTWARD, abs=0.001), "the site goes 5 mm beyond, where pads lag by 5 mm"


def test_asking_leaves_the_arms_model_as_it_was() -> None:
    arm = PLANNER.arm
    before = arm.pose(arm.home).position
    kept_back(box(0.14), 0.05)
    assert arm.pose(arm.home).position == pytest.approx(before)
    assert not arm.collides(arm.home)
