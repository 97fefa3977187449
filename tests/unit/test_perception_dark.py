"""A dark object of which a stereo camera sees a stripe is measured by its outline in the picture."""

import numpy as np
import pytest

from common.geometry import Array
from services.perception.segments import dark
from services.perception.shapes.measure import measure
from services.perception.views.view import View
from tests.unit.test_perception_separate import EYE, FLOOR, FOCAL, picture

BLACK, RED = (20, 20, 22), (190, 30, 30)
R, HIGH = 0.034, 0.09


def striped(colour: tuple[int, int, int] = BLACK, share: float = 0.35) -> View:
    """A can on a light table, of whose width only the middle `share` has depth."""
    view, segment = picture([(1.0, 0.0, R, HIGH, colour)])
    rgb, depth = np.where(view.depth[..., None] > 0, view.rgb, np.uint8(150)), view.depth.copy()
    off = np.abs(segment.columns - segment.columns.mean())
    blind = off > share * np.ptp(segment.columns) / 2
    depth[segment.rows[blind], segment.columns[blind]] = 0.0
    return View(rgb, depth, view.focal, view.middle, view.position, view.rotation)


def stripe_of(view: View) -> dark.Pixels:
    rows, columns = np.nonzero(view.depth)
    return rows, columns


def test_a_stripe_and_the_hole_beside_it_are_one_blob() -> None:
    view = striped()
    found = dark.blobs(view)
    assert found is not None
    (number,) = found.of(view, [stripe_of(view)])
    assert number and len(found.hole(number)[0]) > 100


def test_what_is_bright_or_seen_whole_has_no_hole() -> None:
    assert dark.blobs(striped(RED)) is None
    assert dark.blobs(striped(share=2.0)) is None


def test_a_dark_wall_is_no_object() -> None:
    view = striped()
    rgb = view.rgb.copy()
    rgb[:, 60:] = BLACK
    found = dark.blobs(View(rgb, view.depth, view.focal, view.middle, view.position, view.rotation))
    assert found is not None and found.of(view, [stripe_of(view)]) == [0]


@pytest.mark.parametrize("with_outline", [True, False])
def test_its_outline_gives_its_width(with_outline: bool) -> None:
    view = striped()
    found, known = dark.blobs(view), stripe_of(view)
    assert found is not None
    hole = found.hole(found.of(view, [known])[0])
    points = view.points[known].astype(np.float64)
    outline: Array | None = dark.guessed(view, known, hole) if with_outline else None
    shape = measure(points, FLOOR, EYE, (True, True), 0.5 / FOCAL, 0.0015, outline)
    right = abs(shape.size[1] - 2 * R) < 0.012 and np.hypot(shape.x - 1.0, shape.y) < 0.015
    assert right == with_outline
