"""How far the base has to drive from where it stands, by the floor plan alone. Pure."""

import math
from functools import lru_cache

import numpy as np
from scipy.sparse import csgraph

from common.approach import ROOM
from common.floor_grid import Cells, static_distances
from common.floor_plan import FloorPlan
from common.geometry import Array
from common.grid_graph import graph_of, nearest_free

Point = tuple[float, float]
RESOLUTION = 0.05
"""Side of a cell [m]: that of navigation's costmap, so that both agree on which doors are wide enough."""
REACH = 1
"""Rows and columns of a step [cells]: 8 directions, which makes a way 8 % too long at most."""


class Ways:
    """Lengths of the shortest ways over a floor plan from one point [map]."""

    def __init__(self, floor_plan: FloorPlan, start: Point) -> None:
        self._ground = _ground(floor_plan)
        self._lengths = self._ground.lengths(start)

    def length(self, to: Point) -> float:
        """Length [m] of the way to a point [map]; inf where none leads or the base does not fit."""
        return float(self._lengths[self._ground.cells.cell(*to)])

    def room(self, at: Point) -> float:
        """Distance [m] from a point [map] to the nearest wall, furniture or surface."""
        return float(self._ground.distance[self._ground.cells.cell(*at)])


class _Ground:
    def __init__(self, floor_plan: FloorPlan) -> None:
        self.cells = Cells(floor_plan, RESOLUTION)
        self.distance = static_distances(self.cells, floor_plan)
        self._free = self.distance >= ROOM
        self._graph = graph_of(self._free, RESOLUTION, REACH)

    def lengths(self, start: Point) -> Array:
        """Lengths (rows, columns) [m] from a point; one where the base does not fit counts as the nearest where it
        does."""
        if not self._free.any():
            return np.full(self.cells.shape, math.inf)
        row, column = nearest_free(self._free, self.cells.cell(*start))
        index = row * self.cells.shape[1] + column
        found: Array = csgraph.dijkstra(self._graph, directed=False, indices=index).reshape(self.cells.shape)
        return found


@lru_cache(maxsize=2)
def _ground(floor_plan: FloorPlan) -> _Ground:
    return _Ground(floor_plan)
