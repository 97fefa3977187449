"""Objects that touch in the picture are cut apart; what is printed on one does not cut it."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array, Mask
from services.perception.segments.joints import jointed
from services.perception.segments.seams import unseamed
from services.perception.segments.segment import Segment, Surface
from services.perception.segments.separate import pieces
from services.perception.views.view import View

SIDE = 200
"""Of the picture [px]."""
FLOOR, FOCAL = 0.72, 400.0
EYE = np.array([0.0, 0.0, 1.35])
Solid = tuple[float, float, float, float, tuple[int, int, int]]
"""Middle x, y, radius and height [m] of a can, and its colour."""


def rotation() -> Array:
    pitch = 0.6
    ahead = np.array([math.cos(pitch), 0.0, -math.sin(pitch)])
    right = np.array([0.0, -1.0, 0.0])
    return np.stack([right, np.cross(ahead, right), ahead], axis=1)


def looks() -> Array:
    """Directions (h, w, 3) [map] in which the pixels look."""
    u, v = np.meshgrid(np.arange(SIDE) + 0.5 - SIDE / 2, np.arange(SIDE) + 0.5 - SIDE / 2)
    return np.stack([u / FOCAL, v / FOCAL, np.ones_like(u)], -1) @ rotation().T


def measured(depth: Array, rgb: Array) -> tuple[View, Segment]:
    """A view with the camera's noise, and all that is seen in it as one segment."""
    seen = np.isfinite(depth)
    rng = np.random.default_rng(1)
    depth[seen] *= 1 + rng.normal(0.0, 0.0015, np.count_nonzero(seen))
    depth[~seen] = 0.0
    view = View(rgb, depth.astype(np.float32), (FOCAL, FOCAL), (SIDE / 2, SIDE / 2), EYE, rotation())
    rows, columns = np.nonzero(seen)
    points = view.points[rows, columns].astype(np.float64)
    return view, Segment(Surface("table", FLOOR), rows, columns, points, False, (True, True))


def picture(cans: list[Solid], band: bool = False) -> tuple[View, Segment]:
    """Cans cast by rays, 200 x 200, with the noise of a bought camera; all of them are one segment."""
    rays = looks()
    depth, rgb = np.full((SIDE, SIDE), np.inf), np.zeros((SIDE, SIDE, 3), np.uint8)
    for x, y, r, high, colour in cans:
        with np.errstate(divide="ignore", invalid="ignore"):
            lid = (FLOOR + high - EYE[2]) / rays[..., 2]
            on_lid = np.hypot(lid * rays[..., 0] - x, lid * rays[..., 1] - y) < r
            a = rays[..., 0] ** 2 + rays[..., 1] ** 2
            b = rays[..., 0] * x + rays[..., 1] * y
            wall = (b - np.sqrt(b * b - a * (x * x + y * y - r * r))) / a
        z = EYE[2] + wall * rays[..., 2] - FLOOR
        far = np.where(on_lid, lid, np.where((z > 0) & (z < high), wall, np.inf))
        nearer = far < depth
        depth[nearer], rgb[nearer] = far[nearer], colour
        if band:
            rgb[nearer & (z > 0.3 * high) & (z < 0.7 * high)] = (240, 240, 235)
    return measured(depth, rgb)


RED, GREEN = (190, 30, 30), (30, 150, 50)


def middles(cans: list[Solid], band: bool = False) -> list[tuple[float, float]]:
    found = pieces(*picture(cans, band))
    return sorted((p.shape.x, p.shape.y) for p in found)


@pytest.mark.parametrize("colours", [(RED, GREEN), (RED, RED)], ids=["two colours", "one colour"])
def test_neighbours_are_two_objects(colours: tuple[tuple[int, int, int], tuple[int, int, int]]) -> None:
    cans = [(1.0, -0.042, 0.035, 0.11, colours[0]), (1.0, 0.042, 0.035, 0.11, colours[1])]
    found = middles(cans)
    assert len(found) == 2
    for x, y, *_ in cans:
        assert min(math.dist(at, (x, y)) for at in found) < 0.01


def test_one_that_hides_a_part_of_another_is_told_apart() -> None:
    found = middles([(0.95, 0.0, 0.03, 0.08, RED), (1.03, 0.03, 0.04, 0.15, GREEN)])
    assert len(found) == 2


def test_one_behind_another_of_its_colour_is_told_apart_and_known_to_be_hidden_in_part() -> None:
    found = pieces(*picture([(0.95, 0.0, 0.03, 0.09, RED), (1.04, 0.05, 0.033, 0.065, RED)]))
    near, far = sorted(found, key=lambda p: p.shape.x)
    assert not near.segment.cut and far.segment.cut


def test_what_is_printed_on_a_can_does_not_cut_it() -> None:
    assert middles([(1.0, 0.0, 0.04, 0.13, RED)], band=True) == [pytest.approx((1.0, 0.0), abs=0.006)]


def test_a_crowd_wider_than_any_object_is_its_objects() -> None:
    blue = (30, 60, 180)
    cans = [(1.0, -0.13, 0.045, 0.10, RED), (1.02, 0.0, 0.082, 0.07, GREEN), (1.0, 0.14, 0.045, 0.12, blue)]
    found = middles(cans)
    assert len(found) == 3
    for x, y, *_ in cans:
        assert min(math.dist(at, (x, y)) for at in found) < 0.02


def rod(colours: list[tuple[int, int, int]], widths: list[float], long: float = 0.2) -> tuple[View, Segment]:
    """What lies across the view, `long` [m]: a half cylinder of pieces of those colours and widths, end to end."""
    rays = looks()
    depth, rgb = np.full((SIDE, SIDE), np.inf), np.zeros((SIDE, SIDE, 3), np.uint8)
    for n, (colour, radius) in enumerate(zip(colours, widths, strict=True)):
        length = long / len(colours)
        a = rays[..., 0] ** 2 + rays[..., 2] ** 2
        x, z = 1.0, FLOOR + 0.02 - EYE[2]
        b = rays[..., 0] * x + rays[..., 2] * z
        with np.errstate(invalid="ignore"):
            far = (b - np.sqrt(b * b - a * (x * x + z * z - radius * radius))) / a
        along = far * rays[..., 1] + long / 2 - n * length
        hit = (along > 0) & (along < length) & (far < depth) & (EYE[2] + far * rays[..., 2] > FLOOR)
        depth[hit], rgb[hit] = far[hit], colour
    return measured(depth, rgb)


def test_a_surface_that_runs_on_is_one_whatever_is_printed_on_it() -> None:
    view, whole = rod([GREEN, (240, 240, 235), GREEN], [0.03, 0.03, 0.03])
    cut = (whole.points[:, 1] > 0.033).astype(np.intp) + (whole.points[:, 1] > -0.033)
    assert unseamed(view, whole, cut, 0.0015) is None
    view, stepped = rod([GREEN, RED], [0.02, 0.045])
    cut = (stepped.points[:, 1] > 0.0).astype(np.intp)
    assert unseamed(view, stepped, cut, 0.0015) is not None
    assert unseamed(view, whole, cut[: len(whole.rows)], 0.01) is not None, "noise hides whether it does"


def test_a_blade_and_its_handle_are_one() -> None:
    view, tool = rod([GREEN, RED], [0.016, 0.02])
    cut = (tool.points[:, 1] > 0.0).astype(np.intp)
    assert jointed(view, tool, cut, 0.0015) is None
    on_it = ((np.abs(tool.points[:, 1] - 0.05) < 0.02) & (tool.points[:, 2] > FLOOR + 0.03)).astype(np.intp)
    assert jointed(view, tool, on_it, 0.0015) is not None, "what lies on another meets it all round"
    far = replace(view, depth=(view.depth + 0.03 * (view.points[..., 1] > 0)).astype(np.float32))
    assert jointed(far, tool, cut, 0.0015) is not None, "a side that another hides"
    view, high = rod([GREEN, RED], [0.03, 0.045])
    assert jointed(view, high, (high.points[:, 1] > 0.0).astype(np.intp), 0.0015) is not None


def test_what_is_a_little_higher_is_joined_where_it_meets_narrowly_and_goes_on_level() -> None:
    view, bulb = rod([GREEN, RED], [0.024, 0.03])
    cut = (bulb.points[:, 1] > 0.0).astype(np.intp)
    assert jointed(view, bulb, cut, 0.0015) is None, "a bulb and its cap"
    assert jointed(view, bulb, cut, 0.0015, crowd=True) is not None
    higher = replace(bulb, surface=Surface("table", FLOOR - 0.04))
    assert jointed(view, higher, cut, 0.0015) is not None, "what stands beside another"
    behind = replace(view, depth=(view.depth + 0.03 * (view.points[..., 1] > 0)).astype(np.float32))
    assert jointed(behind, bulb, cut, 0.0015) is not None, "what another hides a part of"


def test_a_tool_that_is_too_long_for_a_vessel_is_one_in_two_colours() -> None:
    (found,) = pieces(*rod([GREEN, RED], [0.015, 0.015], long=0.34))
    assert found.shape.size[0] == pytest.approx(0.34, abs=0.03)


def slab(inside: Callable[[Array, Array], Mask], red: Callable[[Array, Array], Mask]) -> tuple[View, Segment]:
    """What lies flat before the camera, 15 mm high: its outline, and the part of it that is red and not brown."""
    rays = looks()
    far = (FLOOR + 0.015 - EYE[2]) / rays[..., 2]
    x, y = far * rays[..., 0] - 1.0, far * rays[..., 1]
    rgb = np.where(red(x, y)[..., None], np.array(RED), np.array((150, 100, 60))).astype(np.uint8)
    return measured(np.where(inside(x, y), far, np.inf), rgb)


def test_what_has_no_shape_of_its_own_belongs_to_what_it_is_level_with() -> None:
    def handle(x: Array, y: Array) -> Mask:
        return (np.abs(x) < 0.015) & (y > 0.0) & (y < 0.15)

    view, bat = slab(
        lambda x, y: (np.hypot(x, y) < 0.075) | handle(x, y), lambda x, y: (np.hypot(x, y) < 0.065) & (y < 0.05)
    )
    (whole,) = pieces(view, bat)
    assert len(whole.segment.rows) == len(bat.rows)
    cut = (view.rgb[bat.rows, bat.columns, 1] > 60).astype(np.intp)
    assert jointed(view, bat, cut, 0.0015, [1]) is None and jointed(view, bat, cut, 0.0015) is not None
    lower = replace(view, depth=(view.depth + 0.03 * (view.rgb[..., 1] > 60)).astype(np.float32))
    assert jointed(lower, bat, cut, 0.0015, [1]) is not None, "what lies on another"


@pytest.mark.parametrize(("higher", "one"), [(-0.008, True), (0.008, False)], ids=["its lens", "lies on it"])
def test_what_is_within_another_and_lower_is_of_it(higher: float, one: bool) -> None:
    view, glass = slab(lambda x, y: np.hypot(x, y) < 0.06, lambda x, y: np.hypot(x, y) < 0.04)
    red = view.rgb[..., 1] < 60
    stepped = replace(view, depth=(view.depth - 2 * higher * red).astype(np.float32))
    cut = red[glass.rows, glass.columns].astype(np.intp)
    raised = replace(glass, points=glass.points + np.outer(cut, (0.0, 0.0, higher)))
    assert (jointed(stepped, raised, cut, 0.0015, [0]) is None) is one
    assert jointed(stepped, raised, cut, 0.0015) is not None, "what has a shape is another"


def test_what_is_as_long_as_a_ladle_is_one() -> None:
    (found,) = pieces(*rod([RED], [0.015], long=0.34))
    assert found.shape.size[0] == pytest.approx(0.34, abs=0.03)


def test_what_is_wider_than_any_object_and_of_one_piece_is_none() -> None:
    assert not middles([(1.1, 0.0, 0.17, 0.10, RED)])
