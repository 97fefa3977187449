"""Grasp candidates in full: order, names, where the fingers go, and what does not fit."""

import math
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import quat_matrix
from common.kinds import KINDS
from common.messages.perception import ShapeFamily
from services.manipulation.grasps.grasp import Grasp, approach_rotation, certainly_too_wide, on_handle, shown, upper_end
from services.manipulation.grasps.rules import RIM_DEPTH, candidates
from services.manipulation.grasps.target import Target

FORWARD = 0.12
BOWL = KINDS["bowl"]
AT = (0.62, -0.15, 0.70)
FACING = math.atan2(-0.15, 0.50)
TURNS = (0, 25, -25, 50, -50)


def target(
    kind: str, size: tuple[float, float, float], yaw: float = 0.0, at: tuple[float, float, float] = AT
) -> Target:
    return Target(f"my {kind}", kind, at, yaw, size)


def approach(grasp: Grasp) -> tuple[float, float]:
    """Azimuth and downward tilt [rad] of the way the hand goes."""
    x, y, z = grasp.pose.rotation[:, 2]
    return math.atan2(y, x), math.asin(-z)


def close(a: float, b: float, period: float = math.tau) -> bool:
    return abs(math.remainder(a - b, period)) < 1e-9


# --- the hand's axes
@pytest.mark.parametrize(("azimuth", "tilt"), [(0.0, 0.0), (0.7, 0.3), (-2.0, 1.2), (3.0, math.pi / 2)])
def test_the_hand_goes_where_it_is_told_with_level_fingers(azimuth: float, tilt: float) -> None:
    x, y, z = approach_rotation(azimuth, tilt).T
    ahead = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    assert np.allclose(z, math.cos(tilt) * ahead - math.sin(tilt) * np.array([0, 0, 1]))
    assert np.allclose(y, [-math.sin(azimuth), math.cos(azimuth), 0.0]), "the fingers close to the left and right"
    assert np.allclose(x, np.cross(y, z))


@pytest.mark.parametrize("roll", [0.4, -1.1, math.pi / 2])
def test_a_roll_turns_the_fingers_about_the_way(roll: float) -> None:
    plain, rolled = approach_rotation(0.3, 0.5), approach_rotation(0.3, 0.5, roll)
    assert np.allclose(rolled[:, 2], plain[:, 2])
    turn = np.array([[math.cos(roll), math.sin(roll), 0], [-math.sin(roll), math.cos(roll), 0], [0, 0, 1.0]])
    assert np.allclose(rolled, plain @ turn)


# --- round things
@pytest.mark.parametrize(
    ("kind", "tilts", "share"),
    [
        ("can", (15, 25, 5, 40), 0.55), ("bottle", (15, 25, 5, 40), 0.42),
        ("apple", (90, 65, 45, 30), 0.5), ("ball", (90, 65, 45, 30), 0.5),
    ],
)  # fmt: skip
def test_round_things_are_taken_from_the_robot_s_side_first(kind: str, tilts: tuple[int, ...], share: float) -> None:
    size = (0.05, 0.07, 0.12)
    found = candidates(target(kind, size, yaw=1.0), FORWARD, 0.08)
    assert [g.name for g in found] == [f"{d} deg at {t:+d}" for d in tilts for t in TURNS]
    for grasp, (degrees, turn) in zip(found, [(d, t) for d in tilts for t in TURNS], strict=True):
        height = share * size[2]
        assert grasp.width == 0.07 and grasp.height == pytest.approx(height)
        assert grasp.tilt == pytest.approx(math.radians(degrees))
        assert grasp.pose.position == pytest.approx([AT[0], AT[1], AT[2] - size[2] / 2 + height])
        assert np.allclose(grasp.pose.rotation, approach_rotation(FACING + math.radians(turn), math.radians(degrees)))


def test_the_wider_side_of_a_round_thing_counts() -> None:
    assert candidates(target("can", (0.09, 0.05, 0.1)), FORWARD, 0.08) == []
    assert candidates(target("can", (0.05, 0.09, 0.1)), FORWARD, 0.08) == []
    assert candidates(target("can", (0.08, 0.05, 0.1)), FORWARD, 0.08), "as wide as the hand fits"


@pytest.mark.parametrize(
    ("handle", "turns"),
    [
        (0, (0, 25, -25)), (180, (0, 25, -25)), (95, (-50,)), (-95, (50,)), (60, (25, 50)), (-60, (-25, -50)),
        (39, (0, 25, 50)), (41, (25, 50)), (-39, (0, -25, -50)), (141, (0, -25, -50)),
    ],
)  # fmt: skip
def test_no_finger_lands_within_50_degrees_of_a_mug_s_handle(handle: int, turns: tuple[int, ...]) -> None:
    mug = target("mug", (0.074, 0.074, 0.095), yaw=FACING + math.radians(handle))
    found = candidates(mug, FORWARD, 0.08)
    assert [g.name for g in found] == [f"{d} deg at {t:+d}" for d in (40, 55, 25) for t in turns]
    assert all(g.height == pytest.approx(0.55 * 0.095) and g.width == 0.074 for g in found)


# --- things with faces
def faces(found: list[Grasp], degrees: int) -> list[Grasp]:
    return [g for g in found if g.name.startswith(f"{degrees} deg")]


def test_a_box_is_taken_by_the_face_nearest_to_the_robot_s_way_then_from_above() -> None:
    size, yaw = (0.04, 0.06, 0.2), FACING + math.radians(20)
    found = candidates(target("box", size, yaw), FORWARD, 0.08)
    expected = [(d, off) for d in (15, 30, 45) for off in (20, -70)]
    expected += [(90, off) for off in (20, -70, 110, -160)] + [(70, off) for off in (20, -70)]
    assert [g.name for g in found] == [f"{d} deg on faces at {abs(off)}" for d, off in expected]
    for grasp, (degrees, off) in zip(found, expected, strict=True):
        assert grasp.width == (0.06 if off in (20, -160) else 0.04)
        assert grasp.height == pytest.approx(0.2 * (0.6 if degrees < 60 else 0.8))
        assert grasp.pose.position == pytest.approx([AT[0], AT[1], AT[2] - 0.1 + grasp.height])
        assert grasp.tilt == pytest.approx(math.radians(degrees))
        rotation = grasp.pose.rotation
        side = FACING + math.radians(off) + math.pi / 2  # the fingers close across the face
        assert close(math.atan2(rotation[1, 1], rotation[0, 1]), side, math.pi)
        if degrees == 90:
            assert rotation[2, 2] == pytest.approx(-1.0)
            # The hand looks the robot's way and turns by the least that brings the fingers onto the faces.
            roll = math.remainder(math.radians(off), math.pi)
            assert np.allclose(rotation, approach_rotation(FACING, math.pi / 2, roll))
        else:
            assert np.allclose(approach(grasp), (math.remainder(FACING + math.radians(off), math.tau), grasp.tilt))


def test_faces_turned_too_far_away_are_left_to_the_tilts_from_above() -> None:
    for aside, offs in ((14, [14, 76, 104]), (16, [16, 74])):
        found = candidates(target("box", (0.05, 0.05, 0.2), FACING + math.radians(aside)), FORWARD, 0.08)
        assert [g.name for g in faces(found, 15)] == [f"15 deg on faces at {off}" for off in offs]


def test_a_side_that_does_not_fit_is_left_out() -> None:
    found = candidates(target("box", (0.04, 0.09, 0.2), FACING), FORWARD, 0.08)
    assert found and all(g.width == 0.04 for g in found)
    assert candidates(target("box", (0.09, 0.09, 0.2)), FORWARD, 0.08) == []


@pytest.mark.parametrize(("tall", "tilts"), [(0.05, (90, 65, 45, 30)), (0.09, (15, 30, 45)), (0.2, (15, 30, 45))])
def test_low_things_are_taken_from_above_and_others_from_the_side(tall: float, tilts: tuple[int, ...]) -> None:
    found = candidates(target("block", (0.05, 0.05, tall), FACING), FORWARD, 0.08)
    assert list(dict.fromkeys(int(g.name.split()[0]) for g in found)) == list(tilts)
    assert all(g.height == pytest.approx(tall / 2) for g in found)


def test_unknown_kinds_are_taken_like_blocks() -> None:
    block, other = (candidates(target(kind, (0.05, 0.06, 0.05), 0.3), FORWARD, 0.08) for kind in ("block", "gadget"))
    assert [g.name for g in block] == [g.name for g in other] != []


def test_the_robot_s_way_is_from_where_the_arm_stands() -> None:
    for at in ((0.12, 0.5, 0.6), (-0.4, -0.2, 0.6), (0.7, 0.3, 0.6)):
        can = candidates(target("can", (0.06, 0.06, 0.1), at=at), FORWARD, 0.08)[0]
        assert close(approach(can)[0], math.atan2(at[1], at[0] - FORWARD))


# --- bowls
def test_a_bowl_is_taken_at_the_rim_along_its_slope() -> None:
    size = (0.14, 0.14, 0.06)
    bowl = target("bowl", size)
    found = candidates(bowl, FORWARD, 0.08)
    order = [(d, t, p) for d in (65, 72, 58, 80, 90) for t in TURNS for p in ("palm down", "palm up")]
    assert [g.name for g in found] == [f"rim at {t:+d}, {d} deg, {p}" for d, t, p in order]
    radius = 0.07 - RIM_DEPTH * math.tan(BOWL.lean) - BOWL.wall / 2
    for grasp, (degrees, turn, palm) in zip(found, order, strict=True):
        azimuth = FACING + math.radians(turn)
        assert grasp.width == BOWL.wall and grasp.height == pytest.approx(0.06 - RIM_DEPTH)
        ahead = np.array([math.cos(azimuth), math.sin(azimuth)])
        assert grasp.pose.position[:2] == pytest.approx(np.array(AT[:2]) - radius * ahead), "the near side of the rim"
        assert grasp.pose.position[2] == pytest.approx(AT[2] - 0.03 + 0.06 - RIM_DEPTH)
        roll = math.pi / 2 if palm == "palm down" else -math.pi / 2
        assert np.allclose(grasp.pose.rotation, approach_rotation(azimuth, math.radians(degrees), roll))
        assert grasp.tilt == pytest.approx(math.radians(degrees))
    assert candidates(bowl, FORWARD, BOWL.wall) and not candidates(bowl, FORWARD, BOWL.wall - 1e-6)


# --- for viewers
def test_what_is_shown_is_in_the_map_with_what_became_of_it() -> None:
    can = target("can", (0.066, 0.066, 0.115))
    options = candidates(can, FORWARD, 0.08)[:4]
    base = (2.0, 3.0, math.pi / 2)
    names = [g.name for g in options]
    told = shown(can, options, base, 7.0, names[:2], names[1], "a.1")
    assert (told.t, told.object, told.goal_id) == (7.0, "my can", "a.1")
    assert [c.name for c in told.candidates] == names
    assert [c.state for c in told.candidates] == ["failed", "chosen", "open", "open"]
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for candidate, grasp in zip(told.candidates, options, strict=True):
        assert candidate.position == pytest.approx(turn @ grasp.pose.position + [2.0, 3.0, 0.0])
        assert np.allclose(quat_matrix(candidate.orientation), turn @ grasp.pose.rotation)
        assert candidate.width == grasp.width


@pytest.mark.parametrize(("yaw", "lands"), [(-33, True), (147, True), (25, False), (90, False), (-90, False)])
def test_a_handle_seen_from_in_front_of_a_mug_says_whether_a_finger_would_land_on_it(yaw: int, lands: bool) -> None:
    """Fetch seed 36: a grasp along 65 degrees of a mug whose handle points along -33."""
    rotation = approach_rotation(math.radians(65), math.radians(40))
    assert on_handle(target("mug", (0.074, 0.074, 0.095), math.radians(yaw)), rotation) is lands
    assert not on_handle(target("can", (0.066, 0.066, 0.115), math.radians(yaw)), rotation)


# --- what lies, or stands on its head
@pytest.mark.parametrize("yaw", [0.4, FACING + 0.3, FACING + math.pi - 0.2, -2.5])
def test_a_lying_bottle_is_taken_below_its_middle_by_a_hand_that_leans_to_its_foot(yaw: float) -> None:
    lying = replace(target("bottle", (0.25, 0.07, 0.065), yaw=yaw), tilt=math.pi / 2)
    found = candidates(lying, FORWARD, 0.08)
    assert [round(math.degrees(g.tilt)) for g in found] == [75, 90, 90, 60]
    for grasp, azimuth in zip(found, (yaw + math.pi, yaw + math.pi, yaw, yaw + math.pi), strict=True):
        below = -0.14 * 0.25
        point = [AT[0] + below * math.cos(yaw), AT[1] + below * math.sin(yaw), AT[2]]
        assert grasp.pose.position == pytest.approx(point)
        assert np.allclose(grasp.pose.rotation, approach_rotation(azimuth, grasp.tilt))
        off = math.degrees(math.remainder(azimuth - FACING, math.tau))
        assert grasp.name == f"lying, {math.degrees(grasp.tilt):.0f} deg at {off:+.0f}"
        assert grasp.width == 0.07 and grasp.height == pytest.approx(0.0325)
        assert grasp.axis is not None and close(grasp.axis, yaw)


@pytest.mark.parametrize("off", [0.3, -0.3, 2.0])
def test_of_two_ends_that_are_alike_the_nearer_way_is_tried_first(off: float) -> None:
    yaw = FACING + off
    found = candidates(replace(target("can", (0.12, 0.066, 0.066), yaw=yaw), tilt=1.5), FORWARD, 0.08)
    assert [round(math.degrees(g.tilt)) for g in found] == [75, 75, 60, 60, 90, 90, 90, 90]
    ways = (yaw, yaw + math.pi) if abs(off) < math.pi / 2 else (yaw + math.pi, yaw)
    for grasp, way in zip(found[:4], (*ways, *ways), strict=True):
        assert close(approach(grasp)[0], way) and grasp.axis is not None and close(grasp.axis, way + math.pi)


def test_what_has_no_upper_side_is_put_down_as_it_lay() -> None:
    found = candidates(replace(target("block", (0.08, 0.05, 0.05)), tilt=1.5), FORWARD, 0.08)
    assert found and all(g.axis is None for g in found)


def test_a_mug_on_its_mouth_is_taken_level_to_be_turned_over_and_else_as_it_stands() -> None:
    mug = replace(target("mug", (0.074, 0.074, 0.095), yaw=FACING + math.pi), tilt=3.1)
    found = candidates(mug, FORWARD, 0.08)
    turned, rest = [g for g in found if g.turns_over], [g for g in found if not g.turns_over]
    assert [g.turns_over for g in found] == [True] * len(turned) + [False] * len(rest)
    assert [g.name for g in rest] == [g.name for g in candidates(replace(mug, tilt=0.0), FORWARD, 0.08)]
    ways = [(0.4, 0), *((0.5, d) for d in (0, 8, 3, 14))]
    names = [f"upside down at {h:g}, {d} deg at {t:+d}" for h, d in ways for t in (0, 25, -25)]
    assert [g.name for g in turned] == names
    assert [g.height / mug.size[2] for g in turned] == pytest.approx([h for h, _ in ways for _ in range(3)])
    assert {g.width for g in turned} == {0.074}
    ball = replace(target("ball", (0.066, 0.066, 0.066)), tilt=3.1)
    assert not any(g.turns_over for g in candidates(ball, FORWARD, 0.08)), "a ball has no upper side"


@pytest.mark.parametrize(
    ("kind", "tilt", "way", "upper"),
    [
        ("bottle", 1.5, 0.0, 0.5), ("bottle", 1.5, math.pi, 0.5), ("can", 1.5, math.pi, 0.5),
        ("can", 1.5, 0.0, 0.5 - math.pi), ("can", 1.5, 1.5, 0.5 - math.pi), ("can", 1.5, 1.6, 0.5),
        ("can", 0.0, 0.0, None), ("block", 1.5, 0.0, None),
    ],
)  # fmt: skip
def test_the_end_that_is_above_when_it_stands(kind: str, tilt: float, way: float, upper: float | None) -> None:
    lying = replace(target(kind, (0.12, 0.06, 0.06), yaw=0.5), tilt=tilt)
    end = upper_end(lying, approach_rotation(0.5 + way, math.radians(60)))
    assert (end is None) == (upper is None) and (end is None or upper is None or close(end, upper))


@pytest.mark.parametrize(
    ("size", "spread", "says"),
    [
        ((0.09, 0.10), 0.0, True), ((0.10, 0.09), 0.0, True), ((0.10, 0.079), 0.0, False), ((0.08, 0.09), 0.0, False),
        ((0.09, 0.10), 0.006, False), ((0.093, 0.10), 0.006, True), ((0.2, 0.2), 0.0061, False),
    ],
)  # fmt: skip
def test_too_wide_is_said_where_no_error_of_the_measurement_makes_it_fit(
    size: tuple[float, float], spread: float, says: bool
) -> None:
    assert certainly_too_wide(replace(target("box", (*size, 0.1)), spread=spread), 0.08) is says


# --- another shape than the kind's was measured
def test_a_wide_mug_is_taken_by_its_wall_too() -> None:
    wide = target("mug", (0.09, 0.1, 0.08), yaw=FACING + math.pi / 2)
    found = candidates(wide, FORWARD, 0.085)
    assert found and all(g.rim for g in found) and found[0].width == KINDS["mug"].wall
    assert sorted({round(math.degrees(g.tilt)) for g in found}) == [70, 80, 90]
    assert not any(g.rim for g in candidates(replace(wide, size=(0.085, 0.1, 0.08)), FORWARD, 0.085)), "one side fits"
    bowl = candidates(target("bowl", (0.14, 0.14, 0.06)), FORWARD, 0.085)
    assert len({g.name for g in bowl}) == len(bowl), "a bowl's own rule is not doubled"
    assert candidates(target("box", (0.09, 0.1, 0.08)), FORWARD, 0.085) == []


@pytest.mark.parametrize(
    ("kind", "shape", "like"),
    [
        ("can", "round", "can"), ("can", "bowl", "can"), ("can", "irregular", "can"), ("can", "long", "can"),
        ("box", "box", "box"), ("can", "box", ""), ("apple", "round", "apple"), ("can", "ball", "ball"),
    ],
)  # fmt: skip
def test_a_shape_that_is_not_the_kind_s_is_taken_by_its_own_rules(kind: str, shape: ShapeFamily, like: str) -> None:
    size = (0.06, 0.06, 0.1)
    found = candidates(replace(target(kind, size), shape=shape), FORWARD, 0.08)
    assert found and [g.name for g in found] == [g.name for g in candidates(target(like, size), FORWARD, 0.08)]


@pytest.mark.parametrize(("shape", "first"), [("round", 15), ("ball", 90), ("irregular", None), ("long", None)])
def test_what_has_no_kind_is_taken_by_its_shape_or_by_its_surface(shape: ShapeFamily, first: int | None) -> None:
    found = candidates(replace(target("thing", (0.06, 0.06, 0.1)), shape=shape), FORWARD, 0.08)
    assert (round(math.degrees(found[0].tilt)) if found else None) == first
