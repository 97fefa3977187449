"""Grasps on measured surfaces: where the pads come to lie on things of no known kind."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array, quat_matrix, yaw_quat
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.antipodal import ASIDE, LEVER, MOST_UPWARD, SLIPPERY, SLOPING, antipodal
from services.manipulation.grasps.clearance import PAD
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.pads import (
    BEHIND_PAD,
    FINGER_HALF,
    LONGEST,
    PLAY,
    STEEPEST,
    Contacts,
    Wanted,
    contact_at,
    contacts,
)
from services.manipulation.grasps.parts import across_parts
from services.manipulation.grasps.surface import SPACING, surface
from services.manipulation.grasps.target import Target

OPENING, WIDEST = 0.085, 0.0761
AT = (0.6, 0.1, 0.7)


def target(shape: str, size: tuple[float, float, float], points: Array | None = None, **more: float) -> Target:
    return Target("thing", "", AT, more.get("yaw", 0.0), size, more.get("tilt", 0.0), shape, points)  # type: ignore[arg-type]


def grasps(of: Target) -> list[Grasp]:
    return antipodal(of, 0.0, OPENING, WIDEST)


def visible(points: Array, rng: np.random.Generator, noise: float = 0.0015) -> Array:
    """A sample of what a camera sees that looks down from the robot's side."""
    keep = points[rng.choice(len(points), min(200, len(points)), replace=False)]
    return keep + rng.normal(0.0, noise, keep.shape)


def rod(length: float, radius: float, yaw: float) -> Array:
    """The upper half of a lying rod."""
    turns, along = np.meshgrid(np.linspace(0.0, math.pi, 9), np.linspace(-length / 2, length / 2, 60))
    points = np.stack([along, radius * np.cos(turns), radius * np.sin(turns)], axis=-1).reshape(-1, 3)
    return points @ quat_matrix(yaw_quat(yaw)).T


def between(of: Target, grasp: Grasp) -> Array:
    """Points of the surface where the pads of a grasp come to lie (n, 3), along the hand's axes."""
    local = (surface(of) - grasp.pose.position) @ grasp.pose.rotation
    found: Array = local[(np.abs(local[:, 0]) < 0.011) & (np.abs(local[:, 2]) < PAD)]
    return found


SHAPES = {
    "can": target("round", (0.066, 0.066, 0.12)),
    "lid": target("round", (0.06, 0.06, 0.02)),
    "carton": target("box", (0.05, 0.09, 0.16), yaw=0.4),
    "ball": target("ball", (0.07, 0.07, 0.07)),
    "rod": target("long", (0.2, 0.03, 0.03), visible(rod(0.2, 0.015, 0.7), np.random.default_rng(1)), yaw=0.7),
    "lying can": target("round", (0.12, 0.06, 0.06), tilt=math.pi / 2, yaw=-0.5),
}


@pytest.mark.parametrize("name", SHAPES)
def test_both_pads_lie_on_the_surface_and_the_tips_stay_off_the_table(name: str) -> None:
    thing = SHAPES[name]
    found = grasps(thing)
    assert found, "it is narrower than the hand"
    for grasp in found:
        held = between(thing, grasp)
        assert held[:, 1].max() == pytest.approx(grasp.width / 2, abs=SPACING)
        assert held[:, 1].min() == pytest.approx(-grasp.width / 2, abs=SPACING)
        assert 0.0 < grasp.width <= WIDEST
        tip = grasp.pose.position + PAD * grasp.pose.rotation[:, 2]
        assert tip[2] >= thing.bottom + PLAY - 1e-6
    assert len({g.name for g in found}) == len(found)


def flat(inside: Callable[[Array, Array], Array], thick: float, seed: int = 0) -> Target:
    """A flat thing as it is seen from above, uneven by the noise of depth: `inside` its outline [m]."""
    rng = np.random.default_rng(seed)
    x, y = (a.ravel() for a in np.meshgrid(*(np.arange(-0.12, 0.12, 0.006),) * 2))
    x, y = x + rng.uniform(-0.003, 0.003, x.shape), y + rng.uniform(-0.003, 0.003, y.shape)
    keep = inside(x, y)
    points = np.stack([x, y, np.full(x.shape, thick / 2)], axis=1)[keep]
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    points[:, :2] -= (low + high) / 2
    size = (*(float(v) for v in high - low), thick)
    return target("irregular", size, points + rng.normal(0.0, 0.0012, points.shape))


def test_an_upper_face_is_no_slope_of_the_sides_below_it() -> None:
    """Of the highest cells only some hold anything, of the middle of the upper face, where that is uneven."""
    along, height = (a.ravel() for a in np.meshgrid(np.arange(-0.03, 0.031, 0.004), np.arange(0.0005, 0.0096, 0.003)))
    sides = [np.stack([along, np.full(along.shape, y), height], axis=1) for y in (-0.02, 0.02)]
    top = np.stack([np.arange(-0.03, 0.031, 0.008), np.full(8, 0.004), np.full(8, -0.002)], axis=1)
    found = contacts(np.concatenate([*sides, top]), (np.array([0.0, 0.0, -1.0]), -0.0095), OPENING)
    held = (np.abs(found.at[:, 0]) < 0.02) & np.isclose(found.width, 0.04)
    assert held.any()
    assert found.slope[held].max() < 0.1


def test_only_the_contacts_that_are_wanted_are_told() -> None:
    wedge = flat(lambda x, y: (np.abs(x) < 0.05) & (np.abs(y) < 0.018 + 0.15 * x), 0.03)
    local, floor = (surface(wedge) - np.array(AT)) * (1, -1, -1), (np.array([0.0, 0.0, -1.0]), -0.02)
    every = contacts(local, floor, OPENING)
    wanted = Wanted((0.03, 0.05), (-0.01, 0.002), 0.4)
    found = contacts(local, floor, OPENING, wanted)
    which = (every.width >= 0.03) & (every.width <= 0.05) & (every.share >= 0.4)
    which &= (every.at[:, 1] >= -0.01) & (every.at[:, 1] <= 0.002)
    assert 0 < which.sum() < len(which)
    for one, other in ((every.at, found.at), (every.width, found.width), (every.slope, found.slope)):
        assert np.array_equal(one[which], other)


def test_of_something_large_no_part_is_looked_at_that_the_hand_may_not_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its weight would turn it between the pads, however near the part is."""
    looked: list[Wanted] = []

    def noted(local: Array, floor: tuple[Array, float], opening: float, wanted: Wanted) -> Contacts:
        looked.append(wanted)
        return contacts(local, floor, opening, wanted)

    monkeypatch.setattr("services.manipulation.grasps.antipodal.contacts", noted)
    grasps(target("box", (0.5, 0.4, 0.3)))
    assert looked
    assert max(max(map(abs, wanted.aside)) for wanted in looked) <= LEVER + ASIDE


def test_the_lower_finger_of_a_leaning_hand_stays_off_the_table() -> None:
    c, s = math.cos(0.6), math.sin(0.6)
    stick = flat(lambda x, y: (np.abs(c * x + s * y) < 0.03) & (np.abs(c * y - s * x) < 0.014), 0.024)
    leaning = [grasp for grasp in grasps(stick) if abs(float(grasp.pose.rotation[2, 1])) > 0.05]
    assert leaning
    for grasp in leaning:
        corners = [
            (x, side * (grasp.width / 2 + thick), PAD)
            for x in (-FINGER_HALF, FINGER_HALF)
            for side in (1, -1)
            for thick in (0.0, BEHIND_PAD)
        ]
        reached = grasp.pose.position + np.array(corners) @ grasp.pose.rotation.T
        assert reached[:, 2].min() > stick.bottom


def test_a_handle_is_taken_across_wherever_the_whole_of_it_points() -> None:
    """A mirror whose handle goes off askew: the rectangle around it says nothing of that."""
    across, along = math.radians(50), np.array([math.cos(math.radians(140)), math.sin(math.radians(140))])

    def inside(x: Array, y: Array) -> Array:
        handle = (np.abs(x * math.cos(across) + y * math.sin(across)) < 0.009) & (x * along[0] + y * along[1] > 0.0)
        found: Array = (np.hypot(x - 0.03, y) < 0.045) | (handle & (np.hypot(x, y) < 0.12))
        return found

    told = across_parts(surface(flat(inside, 0.01)))
    assert any(abs(math.remainder(turn - across, math.pi)) < math.radians(8) for turn in told)


@pytest.mark.parametrize(
    "wide",
    [
        target("box", (0.09, 0.1, 0.12), yaw=0.3), target("round", (0.1, 0.1, 0.1)), target("ball", (0.09, 0.09, 0.09)),
        target("box", (0.2, 0.15, 0.03)),
    ],
)  # fmt: skip
def test_what_is_too_wide_everywhere_has_no_grasp_not_even_at_a_corner(wide: Target) -> None:
    assert grasps(wide) == []


def test_a_book_on_its_spine_is_taken_across_its_thickness() -> None:
    found = grasps(target("box", (0.03, 0.14, 0.2), yaw=0.5))
    assert found[0].width == pytest.approx(0.03, abs=0.002)
    closing = found[0].pose.rotation[:, 1]
    assert abs(closing @ [math.cos(0.5), math.sin(0.5), 0.0]) > 0.97


def test_a_long_thing_is_taken_across_near_its_middle_from_above() -> None:
    thing = SHAPES["rod"]
    best = grasps(thing)[0]
    assert best.tilt > math.radians(60)
    across = best.pose.rotation[:, 1] @ [math.cos(0.7), math.sin(0.7), 0.0]
    assert abs(across) < math.sin(math.radians(20))
    assert np.linalg.norm(best.pose.position[:2] - AT[:2]) < LONGEST
    assert best.width == pytest.approx(0.03, abs=0.012)


def test_what_is_heavy_at_one_end_is_taken_nearer_to_that() -> None:
    """A paddle whose blade is too wide for the hand."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(-0.13, 0.131, 0.004), np.arange(-0.05, 0.051, 0.004)))
    inside = ((x < 0.03) & (np.abs(y) <= 0.012)) | (np.hypot(x - 0.08, y) <= 0.05)
    points = np.stack([x, y, np.full(len(x), 0.009)], axis=1)[inside]
    best = grasps(target("irregular", (0.26, 0.1, 0.018), points))[0]
    assert 0.01 < best.pose.position[0] - AT[0] < 0.03 and best.width < 0.03


def test_a_low_thing_with_a_wide_end_is_taken_across_its_blade() -> None:
    """Scissors: the pads touch hardly more of it than their tips."""
    blade = np.array(
        [(x, y, 0.0035) for x in np.linspace(-0.02, 0.09, 32) for y in (-0.009, -0.004, 0.0, 0.004, 0.009)]
    )
    eyes = np.array([(-0.05 + 0.03 * math.cos(t), 0.045 * math.sin(t), 0.0035) for t in np.linspace(0, math.tau, 40)])
    points = np.concatenate([blade, eyes])
    found = grasps(target("irregular", (0.17, 0.09, 0.007), points))
    assert found and found[0].width == pytest.approx(0.018, abs=0.006)
    assert abs(found[0].pose.rotation[1, 1]) > math.cos(math.radians(16))


def test_a_waist_is_taken_where_it_is_narrow() -> None:
    """A vase of 100 mm with a neck of 40 mm, seen from its front."""
    heights = np.linspace(-0.1, 0.1, 60)
    radii = np.where(heights > 0.02, 0.02, 0.05)
    turns = np.linspace(math.pi / 2, 3 * math.pi / 2, 12)
    points = np.array(
        [(r * math.cos(t), r * math.sin(t), h) for h, r in zip(heights, radii, strict=True) for t in turns]
    )
    vase = target("round", (0.1, 0.1, 0.2), visible(points, np.random.default_rng(0)))
    found = grasps(vase)
    assert found
    assert all(g.width < 0.06 and g.pose.position[2] > AT[2] for g in found)


def test_a_wedge_is_not_pinched_where_it_would_slip_out() -> None:
    """Faces 30 degrees off the closing direction on either side: the pads would squeeze it away."""
    x, z = np.meshgrid(np.linspace(-0.06, 0.06, 40), np.linspace(-0.03, 0.03, 12))
    half = (x + 0.07) * math.tan(math.radians(30))
    points = np.stack([np.stack([x, s * half, z], -1) for s in (-1, 1)]).reshape(-1, 3)
    wedge = target("irregular", (0.12, 0.15, 0.06), points)
    for grasp in grasps(wedge):
        across = abs(float(grasp.pose.rotation[:, 1] @ [0.0, 1.0, 0.0]))
        assert across < math.cos(math.atan(STEEPEST) / 2) or grasp.width < 0.03


def test_straight_walls_are_rather_held_than_a_cone_nearer_to_the_middle() -> None:
    """Exam of worlds, trainer: pads slid up sides that had been measured 6 degrees less steep than they were."""
    heights = np.linspace(-0.1, 0.1, 60)
    radii = np.clip(0.026 - 0.38 * (heights - 0.015), 0.0, 0.034)
    turns = np.linspace(math.pi / 2, 3 * math.pi / 2, 24)
    cone = np.array([(r * math.cos(t), r * math.sin(t), h) for h, r in zip(heights, radii, strict=True) for t in turns])
    of = target("round", (0.068, 0.068, 0.2), cone[cone[:, 2] < 0.06])
    best = grasps(of)[0]
    contact = contact_at(surface(of), best.pose)
    assert contact is not None and contact.slope < SLOPING


def test_a_rod_is_as_steep_as_at_its_widest_line_and_a_wedge_as_it_is() -> None:
    """Exam of worlds, bat: its handle falls away under the upper half of the pads."""
    turns, along, deep = np.linspace(0.0, math.tau, 90), np.linspace(-0.03, 0.03, 30), np.linspace(-0.03, 0.03, 30)
    rod = np.array([(x, 0.02 * math.cos(t), 0.02 * math.sin(t)) for x in along for t in turns])
    wedge = np.array([(x, side * (0.03 + 0.4 * z), z) for x in along for z in deep for side in (-1, 1)])
    low, middle = (contact_at(of, Pose(np.array([0.0, 0.0, -at]), np.eye(3))) for of, at in ((rod, 0.01), (wedge, 0.0)))
    assert low is not None and low.slope < SLIPPERY
    assert middle is not None and middle.slope == pytest.approx(0.4, abs=0.05)


def test_what_was_seen_is_completed_down_to_what_it_rests_on_and_no_wider() -> None:
    rng = np.random.default_rng(3)
    seen = visible(rng.uniform((-0.03, -0.02, 0.03), (0.03, 0.02, 0.03), (400, 3)), rng, 0.0)
    found = surface(target("irregular", (0.06, 0.04, 0.06), seen, yaw=0.0)) - AT
    assert found[:, 2].min() == pytest.approx(-0.03, abs=SPACING) and found[:, 2].max() == pytest.approx(
        0.03, abs=SPACING
    )
    assert np.ptp(found[:, 0]) == pytest.approx(0.06, abs=2 * SPACING)
    assert np.ptp(found[:, 1]) == pytest.approx(0.04, abs=2 * SPACING)


def test_the_turn_of_an_object_turns_its_grasps() -> None:
    def closing(yaw: float) -> float:
        rotation = grasps(target("box", (0.05, 0.12, 0.05), yaw=yaw))[0].pose.rotation
        return math.atan2(rotation[1, 1], rotation[0, 1]) - yaw

    assert math.remainder(closing(0.2) - closing(0.5), math.pi) == pytest.approx(0.0, abs=0.02)


def test_a_box_whose_depth_was_guessed_is_as_thin_as_what_was_seen_of_its_top() -> None:
    """Bench, book standing, seed 0: 28 mm thick, taken for 77 since its front was nearly all that was seen."""
    rng = np.random.default_rng(0)
    front = rng.uniform((-0.055, -0.05, -0.09), (0.055, -0.05, 0.075), (160, 3))
    top = rng.uniform((-0.055, -0.05, 0.088), (0.055, -0.022, 0.09), (45, 3))
    book = target("box", (0.112, 0.1, 0.18), np.concatenate([front, top]))
    assert grasps(book)[0].width == pytest.approx(0.028, abs=2 * SPACING)
    assert grasps(target("box", (0.112, 0.1, 0.18), front)) == [], "of what is not seen nothing better is known"


def test_no_finger_goes_through_a_handle_that_was_seen_on_what_nobody_named() -> None:
    """Bench, mug of no known kind, seed 10: on its way out the finger took the mug along by its handle."""
    rng = np.random.default_rng(0)
    heights, turns = rng.uniform(-0.04, 0.04, 150), rng.uniform(math.pi / 2, 3 * math.pi / 2, 150)
    wall = np.stack([0.033 * np.cos(turns), 0.033 * np.sin(turns), heights], axis=1)
    bow = np.stack([np.zeros(12), rng.uniform(0.045, 0.055, 12), rng.uniform(-0.02, 0.02, 12)], axis=1)
    plain, mug = (target("round", (0.066, 0.066, 0.08), seen) for seen in (wall, np.concatenate([wall, bow])))
    across = [abs(float(g.pose.rotation[1, 1])) for g in grasps(plain)]
    assert max(across) > 0.9, "without the handle the fingers may close across it"
    assert grasps(mug) and all(abs(float(g.pose.rotation[1, 1])) < 0.75 for g in grasps(mug))


def test_what_lies_and_has_an_upper_side_is_taken_so_that_it_can_be_stood_up() -> None:
    can, rod = (replace(SHAPES["lying can"], kind=kind) for kind in ("can", ""))
    for grasp in grasps(can):
        assert grasp.axis is not None
        assert float(grasp.pose.rotation[:2, 2] @ (math.cos(grasp.axis), math.sin(grasp.axis))) < 1e-9
        assert abs(math.remainder(grasp.axis - can.yaw, math.pi)) < 1e-9
    assert all(grasp.axis == can.yaw for grasp in grasps(replace(can, kind="bottle"))), "its ends are not alike"
    assert all(grasp.axis is None for grasp in grasps(rod))


def test_nothing_is_held_far_to_the_side_of_its_middle() -> None:
    bottle = replace(target("long", (0.24, 0.058, 0.058), tilt=math.pi / 2), kind="bottle")
    found = grasps(bottle)
    assert found
    assert all(math.dist(g.pose.position[:2], AT[:2]) <= LEVER + 1e-9 for g in found)


def test_what_lies_is_rather_taken_so_that_the_hand_is_above_it_once_it_stands() -> None:
    # Its upper end points away from the robot: from the near side the hand would come from below.
    bottle = replace(target("long", (0.2, 0.06, 0.06), tilt=math.pi / 2), kind="bottle")

    def upward(grasp: Grasp) -> bool:
        assert grasp.axis is not None
        return float(grasp.pose.rotation[:2, 2] @ (math.cos(grasp.axis), math.sin(grasp.axis))) > MOST_UPWARD

    found = [upward(g) for g in grasps(bottle)]
    assert not found[0]
    assert found == sorted(found), "those that cannot stand it up come last"


def test_what_is_low_and_lies_across_the_way_is_also_taken_with_a_hand_that_leans() -> None:
    across = target("long", (0.2, 0.02, 0.02), visible(rod(0.2, 0.01, math.pi / 2), np.random.default_rng(2)), yaw=1.57)
    leaning = [g for g in grasps(across) if 0.9 < g.tilt < 1.4 and abs(float(g.pose.rotation[1, 1])) < 0.5]
    assert leaning, "fingers before and behind it"
    for g in leaning:
        assert g.width < 0.03 and np.ptp(between(across, g)[:, 1]) == pytest.approx(g.width, abs=0.006)


def test_what_lies_across_is_also_taken_with_a_hand_that_leans_as_far_as_a_worktop_asks() -> None:
    """To what lies 0.9 m up the arm comes no steeper than 60 degrees."""
    across = target("long", (0.2, 0.04, 0.04), visible(rod(0.2, 0.02, math.pi / 2), np.random.default_rng(2)), yaw=1.57)
    assert any(g.tilt < math.radians(60) and abs(float(g.pose.rotation[1, 1])) < 0.5 for g in grasps(across))


def beside_a_ball(width: float) -> Array:
    """What is seen of a ball of 60 mm, and of a bar of a width [m] beside it."""
    ball = surface(replace(target("ball", (0.06, 0.06, 0.06)), position=(0.0, 0.0, 0.0)))
    y, z = np.meshgrid(np.arange(-0.03, 0.031, 0.005), np.arange(-0.03, 0.04, 0.005))
    faces = [np.stack([np.full(y.shape, x), y, z], axis=-1).reshape(-1, 3) for x in (0.05, 0.05 + width)]
    return np.concatenate([ball, *faces])


def test_what_is_narrow_beside_a_ball_is_no_part_of_it_and_of_other_things_a_doubtful_one() -> None:
    seen = replace(target("long", (0.11, 0.06, 0.07), beside_a_ball(0.013)), measured=True)
    assert min(grasp.width for grasp in grasps(replace(seen, kind="ball"))) > 0.03
    certain, doubtful = (
        next(n for n, grasp in enumerate(grasps(replace(seen, spread=spread))) if grasp.width < 0.02)
        for spread in (0.0, 0.002)
    )
    assert certain < doubtful
