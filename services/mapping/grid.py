"""The occupancy grid: counts of lidar rays that passed and hit each cell, and where the camera saw floor or obstacles.

The lidar alone does not make a cell free: it looks under tables. A cell is free when rays passed it and the camera saw
its floor, and nothing up to the robot's height above it.
"""

import zlib

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common import messages as m
from common.files.map_file import FREE, OCCUPIED, UNKNOWN
from common.geometry import Array, Pose2
from services.mapping.scan import Scan
from services.mapping.scan_matching import placed

Cells = NDArray[np.bool_]
Index = tuple[NDArray[np.intp], NDArray[np.intp]]
RESOLUTION = 0.05
"""Of a cell [m]: that of navigation's costmap."""
HIT_SHARE = 0.10
"""Share of scans that must have hit a cell, of those that hit or passed it, for it to count as occupied: rays that
graze a wall at 10 degrees pass six of its cells before they end."""
TOP_PICTURES, TOP_SHARE = 2, 0.15
"""Pictures that must show something above a cell, and their share of those that show its floor; chosen: one is noise,
and who walked through stood there in few."""
LOOKED_OVER = 1.2
"""Height [m] that the camera, at 1.3 m, looks over."""
OLD = 2
"""Scans or pictures that what an earlier run has seen of a cell counts for, at most [count]: a door that was shut then
is open when some twenty scans have looked through it."""
BODY = 0.45
"""Radius around a keyframe that counts as floor that was seen [m]: the footprint, and the strip before it that the
camera does not see."""
STEP = 0.04
"""Distance between the points of a ray [m]: less than a cell."""
BEFORE = 0.06
"""How far before its end a ray no longer counts as passing [m]: a cell, and the noise."""


class Grid:
    """Layers (rows, columns) over the rectangle from `low` to `high` [map]; `shut`: where something unseen stands."""

    def __init__(self, low: tuple[float, float], high: tuple[float, float]) -> None:
        self.origin = (round(low[0] / RESOLUTION) * RESOLUTION, round(low[1] / RESOLUTION) * RESOLUTION)
        self.shape = tuple(round((high[k] - low[k]) / RESOLUTION) for k in (1, 0))
        self.shut: Cells = np.zeros(self.shape, bool)
        self.clear()
        self.near: Cells = np.zeros(self.shape, bool)
        self.looked = np.zeros(self.shape, np.uint8)

    def clear(self) -> None:
        """Empty the layers of lidar and pictures."""
        self.passed = np.zeros(self.shape, np.int32)
        self.hits = np.zeros(self.shape, np.int32)
        self.floor = np.zeros(self.shape, np.int32)
        self.tops = np.zeros(self.shape, np.int32)
        self.body: Cells = np.zeros(self.shape, bool)
        self.lowest = np.full(self.shape, np.inf, np.float32)
        self.highest = np.zeros(self.shape, np.float32)

    def cells(self, points: Array) -> Index:
        """Rows and columns of the points (n, 2 or 3) [map] that lie on the grid."""
        return self._inside(points)[1]

    def _inside(self, points: Array) -> tuple[Cells, Index]:
        """Which points lie on the grid, and the rows and columns of those."""
        column = np.floor((points[:, 0] - self.origin[0]) / RESOLUTION).astype(np.intp)
        row = np.floor((points[:, 1] - self.origin[1]) / RESOLUTION).astype(np.intp)
        inside = (row >= 0) & (row < self.shape[0]) & (column >= 0) & (column < self.shape[1])
        return inside, (row[inside], column[inside])

    def at(self, points: Array, layer: Cells) -> Cells:
        """The layer's value at each point (n, 2 or 3) [map]; False off the grid."""
        found: Cells = np.zeros(len(points), bool)
        inside, cells = self._inside(points)
        found[inside] = layer[cells]
        return found

    def points(self, cells: Index) -> Array:
        """Middles (n, 2) [map] of cells."""
        return np.stack([cells[1] + 0.5, cells[0] + 0.5], axis=1) * RESOLUTION + self.origin

    # --- evidence
    def add_scan(self, scan: Scan, pose: Pose2) -> None:
        """Enter a scan that was taken with the base at `pose` [map]."""
        origin = placed(np.array([scan.lidar]), pose)[0]
        ends = placed(scan.points, pose)
        rays = np.concatenate([ends, placed(scan.passed, pose)]) - origin
        length = np.hypot(rays[:, 0], rays[:, 1])
        reach = np.maximum(length - BEFORE, 0.0)
        along = np.arange(0.0, reach.max(initial=0.0), STEP)
        on = along[None, :] < reach[:, None]
        ray, step = np.nonzero(on)
        through = origin + rays[ray] * (along[step] / np.maximum(length[ray], 1e-9))[:, None]
        mark = np.zeros(self.shape, bool)
        mark[self.cells(through)] = True
        self.passed += mark
        mark[:] = False
        mark[self.cells(ends)] = True
        self.hits += mark
        self._stand(pose)

    def fade(self) -> None:
        """Reduce the counts so far, as of an earlier day, so that what is seen from now on outweighs them."""
        for taken, one, other in ((self.walls, self.hits, self.passed), (self.covered, self.tops, self.floor)):
            one[:] = np.where(taken, OLD, 0)
            other[:] = np.where(taken, 0, np.minimum(other, OLD))
        self.looked[:] = 0

    def _stand(self, pose: Pose2) -> None:
        reach = int(BODY / RESOLUTION) + 1
        row, column = (int((v - o) / RESOLUTION) for v, o in ((pose[1], self.origin[1]), (pose[0], self.origin[0])))
        rows, columns = np.mgrid[row - reach : row + reach + 1, column - reach : column + reach + 1]
        cells = self.points((rows.ravel(), columns.ravel()))
        self.body[self.cells(cells[np.hypot(*(cells - pose[:2]).T) <= BODY])] = True

    def add_picture(self, floor: Array, above: Array) -> None:
        """Enter the points of floor (n, 2) and of obstacles above it (k, 3) [map] that a picture showed."""
        for points, layer in ((floor, self.floor), (above, self.tops)):
            mark = np.zeros(self.shape, bool)
            mark[self.cells(points)] = True
            layer += mark
        kept, cells = self._inside(above)
        np.minimum.at(self.lowest, cells, above[kept, 2].astype(np.float32))
        np.maximum.at(self.highest, cells, above[kept, 2].astype(np.float32))

    # --- reading
    @property
    def walls(self) -> Cells:
        """Mask (rows, columns) of the cells that the lidar sees as occupied."""
        found: Cells = (self.hits > 0) & (self.hits >= HIT_SHARE * (self.hits + self.passed))
        return found

    @property
    def tall(self) -> Cells:
        """Mask (rows, columns) of the cells with something that the lidar sees and the camera cannot look over."""
        # The camera sees a wall's face, which may lie in the cell before it.
        highest = ndimage.maximum_filter(self.highest, 3)
        found: Cells = self.walls & ((highest > LOOKED_OVER) | (highest == 0.0))
        return found

    @property
    def covered(self) -> Cells:
        """Mask (rows, columns) of the cells with something above the floor that the robot would touch."""
        found: Cells = (self.tops >= TOP_PICTURES) & (self.tops > TOP_SHARE * self.floor)
        return found

    def states(self) -> NDArray[np.uint8]:
        """FREE, OCCUPIED or UNKNOWN for each cell."""
        taken = self.walls | self.covered | self.shut
        seen = ndimage.binary_closing((self.floor > 0) | self.body, np.ones((3, 3))) | self.body
        free = seen & ndimage.binary_closing(self.passed > 0, np.ones((3, 3))) & ~taken
        return np.where(taken, OCCUPIED, np.where(free, FREE, UNKNOWN)).astype(np.uint8)

    def known(self, states: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], tuple[float, float]]:
        """The states cut to the rectangle around all known cells, and its south-west corner [map]."""
        rows, columns = np.nonzero(states != UNKNOWN)
        if not len(rows):
            rows = columns = np.zeros(1, int)
        top, left = int(rows.min()), int(columns.min())
        part = np.ascontiguousarray(states[top : int(rows.max()) + 1, left : int(columns.max()) + 1])
        return part, (self.origin[0] + left * RESOLUTION, self.origin[1] + top * RESOLUTION)

    def message(self, t: float, odom: Pose2, states: NDArray[np.uint8]) -> m.MapGrid:
        """The map as a message, cut to what is known."""
        part, (x, y) = self.known(states)
        return m.MapGrid(
            t=t, x=x, y=y, resolution=RESOLUTION, width=part.shape[1], height=part.shape[0],
            cells=zlib.compress(part.tobytes(), 1), odom=odom,
        )  # fmt: skip
