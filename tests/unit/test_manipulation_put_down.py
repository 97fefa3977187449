"""What the hand cannot bring as it grasped it is tipped, where it does not fall then."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.arm.trajectory import whole
from services.manipulation.config import ManipulationConfig
from services.manipulation.grasps.grasp import approach_rotation
from services.manipulation.grasps.grasped_object import GraspedObject
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import PlanError
from services.manipulation.planning.plan_grab import plan_grab
from services.manipulation.planning.plan_place import DROP, PlacePlan, can_be_set_down, plan_place
from services.manipulation.planning.planning_scene import SLAB
from services.manipulation.planning.put_down import FALLS, tipped
from tests.unit.test_manipulation_stances import PLANNER, REST

WORKTOP, SPOTS = 0.91, [(0.44, 0.0), (0.5, 0.15)]


def from_above(size: tuple[float, float, float], points: Array | None = None) -> GraspedObject:
    """Something that the hand took from straight above, its fingers across it."""
    hand = approach_rotation(0.0, math.pi / 2)
    return GraspedObject("thing", "", hand, np.array([0.0, 0.0, 0.025]), size, 0.022, 0.0, points=points)


def rod(radius: float = 0.011) -> GraspedObject:
    turns = np.linspace(0.0, math.tau, 40)
    seen = [[x, radius * math.cos(t), radius * math.sin(t)] for x in (-0.12, 0.0, 0.12) for t in turns]
    return from_above((0.24, 2 * radius, 2 * radius), np.array(seen))


def placed(held: GraspedObject, height: float = WORKTOP) -> PlacePlan:
    worktop = Obstacle((0.66, 0.0, height - SLAB / 2), (0.6, 1.6, SLAB), 0.0)
    return plan_place(PLANNER, held, SPOTS, height, DROP, [worktop], REST)


def test_a_rod_from_above_is_rolled_onto_a_surface_as_high_as_the_elbow() -> None:
    plan = placed(rod())
    hand = PLANNER.arm.pose(plan.lower[-1])
    assert hand.rotation[2, 2] > -0.97, "straight down the arm does not come there"
    along = hand.rotation @ rod().rotation.T @ (1.0, 0.0, 0.0)
    assert abs(along[2]) < 0.05, "it is rolled about its own length, and neither end is in the air"


@pytest.mark.parametrize("higher", [0.06, 0.1])
def test_what_is_as_thick_as_a_whisk_is_rolled_farther_onto_what_is_higher(higher: float) -> None:
    held = replace(rod(0.03), offset=np.array([0.0, 0.0, 0.035]), width=0.06)
    hand = PLANNER.arm.pose(placed(held, WORKTOP + higher).lower[-1])
    assert hand.rotation[2, 2] > -math.cos(math.radians(31)), "tipped by 30 degrees the arm does not come there"


def test_it_is_taken_so_that_it_can_be_put_where_it_belongs() -> None:
    block = Target("block", "block", (0.68, 0.0, 0.52), 0.3, (0.1, 0.05, 0.04), shape="box")
    table = Obstacle((0.8, 0.0, 0.5 - SLAB / 2), (0.5, 1.0, SLAB), 0.0)

    def slant(to: float | None) -> float:
        config = ManipulationConfig()
        plan = plan_grab(
            PLANNER, block, [[table]], REST, config.approach_distance, config.lift_height, config.reach, [], [], to
        )  # fmt: skip
        assert to is None or can_be_set_down(PLANNER, plan.grasped, to, REST)
        return float(plan.grasp.pose.rotation[2, 2])

    assert slant(None) < -0.99 < slant(WORKTOP), "from straight above it could only be taken"


@pytest.mark.parametrize("degrees", [45, 60])
def test_what_stands_is_not_tipped_past_its_balance(degrees: float) -> None:
    assert not tipped(from_above((0.06, 0.06, 0.2)), (0.5, 0.0), 0.0, math.radians(degrees))


def test_what_would_fall_over_is_not_tipped() -> None:
    with pytest.raises(PlanError, match="no IK"):
        placed(from_above((0.066, 0.066, 0.1)))


@pytest.mark.parametrize(
    ("size", "may"), [((0.24, 0.022, 0.022), True), ((0.2, 0.1, 0.03), False)], ids=["rod", "book"]
)
def test_it_is_tipped_only_as_far_as_its_middle_does_not_fall_back(size: tuple[float, float, float], may: bool) -> None:
    poses = tipped(from_above(size), (0.5, 0.0), 0.0, math.radians(30))
    assert bool(poses) == may
    assert all(pose.raised <= FALLS for pose in poses)


@pytest.mark.parametrize(
    ("size", "up", "tilt", "height"),
    [((0.06, 0.06, 0.2), 0.03, 0.8, 0.76), ((0.07, 0.05, 0.16), 0.03, 0.3, 0.5), ((0.05, 0.05, 0.16), 0.05, 0.8, 0.9)],
)
def test_what_hangs_lower_than_believed_comes_over_the_edge(
    size: tuple[float, float, float], up: float, tilt: float, height: float
) -> None:
    hand, lower = approach_rotation(0.0, tilt), 0.05
    held = GraspedObject("thing", "", hand, np.array([0.0, 0.0, up]), size, 0.05, 0.0)
    table = Obstacle((0.76, 0.0, height - SLAB / 2), (0.6, 1.6, SLAB), 0.0)
    path = whole(plan_place(PLANNER, held, [(0.62, 0.0), (0.55, 0.1)], height, DROP, [table], REST).reach)
    arm = PLANNER.arm
    arm.set_obstacles([table], 0.0)
    arm.hold(*held.box(lower))
    try:
        met = [arm.collides(a + s * (b - a)) for a, b in itertools.pairwise(path) for s in np.linspace(0.0, 1.0, 20)]
    finally:
        arm.hold(None)
    assert not any(met)
