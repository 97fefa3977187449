"""The whole of something irregular that stands, from what its front shows of it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array
from services.manipulation.grasps.antipodal import antipodal
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.surface import surface
from services.manipulation.grasps.target import Target
from services.manipulation.grasps.vessel import seen_open
from services.manipulation.planning.motion_planner import POOR
from tests.unit.test_manipulation_stances import PLANNER

AT = (0.6, 0.0, 0.8)
TALL = 0.2


def front(half: tuple[float, float], low: float, high: float, beside: float = 0.0) -> Array:
    """Points of the side that faces the robot of an upright oval with half extents (away, across) [m]."""
    turns, heights = np.linspace(math.pi / 2, 3 * math.pi / 2, 9), np.arange(low, high, 0.01)
    return np.array([(half[0] * math.cos(t), beside + half[1] * math.sin(t), z) for z in heights for t in turns])


def irregular(points: Array) -> Target:
    return Target("thing", "", AT, 0.0, (0.09, 0.07, TALL), 0.0, "irregular", points, 0.01, True)


BODY = front((0.024, 0.033), -TALL / 2, 0.06)
HEAD = front((0.013, 0.045), 0.06, TALL / 2)
SPRAY = irregular(np.concatenate([BODY, HEAD]))


@pytest.mark.parametrize("yaw", [0.0, 0.9])
def test_a_body_is_as_wide_and_deep_as_its_slice_and_has_nothing_under_its_head(yaw: float) -> None:
    found = surface(replace(SPRAY, yaw=yaw)) - np.array(AT)
    body, head = found[found[:, 2] < 0.04], found[found[:, 2] > 0.08]
    assert np.ptp(body[:, 1]) == pytest.approx(0.066, abs=0.008)
    assert np.ptp(body[:, 0]) == pytest.approx(0.048, abs=0.012)
    assert np.ptp(head[:, 1]) == pytest.approx(0.09, abs=0.008)


def test_it_is_held_by_its_body_from_the_front() -> None:
    grasps = antipodal(SPRAY, 0.0, 0.085, 0.0761)
    around = [g for g in grasps if abs(g.pose.rotation[1, 1]) > 0.9 and g.pose.position[2] < AT[2]]
    assert around and min(abs(g.width - 0.066) for g in around) < 0.01


def test_a_drip_pan_on_a_stem_stays_as_thin_as_it_is() -> None:
    """Exam of worlds, candlestick: its pan was a drum of 20 mm, which pads slid off."""
    stem = [front((0.0075, 0.0075), -TALL / 2 + shift, TALL / 2) for shift in (0.0, 0.005)]
    pan = [front((0.025, 0.025), height, height + 0.001) for height in (0.002, 0.006)]
    found = surface(irregular(np.concatenate([*stem, *pan]))) - np.array(AT)
    wide = {float(z) for z in np.unique(found[:, 2]) if np.ptp(found[found[:, 2] == z, 1]) > 0.03}
    assert wide and max(wide) - min(wide) < 0.012


@pytest.mark.parametrize("seed", range(3))
def test_the_points_that_are_told_of_a_slice_tell_how_wide_it_is(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turns, heights = rng.uniform(math.pi / 2, 3 * math.pi / 2, 600), rng.uniform(-TALL / 2, TALL / 2, 600)
    seen = np.column_stack([0.033 * np.cos(turns), 0.033 * np.sin(turns), heights])
    found = surface(irregular(seen + rng.normal(0.0, 0.001, seen.shape))) - np.array(AT)
    for level in np.unique(found[:, 2])[2:-2]:
        assert np.ptp(found[found[:, 2] == level, 1]) == pytest.approx(0.066, abs=0.008)


@pytest.mark.parametrize("beside", [0.0, 0.02])
def test_a_handle_before_a_body_does_not_bring_it_nearer(beside: float) -> None:
    handle = front((0.006, 0.006), -0.04, 0.04, beside) - (0.06, 0.0, 0.0)
    found = surface(irregular(np.concatenate([front((0.033, 0.033), -TALL / 2, TALL / 2), handle]))) - np.array(AT)
    sides = found[(np.abs(found[:, 2]) < 0.03) & (np.abs(found[:, 1]) > 0.028)]
    assert sides[:, 0].mean() == pytest.approx(0.0, abs=0.005)


def test_fingers_close_across_the_view_where_the_far_side_was_not_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    narrow = irregular(front((0.03, 0.02), -0.1, 0.1))

    def along() -> list[float]:
        return [abs(float(g.pose.rotation[0, 1])) for g in antipodal(narrow, 0.0, 0.085, 0.0761)]

    assert np.mean(along()[:5]) < 0.5
    monkeypatch.setattr("services.manipulation.grasps.antipodal.GUESSED", 0.0)
    assert max(along()) > 0.7, "they could close the other way"


def test_a_handle_beside_a_body_is_no_part_of_it() -> None:
    mug = irregular(
        np.concatenate([front((0.03, 0.03), -TALL / 2, TALL / 2), front((0.005, 0.005), -0.05, 0.05, 0.06)])
    )
    found = surface(mug) - np.array(AT)
    level = found[np.abs(found[:, 2]) < 0.02]
    assert not ((level[:, 1] > 0.036) & (level[:, 1] < 0.05)).any()


@pytest.mark.parametrize("kind", ["mug", ""])
def test_only_into_what_is_seen_to_be_open_a_finger_goes(kind: str) -> None:
    """A vessel's far wall is seen from inside; of a jug with its lid on, or a money box, only what faces the robot."""
    outside = front((0.05, 0.05), -0.04, 0.04)
    lid = np.array([(r * math.cos(t), r * math.sin(t), 0.04) for r in (0.01, 0.03) for t in np.arange(0, 6.3, 0.6)])
    inside = front((0.046, 0.046), -0.01, 0.035) * (-1.0, 1.0, 1.0)
    closed = Target("thing", kind, AT, 0.0, (0.1, 0.1, 0.08), 0.0, "round", np.concatenate([outside, lid]), 0.003, True)
    vessel = replace(closed, points=np.concatenate([outside, inside]))
    assert seen_open(vessel) and not seen_open(closed) and seen_open(replace(closed, measured=False))
    assert any(g.rim for g in candidates(vessel, 0.0, 0.0761))
    assert not any(g.rim for g in candidates(closed, 0.0, 0.0761))


def test_of_what_is_too_wide_slice_by_slice_the_thin_parts_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    assert PLANNER.believed(SPRAY) is SPRAY
    known = PLANNER._on_surface
    monkeypatch.setattr(PLANNER, "_on_surface", lambda target: known(target) if target.family == "long" else [])
    thin = PLANNER.believed(replace(SPRAY))
    below = surface(thin)[:, 2] < AT[2] - 0.05
    assert thin.family == "long" and np.ptp(surface(thin)[below][:, 1]) > 0.08, "what was seen reaches down"


@pytest.mark.slow
def test_a_wide_pot_is_held_by_its_handles_and_one_without_is_too_wide() -> None:
    """Turned about its axis its wall is nowhere narrow enough; a smooth one offers nothing thin and keeps its shape."""
    wall, rings = front((0.055, 0.055), -0.035, 0.035), np.arange(0.0, 0.056, 0.006)
    lid = [(r * math.cos(t), r * math.sin(t), 0.035) for r in rings for t in np.arange(0.0, 6.3, 0.2)]
    grips = [(x, side * y, 0.02) for side in (-1, 1) for y in np.arange(0.058, 0.09, 0.007) for x in (-0.01, 0.0, 0.01)]
    body = np.concatenate([wall, lid])
    smooth = Target("thing", "jar", AT, 0.0, (0.11, 0.11, 0.07), 0.0, "round", body, 0.003, True)
    pot = PLANNER.believed(replace(smooth, points=np.concatenate([body, grips])))
    assert PLANNER.believed(smooth) is smooth and not any(PLANNER.candidates(smooth))
    grasps = [grasp for stage in PLANNER.candidates(pot) for grasp in stage]
    assert pot.family == "long" and grasps
    assert all(math.hypot(*(grasp.pose.position - AT)[:2]) > 0.05 and grasp.width < 0.05 for grasp in grasps)


@pytest.mark.parametrize(("better", "family"), [(-0.1, "long"), (0.1, "round")])
def test_what_slides_out_by_its_wall_is_held_by_its_handle(
    better: float, family: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exam of worlds, teapot: its shoulder was the only place that pads go around, and slopes by 37 degrees."""
    wall = np.concatenate([front((0.041, 0.041), low, 0.05) for low in (-0.05, -0.045)])
    handle = np.array([(0.0, 0.06 + 0.01 * math.sin(t), 0.03 * math.cos(t)) for t in np.linspace(0, math.pi, 8)])
    of = Target("thing", "", AT, 0.0, (0.082, 0.082, 0.1), 0.0, "round", np.concatenate([wall, handle]), 0.003, True)
    known = PLANNER._on_surface
    shoulder = replace(antipodal(SPRAY, 0.0, 0.085, 0.0761)[0], worth=POOR + better)
    monkeypatch.setattr(PLANNER, "_on_surface", lambda t: known(t) if t.family == "long" else [shoulder])
    assert PLANNER.believed(of).family == family


@pytest.mark.parametrize(("kind", "above"), [("ball", False), ("toy", True)])
def test_what_shows_its_upper_part_alone_is_taken_there_unless_it_is_a_ball(kind: str, above: bool) -> None:
    """Fingers above the equator of a ball squeeze it out."""
    points = front((0.02, 0.02), 0.0, 0.021) * (1.0, 1.0, 1.0)
    family = "ball" if kind == "ball" else "box"
    half_hidden = Target("thing", kind, AT, 0.0, (0.042, 0.042, 0.042), 0.0, family, points, 0.003, True)
    heights = [g.height for g in candidates(half_hidden, 0.0, 0.0761)]
    assert heights and (min(heights) > 0.025) == above
