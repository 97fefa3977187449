"""Grasps in a crowd: neighbours are the solids that they are, and what is in the way has a name."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from common import messages as m
from common.geometry import yaw_quat
from common.household import load_household
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import PlanError, Planner
from services.manipulation.planning.plan_grab import BESIDE, GrabPlan, from_place, plan_grab, same_hold
from services.manipulation.planning.planning_scene import MARGINS, obstacles, target_of
from services.sim.model import own

PLANNER = Planner(own().mjcf, seed=0)
ARM = PLANNER.arm
TABLE = Obstacle((0.75, 0.0, 0.53), (0.6, 1.0, 0.14))
CAN = Target("green can", "can", (0.6, 0.0, 0.66), 0.0, (0.066, 0.066, 0.12))


def beside(bearing: float, gap: float, label: str) -> Target:
    """Another can in the direction `bearing` [deg], with `gap` [m] of free space between the two."""
    far, angle = CAN.size[0] + gap, math.radians(bearing)
    at = (CAN.position[0] + far * math.cos(angle), CAN.position[1] + far * math.sin(angle), CAN.position[2])
    return Target(label, "can", at, 0.0, CAN.size)


def grab(*others: Target) -> GrabPlan:
    around = [[TABLE, *(o.grown(margin) for o in others)] for margin in MARGINS]
    return plan_grab(PLANNER, CAN, around, ARM.home.copy(), 0.1, 0.1, 1.0, frozenset(), [])


def meets(*around: Obstacle) -> bool:
    ARM.set_obstacles(around)
    found = ARM.collides(ARM.home)
    ARM.set_obstacles(())
    return found


def test_a_round_neighbour_has_no_corners() -> None:
    x, y, z = (float(v) for v in ARM.pose(ARM.home).position)
    for solid, hit in (("box", True), ("cylinder", True), ("ellipsoid", False)):
        assert meets(Obstacle((x + 0.05, y, z), (0.1, 0.1, 0.1), 0.0, solid)) is hit  # type: ignore[arg-type]
    # A roller along y reaches sideways where one along x does not.
    for yaw, hit in ((math.pi / 2, True), (0.0, False)):
        assert meets(Obstacle((x, y + 0.1, z), (0.1, 0.04, 0.04), yaw, "cylinder", lies=True)) is hit


def test_a_lying_cylinder_is_as_long_and_as_thick_as_it_was_measured() -> None:
    _, size, half, _ = Obstacle((0, 0, 0), (0.2, 0.06, 0.06), 0.3, "cylinder", lies=True).geom()
    assert size[:2] == pytest.approx([0.03, 0.1]) and half == pytest.approx([0.03, 0.03, 0.1])
    _, size, half, _ = Obstacle((0, 0, 0), (0.06, 0.06, 0.2), 0.3, "cylinder").geom()
    assert size[:2] == pytest.approx([0.03, 0.1]) and half == pytest.approx([0.03, 0.03, 0.1])


def test_fingers_go_in_wide_open_where_there_is_room_and_partly_closed_where_there_is_not() -> None:
    assert grab().opening is None
    assert grab(beside(90.0, 0.06, "red can")).opening is None
    thin = replace(CAN, size=(0.03, 0.03, 0.12))
    posts = [(0.6 + dx, dy, 0.66) for dx, dy in ((0.0, 0.07), (0.0, -0.07), (0.07, 0.0), (-0.07, 0.0))]
    around = [TABLE, *(Obstacle(at, (0.05, 0.05, 0.12), 0.0, "cylinder", label="post") for at in posts)]
    plan = plan_grab(PLANNER, thin, [around], ARM.home.copy(), 0.1, 0.1, 1.0, frozenset(), [])
    assert plan.opening is not None and 0.03 < plan.opening < ARM.hand.open
    ARM.set_obstacles(around)
    assert any(ARM.collides(q) for q in plan.insert), "wide open they would not go in"
    ARM.open_fingers(plan.opening)
    assert not any(ARM.collides(q) for q in plan.insert)
    ARM.open_fingers()


def test_what_is_in_the_way_has_a_name_and_furniture_has_none() -> None:
    ring = [beside(bearing, 0.004, f"can {n}") for n, bearing in enumerate(range(0, 360, 45))]
    tall = [Target(t.label, t.kind, t.position, 0.0, (0.066, 0.066, 0.3)) for t in ring]
    with pytest.raises(PlanError) as failed:
        grab(*tall)
    assert failed.value.code == "UNREACHABLE"
    assert set(failed.value.blockers) <= {t.label for t in ring} and failed.value.blockers
    assert failed.value.blockers[0] in str(failed.value)
    with pytest.raises(PlanError) as alone:
        walls = [Obstacle((0.6 + dx, dy, 0.7), (0.02, 0.02, 0.4)) for dx in (-0.05, 0.05) for dy in (-0.05, 0.05)]
        plan_grab(PLANNER, CAN, [[TABLE, *walls]], ARM.home.copy(), 0.1, 0.1, 1.0, frozenset(), [])
    assert alone.value.blockers == ()


def test_objects_grow_by_the_spread_of_what_was_measured() -> None:
    scene, base = load_household("apartment"), (0.0, 0.0, 0.0)
    seen = m.WorldObject(
        label="toy",
        kind="",
        colour="red",
        position=(0.6, 0.0, 0.7),
        size=(0.05, 0.06, 0.07),
        shape="ball",
        spread=0.003,
    )
    for margin, size in ((0.004, 0.05 + 2 * 0.007), (0.0, 0.05)):
        (found,) = [o for o in obstacles(scene, base, [seen], margin=margin) if o.label]
        assert found.label == "toy" and found.solid == "ellipsoid" and found.size[0] == pytest.approx(size)


def test_surface_points_come_along_the_axes_of_the_base() -> None:
    scene, base = load_household("apartment"), (1.0, 0.0, math.pi / 2)
    points = np.array([[10, 0, 0]] * 20, "<i2").tobytes()
    seen = m.WorldObject(
        label="toy", kind="", colour="red", position=(1.0, 0.6, 0.7), size=(0.05, 0.06, 0.07), points=points,
        orientation=yaw_quat(0.4),
    )  # fmt: skip
    found = target_of(seen, base, scene)
    assert found.points is not None and found.points[0] == pytest.approx([0.0, -0.01, 0.0], abs=1e-9)
    assert target_of(m.WorldObject("x", "", "", (1.0, 0.6, 0.7), points=points[:60]), base, scene).points is None


def test_a_neighbour_at_two_centimetres_leaves_room_for_a_finger() -> None:
    for bearing in (90.0, -90.0, 180.0):
        plan = grab(beside(bearing, 0.02, "red can"))
        ARM.set_obstacles([beside(bearing, 0.02, "red can").grown(0.0)])
        ARM.open_fingers(plan.opening)
        assert not any(ARM.collides(q) for q in plan.insert)
        ARM.open_fingers()


@pytest.mark.parametrize(("gap", "tall", "higher"), [(0.04, 0.12, True), (0.04, 0.05, False), (0.2, 0.12, False)])
def test_what_is_held_goes_over_its_neighbours_before_it_goes_away(gap: float, tall: float, higher: bool) -> None:
    can = beside(180.0, gap, "red can")
    can = replace(can, size=(*can.size[:2], tall), position=(*can.position[:2], 0.6 + tall / 2))
    plan = grab(can)
    risen = float(ARM.pose(plan.lift[-1]).position[2] - plan.grasp.pose.position[2])
    assert risen == pytest.approx(0.15 if higher else 0.1, abs=0.006)


def test_fingertips_that_close_do_not_press_on_the_table() -> None:
    """Bench, rod, seed 30: open they were clear of it, closed they pressed with 33 N, and the rod was too heavy."""
    for low in (0.012, 0.02, 0.03, 0.05):
        rod = Target("rod", "", (0.55, 0.0, 0.6 + low / 2), 0.4, (0.16, 0.03, low), shape="box", measured=True)
        plan = plan_grab(PLANNER, rod, [[TABLE]], ARM.home.copy(), 0.1, 0.1, 1.0, frozenset(), [])
        for width in (ARM.hand.open, plan.grasp.width):
            assert PLANNER.clearance.met(plan.grasp.pose, width, [TABLE]) == set()


def test_what_failed_is_not_tried_again_under_the_name_it_has_once_the_thing_was_measured_anew() -> None:
    rng, along = np.random.default_rng(0), np.array([0.001, -0.002, 0.0])
    top = rng.uniform((-0.09, -0.012, 0.014), (0.09, 0.012, 0.015), (300, 3))
    rod = Target("rod", "", (0.55, 0.0, 0.615), 0.0, (0.18, 0.024, 0.03), shape="irregular", points=top, measured=True)
    moved = replace(rod, position=(0.58, 0.02, 0.615), points=top + along)

    def first(target: Target, skip: Sequence[Grasp]) -> tuple[Grasp, Grasp]:
        plan = plan_grab(PLANNER, target, [[TABLE]], ARM.home.copy(), 0.1, 0.1, 1.0, skip, [])
        grasp = next(g for g in plan.options if g.name == plan.grasp.name)
        return grasp, from_place(grasp, np.array(target.position))

    failed = first(rod, [])[1]
    again, other = first(moved, [])[1], first(moved, [failed])[1]
    assert failed.on_surface and again.name != failed.name and same_hold(again, failed), "it is called otherwise"
    assert not same_hold(other, failed)
    apart = float(np.linalg.norm(other.pose.position - failed.pose.position))
    assert apart > BESIDE, "what slipped out there does so from another side as well"


def test_the_arm_goes_home_around_the_table_from_within_what_is_believed_to_stand_there() -> None:
    now = grab().insert[-1]
    stale = CAN.grown(0.05)
    path = PLANNER.to_home(now, [[TABLE, stale], [TABLE]])
    ARM.set_obstacles([TABLE])
    ways = [np.linspace(a, b, 20) for a, b in pairwise(path)]
    free = not any(ARM.collides(q) for way in ways for q in way)
    straight = any(ARM.collides(q) for q in np.linspace(now, ARM.nearest_turn(ARM.home, now), 60))
    ARM.set_obstacles(())
    assert free and straight
