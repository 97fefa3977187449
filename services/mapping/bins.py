"""Detection of open bins: holes in a ring of low things on the grid, their rims measured from pictures. Pure."""

import numpy as np
from scipy import ndimage

from common.furniture_parts import BIN_WALL
from common.geometry import Array, Rectangle
from services.mapping.grid import RESOLUTION, Cells, Grid
from services.mapping.surfaces import fit_rectangle

BIN_SIDE, BIN_HEIGHT = (0.15, 0.65), (0.18, 0.62)
"""Width of the inside of an open bin, and height of its rim [m]."""
RING, RIM_BAND, RIM_POINTS = 0.06, 0.04, 12
"""How far around the hole its rim is looked for, the height that counts to it [m], and points without which there is
none [count]: a cell, and the noise."""
BOTTOM = 0.1
"""Height [m] up to which what is covered may be the bottom of a bin."""
RIM_SHARE = 0.4
"""Share of the cells around a hole that are as low as a rim, at least [-]: two of four sides, and a hidden corner."""


def find_bins(grid: Grid, low: Array) -> list[tuple[Rectangle, float]]:
    """Outline of the inside and height of the rim of open bins: holes in a ring of something low."""
    # The bottom of a bin, and the noise of it, are no sides.
    taken = grid.walls | (grid.covered & (grid.highest > BOTTOM))
    found: list[tuple[Rectangle, float]] = []
    # Of a side that a wall hides from the lidar a cell may be missing; a hole of two cells is gone when gaps are shut.
    for ring in (taken, ndimage.binary_closing(taken, np.ones((3, 3)))):
        for one in _holes(grid, low, ring):
            if not any(o.contains(one[0].x, one[0].y) for o, _ in found):
                found.append(one)
    return found


def _holes(grid: Grid, low: Array, taken: Cells) -> list[tuple[Rectangle, float]]:
    labels, _ = ndimage.label(~taken)
    found = []
    for n, where in enumerate(ndimage.find_objects(labels), 1):
        size = [(part.stop - part.start) * RESOLUTION for part in where]
        if not (BIN_SIDE[0] <= min(size) and max(size) <= BIN_SIDE[1]):
            continue
        hole = labels == n
        highest = grid.highest[ndimage.binary_dilation(hole) & taken]
        low_sides = highest[(highest > 0.0) & (highest < BIN_HEIGHT[1] + RIM_BAND)]
        # In a corner the walls of the room are at two sides of it.
        if len(low_sides) < RIM_SHARE * len(highest):
            continue
        rim = float(np.median(low_sides))
        if not BIN_HEIGHT[0] <= rim <= BIN_HEIGHT[1]:
            continue
        rows, columns = np.nonzero(hole)
        inside = fit_rectangle(grid.points((rows, columns))).grown(RESOLUTION / 2)
        near = inside.grown(RING).signed_distances(low[:, 0], low[:, 1]) < 0.0
        upper = low[near & (np.abs(low[:, 2] - rim) < RIM_BAND)]
        if len(upper) < RIM_POINTS:
            continue
        height = float(np.quantile(upper[:, 2], 0.8))
        within = fit_rectangle(upper[upper[:, 2] > height - RIM_BAND / 2, :2]).grown(-BIN_WALL)
        # The rim is the better measure, unless only a part of it was seen from near.
        whole = max(abs(within.length - inside.length), abs(within.width - inside.width)) < 2 * RESOLUTION
        found.append((within if whole else inside, height))
    return found
