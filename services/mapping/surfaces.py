"""Detection of level surfaces among points of pictures: their height, and the rectangle that they fill. Pure."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_matrix, csgraph
from scipy.spatial import KDTree

from common.geometry import Array, Rectangle

CELL, LAYER = 0.05, 0.02
"""Extents of the voxels that neighbours are found in, across and up [m]: level points lie 2.5 cm apart."""
THICK = 0.025
"""Greatest distance [m] from a surface's height of the points that count to it: noise, and what lies flat on it."""
NEIGHBOUR = 1.5
"""Distance [cells] of neighbours: beside each other or at a corner."""
STEP = 0.0045
"""Height [m] by which the means of neighbouring cells differ, at the least, where one surface ends and another begins,
as a tray before a sofa; the mean of a cell's points is noisy by 1 to 2 mm."""
LEAST_AREA, LEAST_SIDE = 0.05, 0.20
"""Area [m2] and width [m] below which something is no surface to put things on, but a thing itself."""
FILLED = 0.45
"""Least share of its rectangle that a surface fills: with things on it that hide parts, and no two tables in one."""
CORNER = math.radians(1.0)
"""Step of the headings that are tried for the rectangle [rad]."""
RIM = 0.006
"""Share of points that may lie beyond a side: depth pixels smear over edges."""
INSET = 0.0
"""How much [m] each side lies outside of what was seen of it."""


class Surface(NamedTuple):
    """A level surface at `height` [m] with its `outline` [map] and the `points` (n, 2) [map] that were seen of it."""

    outline: Rectangle
    height: float
    points: Array


def find_surfaces(points: Array) -> list[Surface]:
    """The surfaces among points (n, 3) [map], the largest first."""
    if len(points) < 10:
        return []
    low = points.min(axis=0) - (2 * CELL, 2 * CELL, 2 * LAYER)
    size = (CELL, CELL, LAYER)
    index = ((points - low) / size).astype(np.intp)
    count = np.zeros(index.max(axis=0) + 3, np.int32)
    np.add.at(count, tuple(index.T), 1)
    # A voxel that one picture alone showed once is noise at an edge.
    labels, number = ndimage.label(count >= 2, np.ones((3, 3, 3)))
    label = labels[tuple(index.T)]
    found = [s for n in range(1, number + 1) for s in _surfaces_of(points[label == n])]
    return sorted(found, key=lambda s: -s.outline.length * s.outline.width)


def _surfaces_of(points: Array) -> list[Surface]:
    """The surfaces in one connected set: the height that most points have, then what is left."""
    found: list[Surface] = []
    rest = points
    while _area(rest) > LEAST_AREA:
        height = _mode(rest[:, 2])
        on = np.abs(rest[:, 2] - height) < THICK
        flat, rest = rest[on], rest[~on]
        for part in _parts(flat):
            outline = fit_rectangle(flat[part, :2])
            filled = _area(flat[part]) / max(outline.length * outline.width, 1e-6)
            if outline.width > LEAST_SIDE and filled > FILLED:
                found.append(Surface(outline, _mean_height(flat[part, 2]), flat[part, :2]))
    return found


def _parts(points: Array) -> list[NDArray[np.bool_]]:
    """Masks of the large parts of points (n, 3) that hang together and have no step in between."""
    cells, cell = np.unique(np.floor(points[:, :2] / CELL).astype(np.int64), axis=0, return_inverse=True)
    cell = cell.ravel()
    height = np.bincount(cell, points[:, 2]) / np.bincount(cell)
    near = KDTree(cells).query_pairs(NEIGHBOUR, output_type="ndarray")
    joined = near[np.abs(height[near[:, 0]] - height[near[:, 1]]) < STEP]
    graph = coo_matrix((np.ones(len(joined)), joined.T), shape=(len(cells), len(cells)))
    _, label = csgraph.connected_components(graph, directed=False)
    large = np.nonzero(np.bincount(label) * CELL**2 > LEAST_AREA)[0]
    return [label[cell] == n for n in large]


def _area(points: Array) -> float:
    """Floor [m2] under points (n, 2 or 3)."""
    if not len(points):
        return 0.0
    return float(len(np.unique(np.floor(points[:, :2] / CELL).astype(np.int64), axis=0))) * CELL**2


def _mode(heights: Array) -> float:
    """The height [m] that most have, to some millimetres."""
    edges = np.arange(heights.min() - 0.02, heights.max() + 0.03, 0.005)
    count = np.convolve(np.histogram(heights, edges)[0], np.ones(5), "same")
    return float(edges[int(np.argmax(count))] + 0.0025)


def _mean_height(heights: Array) -> float:
    middle = float(np.median(heights))
    return float(np.mean(heights[np.abs(heights - middle) < 0.015]))


def fit_rectangle(points: Array) -> Rectangle:
    """The smallest rectangle around points (n, 2), but for RIM of them at each side."""
    best: tuple[float, Rectangle] | None = None
    for yaw in np.arange(0.0, math.pi / 2, CORNER):
        c, s = math.cos(yaw), math.sin(yaw)
        own = points @ np.array([[c, -s], [s, c]])
        low, high = np.quantile(own, RIM, axis=0) - INSET, np.quantile(own, 1.0 - RIM, axis=0) + INSET
        area = float(np.prod(high - low))
        if best is None or area < best[0]:
            u, v = (low + high) / 2
            length, width = (float(v) for v in high - low)
            best = area, Rectangle(float(c * u - s * v), float(s * u + c * v), length, width, float(yaw))
    assert best is not None
    return _long_way(best[1])


def _long_way(r: Rectangle) -> Rectangle:
    """The same rectangle with its length along the longer side, and the smaller of the two turns."""
    if r.length < r.width:
        r = r._replace(length=r.width, width=r.length, yaw=r.yaw - math.pi / 2)
    return r._replace(yaw=math.remainder(r.yaw, math.pi))
