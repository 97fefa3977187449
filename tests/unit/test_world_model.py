"""Rectangles on the floor plan, the surface under a point, and what the gripper holds."""

import math

import msgspec
import pytest

from common import messages as m
from common.approach import EDGE_DISTANCE, poses_for
from common.floor_plan import Box, Place, Receptacle
from common.furniture_tops import support_at
from common.geometry import Rectangle
from common.household import Household
from common.robot.grip import Grip, grip_of

TURNED = Rectangle(1.0, 2.0, 2.0, 1.0, math.pi / 6)
SHELF = Receptacle(name="shelf", kind="shelf", center=(0.0, 0.0, 0.8), size=(1.0, 0.4), yaw=math.pi / 4)
BIN = Receptacle(name="bin", kind="bin", center=(3.0, 0.0, 0.02), size=(0.3, 0.3), depth=0.4)
SCENE = Household(name="s", low=(-5, -5), high=(5, 5), home=Place(name="home", x=0, y=0), receptacles=(SHELF, BIN))
ALONG = (0.45 * math.sqrt(0.5), 0.45 * math.sqrt(0.5))
"""A point of the turned shelf that would be beside it if its yaw were ignored."""


def test_a_rectangles_own_frame_and_the_maps_are_each_others_inverse() -> None:
    x, y = TURNED.to_map(1.0, 0.5)
    assert (x, y) == pytest.approx((1 + math.cos(math.pi / 6) - 0.25, 2 + 0.5 + 0.5 * math.cos(math.pi / 6)))
    assert TURNED.to_local(x, y) == pytest.approx((1.0, 0.5))
    assert TURNED.direction(1.0, 0.0) == pytest.approx((math.cos(math.pi / 6), 0.5))


@pytest.mark.parametrize(
    ("local", "inside", "distance"),
    [((0.99, 0.49), True, 0.0), ((1.2, 0.0), False, 0.2), ((0.0, -0.8), False, 0.3), ((1.3, 0.9), False, 0.5)],
)
def test_containing_and_distance_follow_the_yaw(local: tuple[float, float], inside: bool, distance: float) -> None:
    point = TURNED.to_map(*local)
    assert TURNED.contains(*point) is inside
    assert TURNED.distance(*point) == pytest.approx(distance, abs=1e-9)
    assert TURNED.contains(*point, margin=distance + 1e-9)
    assert TURNED.grown(distance + 1e-9).contains(*point)


@pytest.mark.parametrize(
    ("x", "y", "z", "name"),
    [
        (*ALONG, 0.85, "shelf"),
        (ALONG[0], -ALONG[1], 0.85, ""),
        (*ALONG, 1.3, ""),
        (*ALONG, 0.70, ""),
        (0.0, 0.235 * math.sqrt(2), 0.85, ""),
        (3.1, 0.1, 0.39, "bin"),
        (3.1, 0.1, 0.45, ""),
        (3.165, 0.0, 0.1, "bin"),
    ],
)
def test_the_surface_on_which_an_object_rests(x: float, y: float, z: float, name: str) -> None:
    found = SCENE.resting_place((x, y, z))
    assert (found.name if found else "") == name


def test_without_a_height_the_surface_is_the_one_over_or_under_the_point() -> None:
    assert SCENE.surface_at(*ALONG) is SHELF and SCENE.surface_at(3.0, 0.0) is BIN
    assert SCENE.surface_at(3.165, 0.0) is None and SCENE.surface_at(3.165, 0.0, margin=0.02) is BIN
    assert SCENE.surface_at(*ALONG, 3.0) is SHELF, "a hand high above it"


def test_furniture_holds_things_before_every_side_that_no_back_rises_from() -> None:
    """A sofa turned by a quarter: its own +x is the map's +y, where its back is."""
    seat = Box(name="seat", center=(2.0, 1.0, 0.21), size=(0.9, 2.0, 0.42), yaw=math.pi / 2)
    back = Box(name="back", center=(2.0, 1.36, 0.60), size=(0.18, 2.0, 0.40), yaw=math.pi / 2)
    cushion = Box(name="cushion", center=(1.2, 1.0, 0.46), size=(0.3, 0.3, 0.08))
    rug = Box(name="rug", center=(2.0, 0.0, 0.005), size=(3.0, 1.0, 0.01))
    plan = msgspec.structs.replace(SCENE, furniture=(seat, back, cushion, rug), receptacles=())
    held = support_at(plan, 1.7, 0.9)
    assert held is not None and (held.name, held.center[2], held.outline) == ("seat", 0.42, seat.outline)
    assert set(held.approach) == {(-1, 0), (0, 1), (0, -1)}
    on_top = support_at(plan, 1.2, 1.0)
    assert on_top is not None and on_top.name == "cushion", "the highest that is under it"
    assert support_at(plan, 2.0, 0.2) is None, "a rug holds nothing up"
    nearest = min(poses_for((2.0, 0.75), held))[1]
    assert nearest[:2] == pytest.approx((2.0, 0.55 - EDGE_DISTANCE)), "from the front, with room before the seat"


def test_a_surface_counts_before_the_furniture_under_it() -> None:
    body = Box(name="body", center=(0, 0, 0.5), size=(9, 9, 1))
    assert support_at(msgspec.structs.replace(SCENE, furniture=(body,)), *ALONG) is SHELF


@pytest.mark.parametrize(
    ("start", "end", "touches"),
    [
        ((-2.0, 0.0), (2.0, 0.0), True), ((0.1, 0.1), (0.2, 0.1), True), ((-2.0, 0.0), (-1.1, 0.0), False),
        ((-2.0, 0.6), (2.0, 0.6), False), ((0.0, -2.0), (0.0, 2.0), True), ((-1.4, 0.3), (0.0, 1.7), False),
        ((-1.4, 0.0), (0.0, 0.6), True),
    ],
)  # fmt: skip
def test_a_line_meets_a_rectangle(start: tuple[float, float], end: tuple[float, float], touches: bool) -> None:
    assert TURNED.meets(TURNED.to_map(*start), TURNED.to_map(*end)) is touches
    assert TURNED.meets(TURNED.to_map(*end), TURNED.to_map(*start)) is touches


@pytest.mark.parametrize(
    ("width", "effort", "holds"),
    [(0.05, 25.0, True), (0.05, -25.0, True), (0.05, 2.5, False), (0.002, 25.0, False), (0.083, 25.0, False)],
)
def test_the_gripper_holds_what_keeps_pressing_fingers_apart(width: float, effort: float, holds: bool) -> None:
    joints = m.JointStates(t=0.0, name=["joint_1", "gripper"], position=[0.0, width], velocity=[], effort=[0.0, effort])
    grip = grip_of(joints)
    assert grip == Grip(width, abs(effort)) and grip.holds() is holds


def test_no_gripper_is_reported_by_joints_without_one() -> None:
    assert grip_of(None) is None
    assert grip_of(m.JointStates(t=0.0, name=["joint_1"], position=[0.0], velocity=[], effort=[])) is None
    assert grip_of(m.JointStates(t=0.0, name=["a", "gripper"], position=[0.0], velocity=[], effort=[])) is None
    bare = grip_of(m.JointStates(t=0.0, name=["gripper"], position=[0.04], velocity=[], effort=[]))
    assert bare == Grip(0.04, 0.0) and not bare.holds()
