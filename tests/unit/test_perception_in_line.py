"""A tool is one thing, whatever is missing between its blade and its handle; things in a row are several."""

from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array
from services.perception.segments.in_line import end_to_end
from services.perception.segments.outlined import in_line, with_rest
from services.perception.segments.parts import joined
from services.perception.segments.segment import Segment, Surface
from services.perception.segments.separate import pieces
from services.perception.shapes.measurement import Measurement
from services.perception.views.view import View
from tests.unit.test_perception_separate import FLOOR, GREEN, RED, rod

Side = tuple[float, float]
PLANE = np.array([0.0, 0.0, FLOOR])


def block(x: Side, y: Side, z: Side) -> Array:
    low, high = np.array([x, y, z]).T
    return np.random.default_rng(2).uniform(low, high, (400, 3))


BLADE, HANDLE = block((0.0, 0.1), (-0.03, 0.03), (0.0, 0.01)), block((-0.15, -0.015), (-0.01, 0.01), (0.005, 0.025))


def moved(part: Array, x: float, y: float, z: float) -> Array:
    return np.asarray(part + np.array([x, y, z]))


@pytest.mark.parametrize(
    ("parts", "one"),
    [
        ([BLADE, HANDLE], True),
        ([BLADE, moved(HANDLE, 0.0, 0.1, 0.0)], False),
        ([BLADE, moved(HANDLE, 0.1, 0.0, 0.0)], False),
        ([BLADE, moved(HANDLE, 0.0, 0.0, 0.08)], False),
        ([BLADE, HANDLE, moved(HANDLE, -0.2, 0.0, 0.0)], False),
        ([block((0.07 * n, 0.07 * n + 0.06), (-0.03, 0.03), (0.0, 0.06)) for n in range(4)], False),
    ],
    ids=["a tool", "aside", "on it", "high", "too long", "blocks in a row"],
)
def test_a_blade_and_its_handle_lie_end_to_end(parts: list[Array], one: bool) -> None:
    assert end_to_end(parts) == one
    turned = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    assert end_to_end([part @ turned + (1.0, 2.0, 0.0) for part in parts]) == one


def without_middle(long: float) -> tuple[View, Segment]:
    """A tool of two colours across the view, without depth on 6 mm of it."""
    view, whole = rod([GREEN, RED], [0.008, 0.02], long=long)
    kept = np.abs(whole.points[:, 1] + 0.003) > 0.003
    depth = view.depth.copy()
    depth[whole.rows[~kept], whole.columns[~kept]] = 0.0
    rows, columns = whole.rows[kept], whole.columns[kept]
    return replace(view, depth=depth), replace(whole, rows=rows, columns=columns, points=whole.points[kept])


def test_what_has_no_depth_in_its_middle_is_one_tool() -> None:
    view, whole = without_middle(0.36)
    left = whole.points[:, 1] > -0.003
    parts = [(whole.rows[side], whole.columns[side]) for side in (left, ~left)]
    (found,) = joined(view, "table", PLANE, parts, np.zeros(view.shape, bool), None)
    (piece,) = pieces(view, found)
    assert piece.shape.size[0] == pytest.approx(0.36, abs=0.03)


def test_what_goes_on_where_a_black_part_ends_is_of_it() -> None:
    surface = Surface("table", 0.0)
    pixels = np.arange(400)
    shape = Measurement("box", 0.05, 0.0, 0.0, (0.1, 0.06, 0.01), 0.001, 0.004)
    black = Segment(surface, pixels, pixels, np.empty((0, 3)), False, (True, True), shape=shape)
    lit = Segment(surface, pixels, pixels, HANDLE, False, (True, True))
    assert not in_line(black, replace(lit, points=moved(HANDLE, -0.03, 0.0, 0.0))), "a gap"
    assert in_line(black, lit)
    whole = with_rest(black, [lit]).shape
    assert whole is not None and whole.size == pytest.approx((0.25, 0.06, 0.025), abs=0.01)
    assert (whole.x, whole.y) == pytest.approx((-0.025, 0.0), abs=0.01)
