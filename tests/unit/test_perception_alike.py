"""What the picture tells of parts that depth alone does not join, or does not see."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from services.perception.segments.flat import patches
from services.perception.segments.parts import between_jumps, joined
from services.perception.views.view import View

HIGH, FOCAL = 1.0, 400.0
TABLE, RED = (120, 90, 60), (150, 20, 20)
DOWN = np.array([[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])


def above(rgb: NDArray[np.uint8], depth: NDArray[np.float32]) -> View:
    """A picture from HIGH over a table, straight down."""
    h, w = depth.shape
    return View(rgb, depth, (FOCAL, FOCAL), (w / 2, h / 2), np.array([0.0, 0.0, HIGH]), DOWN)


def two_bars(between: tuple[int, int, int]) -> View:
    """Two red bars, 50 mm high, and 12 pixels (28 mm) of a colour and without depth between them."""
    rgb, depth = np.full((120, 180, 3), TABLE, np.uint8), np.full((120, 180), HIGH, np.float32)
    rgb[30:90, 40:114], depth[30:90, 40:114] = RED, HIGH - 0.05
    rgb[30:90, 71:83], depth[30:90, 71:83] = between, 0.0
    return above(rgb, depth)


@pytest.mark.parametrize(("between", "count"), [(RED, 1), (TABLE, 2)])
def test_parts_are_one_where_the_picture_shows_that_one_goes_on_in_the_other(
    between: tuple[int, int, int], count: int
) -> None:
    view = two_bars(between)
    rows, columns = np.nonzero((view.depth > 0) & (view.depth < HIGH - 0.01))
    cut = between_jumps(view, rows, columns, 8)
    assert len(cut) == 2
    assert len(joined(view, "table", np.zeros(3), cut, np.zeros(view.shape, bool), None)) == count


@pytest.mark.parametrize(("thick", "seen"), [(0.004, True), (0.0, False)], ids=["a comb", "print"])
def test_a_patch_of_another_colour_is_a_thing_where_it_lifts_as_a_whole(thick: float, seen: bool) -> None:
    rng = np.random.default_rng(3)
    noise = ndimage.uniform_filter(rng.normal(0.0, 0.008, (120, 160)), 5)
    rgb = np.full((120, 160, 3), TABLE, np.uint8)
    rgb[50:58, 50:110] = RED
    heights = noise + thick * (rgb[..., 0] == RED[0])
    assert np.percentile(heights[50:58, 50:110], 10) < np.percentile(noise, 90), "no pixel stands out by itself"
    pixels = np.arange(rgb[..., 0].size)
    rows, _ = patches(
        above(rgb, np.full((120, 160), HIGH, np.float32)), pixels, heights.ravel().astype(np.float32), pixels < 0
    )
    assert (len(rows) > 300) == seen


@pytest.mark.parametrize(("thick", "seen"), [(0.008, True), (0.05, False)], ids=["a ring of scissors", "what stands"])
def test_the_rest_of_a_thin_thing_is_seen_with_what_stands_out_of_the_noise(thick: float, seen: bool) -> None:
    rgb = np.full((120, 160, 3), TABLE, np.uint8)
    rgb[50:56, 50:93] = RED
    heights = np.zeros((120, 160), np.float32)
    heights[50:56, 50:90], heights[50:56, 90:93] = thick, 0.002
    rows, columns = patches(
        above(rgb, np.full((120, 160), HIGH, np.float32)), np.arange(heights.size), heights.ravel(),
        heights.ravel() > 0.004,
    )  # fmt: skip
    assert (len(rows) > 0 and set(columns) >= {90, 91, 92}) == seen


def test_the_seam_between_two_boards_is_no_part_of_what_lies_beside_it() -> None:
    rgb = np.full((120, 160, 3), TABLE, np.uint8)
    rgb[40:60, 50:90], rgb[50:52, 90:130] = RED, RED
    heights = np.zeros((120, 160), np.float32)
    heights[40:60, 50:90], heights[50:52, 90:130] = 0.015, 0.002
    view = above(rgb, np.full((120, 160), HIGH, np.float32))
    _, columns = patches(view, np.arange(heights.size), heights.ravel(), heights.ravel() > 0.004)
    assert not set(columns) - set(range(94))
