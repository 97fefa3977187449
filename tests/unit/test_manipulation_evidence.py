"""What was seen of an object against what its shape makes of it: where a grasp has something to hold."""

import math
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array
from services.manipulation.grasps.antipodal import antipodal
from services.manipulation.grasps.evidence import as_held, believed, explained, seen_between
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.surface import surface
from services.manipulation.grasps.target import Target
from services.manipulation.grasps.vessel import rim_height, rim_lean

AT = (0.6, 0.0, 0.7)
OPENING, WIDEST = 0.085, 0.0761


def seen(shape: str, size: tuple[float, float, float], points: Array, kind: str = "") -> Target:
    """A measured object of which those points (n, 3), from its middle, were seen."""
    rng = np.random.default_rng(0)
    return Target("thing", kind, AT, 0.0, size, 0.0, shape, points + rng.normal(0.0, 0.001, points.shape), 0.003, True)  # type: ignore[arg-type]


def around(profile: list[tuple[float, float]], turns: int = 14, half: bool = True) -> Array:
    """Points of a turned wall through (radius, height): the side that faces the robot, or all of it."""
    radii, heights = np.array(profile).T
    steps = np.linspace(heights[0], heights[-1], 22)
    bearings = np.linspace(math.pi / 2, 3 * math.pi / 2, turns) if half else np.linspace(0, math.tau, turns)
    r = np.interp(steps, heights, radii)
    return np.array([(a * math.cos(t), a * math.sin(t), z) for a, z in zip(r, steps, strict=True) for t in bearings])


def plane(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Array:
    """Points on a rectangle; `z` runs with x."""
    u, v = np.meshgrid(np.linspace(0, 1, 16), np.linspace(0, 1, 12))
    ends = (np.array(x), np.array(y), np.array(z))
    return np.stack([np.interp(share, (0, 1), end) for share, end in zip((u, v, u), ends, strict=True)], -1).reshape(
        -1, 3
    )


WEDGE = plane((-0.05, 0.05), (-0.025, 0.025), (-0.028, 0.028))
"""The slope of a wedge that rises away from the robot."""


def test_a_wedge_is_no_can_and_has_the_extents_that_were_seen() -> None:
    can = seen("round", (0.1, 0.1, 0.056), WEDGE + np.array([0.02, 0.0, 0.0]))
    assert not explained(can)
    wedge = believed(can)
    assert wedge.family == "irregular"
    assert wedge.size[:2] == pytest.approx((0.1, 0.05), abs=0.008)
    assert wedge.position[0] == pytest.approx(AT[0] + 0.02, abs=0.006)


def test_what_a_shape_explains_stays_what_it_is() -> None:
    can = seen("round", (0.06, 0.06, 0.1), around([(0.03, -0.05), (0.03, 0.05)]))
    assert explained(can) and believed(can) is can
    assert explained(replace(can, points=None))


BASKET, HOOP = (0.124, 0.084, 0.13), 0.0055
"""Extents of a box that is open above, with a hoop of 11 mm along its length."""


def basket(hoop: bool = True) -> Target:
    """A basket as it is measured; without its `hoop` it has a lid on."""
    x, y, z = (v / 2 for v in BASKET)
    brim = -0.015 if hoop else z
    side = np.array([(-x, b, h) for b in np.linspace(-y, y, 16) for h in np.linspace(-z, brim, 12)])
    floor = plane((-x / 3, x), (-y, y), (-z + 0.006, -z + 0.006)) if hoop else plane((-x, x), (-y, y), (z, z))
    turns = np.linspace(0.0, math.pi, 30)
    rod = [((x - HOOP) * math.cos(t), b, brim + (z - brim) * math.sin(t)) for t in turns for b in (-HOOP, 0.0, HOOP)]
    return seen("box", BASKET, np.concatenate([side, floor, *([np.array(rod)] if hoop else [])]))


def test_a_box_that_was_seen_into_is_none_and_has_a_hoop_to_be_held_by() -> None:
    closed = basket(hoop=False)
    assert believed(closed) is closed and not grasps(closed)
    found = grasps(believed(basket()))
    assert found and found[0].width == pytest.approx(2 * HOOP, abs=0.008)
    assert found[0].pose.position[2] > AT[2] + 0.02


def test_the_rectangle_around_a_flat_tool_is_no_box() -> None:
    """Of a spatula most of it is empty; as a box it is too wide, and only held over an edge."""
    blade = plane((-0.13, -0.03), (-0.035, 0.035), (0.0045, 0.0045))
    tool = np.concatenate([blade, plane((-0.03, 0.13), (-0.009, 0.009), (0.0045, 0.0045))[::3]])
    book = plane((-0.13, 0.13), (-0.035, 0.035), (0.0045, 0.0045))
    assert explained(seen("box", (0.26, 0.07, 0.009), book))
    found = believed(seen("box", (0.26, 0.07, 0.009), tool))
    assert found.family == "irregular" and grasps(found)


def test_a_vessel_is_seen_all_around() -> None:
    """Two legs of a bracket are not the rim of a bowl."""
    wall = around([(0.04, -0.025), (0.06, 0.025)], 24, half=False)
    floor = around([(0.005, -0.02), (0.035, -0.019)], 12, half=False)
    assert explained(seen("bowl", (0.12, 0.12, 0.05), np.concatenate([wall, floor])))
    assert not explained(seen("bowl", (0.12, 0.12, 0.05), plane((0.0, 0.06), (-0.05, 0.05), (0.02, 0.02))))


def test_nothing_is_held_where_nothing_was_seen() -> None:
    """A box that is taken for deeper than what was seen of it."""
    front = np.concatenate(
        [plane((-0.08, -0.04), (-0.03, 0.03), (0.05, 0.05)), plane((-0.08, -0.08), (-0.03, 0.03), (0, 0))]
    )
    box = seen("box", (0.16, 0.06, 0.1), front)
    options = candidates(box, 0.0, WIDEST)
    assert options
    far = replace(options[0], pose=options[0].pose.moved(np.array([0.07, 0.0, 0.0])))
    upwards = AT[2] + 0.05 - options[0].pose.position[2]
    near = replace(options[0], pose=options[0].pose.moved(np.array([-0.06, 0.0, upwards])))
    assert seen_between(box, far), "a sure box is one to its far side"
    guess = replace(box, spread=0.03)
    assert not seen_between(guess, far) and seen_between(guess, near)


def test_a_jar_has_the_width_of_where_it_is_held_and_not_of_its_lid() -> None:
    jar = seen("round", (0.072, 0.072, 0.1), around([(0.028, -0.05), (0.028, 0.028), (0.036, 0.03), (0.036, 0.05)]))
    low = next(g for g in candidates(jar, 0.0, WIDEST) if g.tilt < 0.4)
    held = as_held(jar, surface(jar), low)
    assert low.width == pytest.approx(0.072) and held is not None
    assert held.width == pytest.approx(0.056, abs=0.009)


def test_fingers_are_not_closed_on_a_steep_cone() -> None:
    cone = seen("round", (0.07, 0.07, 0.09), around([(0.035, -0.045), (0.004, 0.045)]))
    sides = [g for g in candidates(cone, 0.0, WIDEST) if g.tilt < 0.5]
    assert sides and all(as_held(replace(cone), surface(cone), g) is None or g.height < 0.03 for g in sides)
    can = seen("round", (0.07, 0.07, 0.09), around([(0.035, -0.045), (0.035, 0.045)]))
    assert all(as_held(can, surface(can), g) is not None for g in candidates(can, 0.0, WIDEST) if g.tilt < 0.5)


def tube(radius: float, thick: float) -> Array:
    """The upper half of a ring that lies."""
    turn, over = np.meshgrid(np.linspace(0, math.tau, 40), np.linspace(0, math.pi, 7))
    r = radius + thick * np.cos(over)
    return np.stack([r * np.cos(turn), r * np.sin(turn), thick * np.sin(over)], -1).reshape(-1, 3)


def grasps(of: Target) -> list[Grasp]:
    return antipodal(of, 0.0, OPENING, WIDEST)


@pytest.mark.parametrize("taken_for", ["bowl", "round"])
def test_a_ring_too_wide_for_the_hand_is_taken_by_its_tube(taken_for: str) -> None:
    ring = believed(seen(taken_for, (0.12, 0.12, 0.026), tube(0.047, 0.013)))
    assert ring.family == "irregular"
    found = grasps(ring)
    assert found
    for grasp in found:
        assert grasp.width == pytest.approx(0.026, abs=0.009)
        assert math.dist(grasp.pose.position[:2], AT[:2]) == pytest.approx(0.047, abs=0.015)


def test_a_plate_has_no_such_part() -> None:
    slope = np.concatenate(
        [
            around([(0.055, -0.008), (0.09, 0.012)], 30, half=False),
            *(around([(r, -0.008), (r, -0.008)], 12, half=False)[:12] for r in (0.02, 0.04, 0.05)),
        ]
    )
    assert grasps(seen("bowl", (0.18, 0.18, 0.025), slope)) == []


def test_what_stands_in_a_vessel_is_not_its_rim() -> None:
    wall = around([(0.035, -0.06), (0.055, 0.015)], 24, half=False)
    pestle = plane((0.02, 0.05), (-0.01, 0.01), (0.0, 0.06))
    empty = seen("bowl", (0.11, 0.11, 0.075), wall + np.array([0.0, 0.0, 0.0225]), "bowl")
    mortar = seen("bowl", (0.11, 0.11, 0.12), np.concatenate([wall, pestle]), "bowl")
    assert rim_height(empty) == 0.075
    assert rim_height(mortar) == pytest.approx(0.075, abs=0.006)
    rims = [g for g in candidates(mortar, 0.0, WIDEST) if g.rim]
    assert rims and all(0.05 < g.height < 0.075 for g in rims)


def test_a_hand_at_a_rim_comes_along_the_wall_that_was_seen() -> None:
    walls = {}
    for lean in (0.12, 0.5):
        out = 0.1 * math.tan(lean)
        shape = [(0.04, -0.05), (0.04 + out, 0.05)]
        cup = seen("bowl", (0.08 + 2 * out, 0.08 + 2 * out, 0.1), around(shape, 24, half=False), "bowl")
        assert rim_lean(cup) == pytest.approx(lean, abs=0.12)
        walls[lean] = next(g for g in candidates(cup, 0.0, WIDEST) if g.rim).tilt
    assert walls[0.12] - walls[0.5] == pytest.approx(0.38, abs=0.15)
