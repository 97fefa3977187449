"""A grid over a floor plan, and the distance of each cell to the nearest obstacle of the plan. Pure."""

import math

import numpy as np
from numpy.typing import NDArray

from common.approach import BIN_RIM
from common.floor_plan import FloorPlan
from common.geometry import Array

_PAD = 0.3
"""Margin around the floor plan [m]; chosen: less than a footprint, so that nothing drives there."""


class Cells:
    """Square cells of `resolution` [m] over a floor plan and a margin; `origin` is the outer corner of the first."""

    def __init__(self, floor_plan: FloorPlan, resolution: float) -> None:
        self.resolution = resolution
        self.origin = (floor_plan.low[0] - _PAD, floor_plan.low[1] - _PAD)
        width = math.ceil((floor_plan.high[0] - floor_plan.low[0] + 2 * _PAD) / resolution)
        height = math.ceil((floor_plan.high[1] - floor_plan.low[1] + 2 * _PAD) / resolution)
        self.shape = (height, width)

    def centres(self) -> Array:
        """The middle of every cell (rows, columns, 2) [map]."""
        return np.stack(np.meshgrid(*self.middles(*(np.arange(n) for n in self.shape))), axis=2)

    def middles(self, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> tuple[Array, Array]:
        """The x of columns and the y of rows (n,) [map]."""
        x, y = self.origin
        return np.asarray(x + (columns + 0.5) * self.resolution), np.asarray(y + (rows + 0.5) * self.resolution)

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """(row, column) of a point, clipped to the map."""
        column = int((x - self.origin[0]) / self.resolution)
        row = int((y - self.origin[1]) / self.resolution)
        return min(max(row, 0), self.shape[0] - 1), min(max(column, 0), self.shape[1] - 1)

    def point(self, row: int, column: int) -> tuple[float, float]:
        """The centre of a cell."""
        return (
            self.origin[0] + (column + 0.5) * self.resolution,
            self.origin[1] + (row + 0.5) * self.resolution,
        )

    def cells(self, xs: Array, ys: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Rows and columns (n,) of points, clipped to the map."""
        columns = ((xs - self.origin[0]) / self.resolution).astype(np.intp)
        rows = ((ys - self.origin[1]) / self.resolution).astype(np.intp)
        top, right = self.shape[0] - 1, self.shape[1] - 1
        return np.minimum(np.maximum(rows, 0), top), np.minimum(np.maximum(columns, 0), right)


def static_distances(frame: Cells, floor_plan: FloorPlan) -> Array:
    """Distance (rows, columns) [m] of each cell's centre to the nearest obstacle of the plan.

    Exactly: counted in cells, the corner of a wall is up to 5 cm nearer than it seems.
    """
    gx, gy = np.moveaxis(frame.centres(), 2, 0)
    sides = (gx - floor_plan.low[0], floor_plan.high[0] - gx, gy - floor_plan.low[1], floor_plan.high[1] - gy)
    found: Array = np.minimum.reduce(sides)
    boxes = [f.outline for f in floor_plan.standing]
    # A table counts with its whole top: the lidar sees only its legs.
    boxes += [r.outline.grown(BIN_RIM if r.depth else 0.0) for r in floor_plan.receptacles]
    boxes += [wall.footprint for wall in floor_plan.walls]
    for box in boxes:
        np.minimum(found, box.signed_distances(gx, gy), out=found)
    return np.maximum(found, 0.0)
