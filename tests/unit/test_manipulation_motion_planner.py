"""Plans of the arm alone."""

from dataclasses import replace
from itertools import pairwise, takewhile

import numpy as np
import pytest

from common.approach import EDGE_DISTANCE
from common.geometry import Array
from services.manipulation.arm.arm_model import ArmModel, Obstacle, Pose
from services.manipulation.arm.ik import seeds
from services.manipulation.arm.trajectory import whole
from services.manipulation.grasps.grasp import approach_rotation
from services.manipulation.grasps.grasped_object import SHRINK, GraspedObject
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import NEAR, LastAnswers, Planner, inflated
from services.manipulation.planning.plan_place import DEEPEST, plan_place
from services.manipulation.planning.planning_scene import obstacles
from services.sim.model import own
from tests.unit.test_manipulation_stances import HOME, PLANNER


def touching(arm: ArmModel, q: Array) -> list[tuple[str, str]]:
    """Names of the geoms that touch each other."""
    arm.collides(q)
    return [(arm.model.geom(int(a)).name, arm.model.geom(int(b)).name) for a, b in arm._pairs()]


def test_where_the_arm_is_stretched_it_leaves_the_way_it_came() -> None:
    planner = Planner(own().mjcf, 0)
    held = GraspedObject(
        "box", "box", approach_rotation(0.0, np.pi / 2), np.array([0.0, 0.0, 0.06]), (0.06, 0.06, 0.10), 0.06, 0.0
    )
    plan = plan_place(planner, held, [(0.5, 0.0)], 0.65, 0.004, [], planner.arm.home.copy())
    top = planner.arm.pose(plan.retreat[-1]).position
    assert np.allclose(top[:2], (0.5, 0.0), atol=0.01) and top[2] > 0.65 + 0.06 + 0.07
    assert np.allclose(planner.arm.pose(plan.retreat[0]).position, (0.5, 0.0, 0.65 + 0.004 + 0.06), atol=0.01)


def test_on_its_way_home_the_arm_keeps_clear_of_what_it_put_down() -> None:
    planner = Planner(own().mjcf, 0)
    size, yaw, spot = (0.06, 0.08, 0.13), 1.5875, (0.520, 0.001)
    turn, offset = approach_rotation(0.0167, np.pi / 6), np.array([0.0, 0.0, 0.078])
    held = GraspedObject("box", "box", turn, offset, size, 0.06, yaw)
    plan = plan_place(planner, held, [spot], 0.46, 0.004, [], planner.arm.home.copy())
    planner.arm.set_obstacles([Obstacle((*spot, 0.46 + size[2] / 2), size, yaw)])
    way = [plan.retreat[-1], *whole(plan.home)]
    between = (a + (b - a) * s for a, b in pairwise(way) for s in np.linspace(0, 1, 40))
    assert not any(planner.arm.collides(q) for q in between)


def test_in_free_motion_the_arm_keeps_away_from_the_mast_and_not_from_where_it_has_to_start() -> None:
    planner = Planner(own().mjcf, 0)
    arm = planner.arm
    arm.set_obstacles((), 0.0)
    stretching = (arm.home + np.array([0, 0, 0, bend, 0, 0, 0]) for bend in np.arange(0.0, 3.0, 0.01))
    free = [q for q, _ in pairwise(takewhile(lambda q: not arm.collides(q), stretching))][-1]
    pairs = {name for pair in touching(arm, free + np.array([0, 0, 0, 0.02, 0, 0, 0])) for name in pair}
    assert pairs & {"mast", "mast_arm", "head"}, pairs
    arm.set_obstacles((), 0.02)
    assert arm.collides(free)
    planner.surround((), arm.home)
    assert arm.collides(free), "a way that begins and ends in the open keeps the widest distance"
    planner.surround((), free)
    assert not arm.collides(free)


def test_beside_something_near_the_arm_still_keeps_away_from_its_own_base() -> None:
    """`bent`: within 15 mm of the mast, and not at home, where the hand is nearest to the box."""
    planner = Planner(own().mjcf, 0)
    arm = planner.arm
    stretching = [arm.home + np.array([0, 0, 0, bend, 0, 0, 0]) for bend in np.arange(0.0, 3.0, 0.01)]
    arm.set_obstacles((), 0.015)
    bent = next(q for q in stretching if arm.collides(q))
    arm.set_obstacles((), 0.005)
    assert not arm.collides(bent)
    x, y, z = arm.pose(arm.home).position
    box = next(
        found
        for off in np.arange(0.0, 0.3, 0.002)
        if not _collides(planner, found := Obstacle((x + 0.05 + off, y, z), (0.1, 0.1, 0.1)))
    )
    planner.surround([box], arm.home)
    assert any("box_0" not in pair for pair in touching(arm, bent))


def _collides(planner: Planner, box: Obstacle) -> bool:
    planner.arm.set_obstacles([box], 0.0)
    return planner.arm.collides(planner.arm.home)


def test_in_straight_motions_the_arm_keeps_off_its_base_by_as_much_as_it_lags() -> None:
    arm = Planner(own().mjcf, 0).arm
    arm.set_obstacles((), 0.0)
    bending = (arm.home + np.array([0, 0, 0, bend, 0, 0, 0]) for bend in np.arange(0.0, 3.0, 0.002))
    near = list(takewhile(lambda q: not arm.collides(q), bending))[-1]
    assert not arm.meets_itself([arm.home, near])
    hand = arm.pose(arm.home).position
    arm.set_obstacles([Obstacle((hand[0], hand[1], hand[2]), (0.1, 0.1, 0.1), 0.0)])
    assert arm.collides(arm.home) and not arm.meets_itself([arm.home]), "a box is not the robot"
    assert arm.meets_itself([arm.home, near])


def test_the_arm_and_what_it_holds_meet_the_floor_on_which_the_base_stands() -> None:
    planner = Planner(own().mjcf, 0)
    arm = planner.arm

    def at(height: float) -> Array:
        pose = Pose(np.array([arm.forward + 0.48, 0.0, height]), approach_rotation(0.0, np.pi / 2))
        found = planner.ik.solve(pose, seeds(arm, pose, arm.home))
        assert found is not None
        return found

    arm.set_obstacles(inflated(obstacles(HOME, (0.0, 0.0, 0.0), []), NEAR))
    assert not arm.collides(arm.home)
    arm.set_obstacles(obstacles(HOME, (0.0, 0.0, 0.0), []))
    assert arm.collides(at(0.0)) and not arm.collides(at(0.03))
    arm.hold(np.array([0.03, 0.03, 0.06]), np.zeros(3))
    assert arm.collides(at(0.05)) and not arm.collides(at(0.07))


@pytest.mark.parametrize(("high", "grounded"), [(0.03, True), (0.12, False)])
def test_what_hangs_higher_than_it_was_measured_is_followed_down_to_where_the_hand_would_meet_the_surface(
    high: float, grounded: bool
) -> None:
    planner = Planner(own().mjcf, 0)
    size, offset = (0.06, 0.06, 0.15), np.array([0.0, 0.0, high])
    held = GraspedObject("box", "box", approach_rotation(0.0, np.pi / 6), offset, size, 0.06, 0.0)
    tray = Obstacle((0.7, 0.0, 0.39), (0.36, 0.5, 0.14), 0.0)
    plan = plan_place(planner, held, [(0.576, 0.0)], 0.46, 0.004, [tray], planner.arm.home.copy())
    assert plan.grounded == grounded
    way = [planner.arm.pose(q).position for q in (plan.lower[-1], *plan.deeper)]
    assert np.allclose([p[:2] for p in way], way[0][:2], atol=0.002)
    assert way[-1][2] == pytest.approx(way[0][2] - DEEPEST, abs=0.002) or grounded
    planner.arm.set_obstacles([tray])
    assert not any(planner.arm.collides(q) for q in plan.deeper)


@pytest.mark.parametrize("lay", [False, True])
def test_with_a_finger_in_its_handle_a_mug_is_left_straight_back(lay: bool) -> None:
    planner, size = Planner(own().mjcf, 0), (0.071, 0.071, 0.104)
    level = approach_rotation(0.0, 0.0)
    stood = GraspedObject("mug", "mug", level, np.array([0.0, 0.0, 0.052]), size, 0.0705, 0.0)
    held = replace(stood, as_found=stood) if lay else stood
    assert held.entangled == lay
    tray = Obstacle((0.7, 0.0, 0.39), (0.36, 0.5, 0.14), 0.0)
    plan = plan_place(planner, held, [(0.576, 0.0)], 0.46, 0.004, [tray], planner.arm.home.copy())
    heights = [planner.arm.pose(q).position[2] for q in plan.retreat]
    assert (np.ptp(heights) < 0.005) == lay, "where nothing holds it back the hand may rise"


def test_a_path_is_free_of_everything_by_a_margin_as_long_as_it_is_not_said_to_be_near() -> None:
    planner = Planner(own().mjcf, 0)
    arm, above = planner.arm, Pose(np.array([0.55, 0.0, 0.6]), approach_rotation(0.0, np.pi / 2))
    end = planner.ik.solve(above, seeds(arm, above, arm.home))
    assert end is not None
    table = Obstacle((0.9, 0.0, 0.40), (0.8, 0.8, 0.3))
    (far, near) = (leg.path for leg in planner.legs([arm.home, end], [table]))
    assert near[0] is far[-1] and near[-1] is end
    arm.set_obstacles(inflated([table], 0.9 * NEAR), 0.0)
    assert not any(arm.collides(a + (far[-1] - a) * s) for a in far[:1] for s in np.linspace(0, 0.95, 40))
    assert any(arm.collides(near[0] + (end - near[0]) * s) for s in np.linspace(0, 1, 40))
    assert [leg.near for leg in planner.legs([arm.home, end], [table])] == [False, True]
    assert [leg.near for leg in planner.legs([arm.home, end], [])] == [False]
    ways = planner.legs([arm.home, end], [], leaving=0.15)
    assert [leg.near for leg in ways] == [True, False], "slowly at first with what was just lifted"
    assert np.linalg.norm(arm.pose(ways[1].path[0]).position - arm.pose(arm.home).position) < 0.15 + 0.05


def test_what_is_held_counts_where_the_way_leads_near_something() -> None:
    planner = Planner(own().mjcf, 0)
    arm, above = planner.arm, Pose(np.array([0.55, 0.0, 0.75]), approach_rotation(0.0, np.pi / 2))
    end = planner.ik.solve(above, seeds(arm, above, arm.home))
    table = Obstacle((0.9, 0.0, 0.40), (0.8, 0.8, 0.3))
    assert end is not None and not any(leg.near for leg in planner.legs([arm.home, end], [table]))
    arm.hold(np.array([0.03, 0.03, 0.15]), np.array([0.0, 0.0, 0.2]))
    assert planner.legs([arm.home, end], [table])[-1].near


def test_the_hand_keeps_away_from_its_own_shoulder_and_upper_arm() -> None:
    """`folded`: between 5 and 15 mm from the shoulder, which it does not touch."""
    planner = Planner(own().mjcf, 0)
    arm = planner.arm
    arm.set_obstacles((), 0.0)
    folding = [arm.home + np.array([0, 0, 0, 0, 0, bend, 0]) for bend in np.arange(0.0, -1.2, -0.005)]
    free = list(takewhile(lambda q: not arm.collides(q), folding))
    pairs = touching(arm, folding[len(free)])
    assert {name for pair in pairs for name in pair} & {"shoulder_link", "shoulder", "half_arm_1_link", "upper_arm"}
    arm.set_obstacles((), 0.015)
    folded = next(q for q in free if arm.collides(q))
    arm.set_obstacles((), 0.005)
    assert not arm.collides(folded), "where it has to it comes nearer"
    planner.surround((), arm.home)
    assert arm.collides(folded)


def test_a_carry_pose_that_has_little_room_is_better_than_none() -> None:
    planner = Planner(own().mjcf, 0)
    turn, offset = approach_rotation(0.0, np.pi / 6), np.array([0.0, 0.0, 0.05])
    start = planner.ik.solve(
        above := Pose(np.array([0.6, 0.0, 0.8]), turn), seeds(planner.arm, above, planner.arm.home)
    )
    assert start is not None
    for size in np.arange(0.06, 0.4, 0.02):
        held = GraspedObject("box", "box", turn, offset, (size, size, 0.1), 0.06, 0.0)
        planner.arm.hold(*held.box())
        planner.arm.set_obstacles((), 0.0)
        clear = any(not planner.arm.collides(planner.arm.nearest_turn(c, start)) for c in planner.carries)
        assert not clear or planner.to_carry(held, start, ()), f"{size:.2f} m"


@pytest.mark.parametrize("size", [(0.12, 0.12, 0.18), (0.065, 0.1, 0.2), (0.07, 0.07, 0.26), (0.16, 0.16, 0.06)])
@pytest.mark.parametrize("tilt", [15, 45, 90])
def test_what_is_carried_stays_behind_the_edges_that_the_base_drives_up_to(
    size: tuple[float, float, float], tilt: float
) -> None:
    turn, offset = approach_rotation(0.0, np.radians(tilt)), np.array([0.0, 0.0, size[2] / 2])
    held = GraspedObject("thing", "", turn, offset, size, 0.02, 0.0)
    path = PLANNER.to_carry(held, PLANNER.carries[-1], ())
    assert path is not None
    hand, (half, middle, turned) = PLANNER.arm.pose(whole(path)[-1]), held.box()
    front = float((hand.position + hand.rotation @ middle)[0] + np.abs((hand.rotation @ turned)[0]) @ (half + SHRINK))
    assert front < EDGE_DISTANCE


def test_what_was_found_for_a_target_is_found_once() -> None:
    asked: list[Target] = []
    answers = LastAnswers(lambda t: asked.append(t) or len(asked))  # type: ignore[func-returns-value]
    one, other = (Target("thing", "", (0.5, 0.0, 0.7), 0.0, (0.05, 0.05, 0.05)) for _ in range(2))
    assert [answers(t) for t in (one, one, other, one)] == [1, 1, 2, 1], "equal ones may have other points"
