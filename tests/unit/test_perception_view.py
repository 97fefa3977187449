"""Where in a picture a part of the world can be seen."""

import math

import numpy as np
import pytest

from common.geometry import Array, Rectangle
from services.perception.views.view import View
from services.perception.views.visible_plan import corners, inside


def ahead(turn: float = 0.0) -> View:
    """A level camera at (0, 0, 1) that looks along x, turned by `turn` about z."""
    c, s = math.cos(turn), math.sin(turn)
    forward, right = np.array([c, s, 0.0]), np.array([s, -c, 0.0])
    rotation = np.stack([right, np.array([0.0, 0.0, -1.0]), forward], axis=1)
    depth = np.full((60, 80), 2.0, np.float32)
    return View(np.zeros((60, 80, 3), np.uint8), depth, (70.0, 70.0), (40.0, 30.0), np.array([0, 0, 1.0]), rotation)


def test_a_pixel_has_the_point_that_is_projected_to_it() -> None:
    view = ahead(0.3)
    u, v, z = view.project(view.points[7, 61][None].astype(np.float64))[0]
    assert (u, v, z) == pytest.approx((61.5, 7.5, 2.0), abs=1e-3)


@pytest.mark.parametrize("seed", range(5))
def test_no_point_of_a_box_is_seen_outside_its_window(seed: int) -> None:
    rng = np.random.default_rng(seed)
    view = ahead(float(rng.uniform(-1, 1)))
    x, y, yaw = float(rng.uniform(1, 3)), float(rng.uniform(-1, 1)), float(rng.uniform(-2, 2))
    box = Rectangle(x, y, 0.8, 0.5, yaw)
    rows, columns = view.window(corners(box, 0.7, 1.0))
    points: Array = rng.uniform((-1, -3, 0.7), (5, 3, 1.0), (4000, 3))
    points = points[inside(points[:, 0].astype(np.float32), points[:, 1].astype(np.float32), box)]
    assert len(points) > 20
    u, v, z = view.project(points).T
    seen = (z > 0) & (u >= 0) & (u < 80) & (v >= 0) & (v < 60)
    assert np.all((u[seen] >= columns.start) & (u[seen] < columns.stop))
    assert np.all((v[seen] >= rows.start) & (v[seen] < rows.stop))


def test_what_is_behind_has_an_empty_window_and_what_is_around_the_whole_picture() -> None:
    view = ahead()
    behind = view.window(corners(Rectangle(-2.0, 0.0, 0.5, 0.5), 0.5, 1.0))
    assert view.depth[behind].size == 0
    assert view.window(corners(Rectangle(0.0, 0.0, 2.0, 2.0), 0.5, 1.0)) == view.everywhere
    small = view.window(corners(Rectangle(2.0, 0.0, 0.1, 0.1), 0.95, 1.05))
    assert 0 < view.depth[small].size < 200
