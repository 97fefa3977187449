"""Shortest paths on the grid with a cost that prefers clearance, and their smoothing."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse import csgraph

from common.geometry import Array, Point
from common.grid_graph import graph_of, nearest_free
from services.navigation.planning.costmap import Costmap

SPACING = 0.05
"""Distance between the points of a path [m]: the costmap's resolution."""
_WEIGHT = 4.0
"""Cost of a cell where the base just fits, beside its length [-]; chosen: a detour of four times the way."""
_JUMP = 60
"""Cells that one straight line may replace [count]: 3 m."""
_LOST = 0.03
"""Clearance that a straight line may lose against the path [m]: less than a cell."""


@dataclass(frozen=True)
class Field:
    """Path costs from one cell to all others [m, more where it is narrow], and the cell before each on its path."""

    start: tuple[int, int]
    cost: NDArray[np.float64]
    previous: NDArray[np.int32]


class PathPlanner:
    """Plans for a disc of `radius` [m]; cells closer to an obstacle than that cannot be entered."""

    def __init__(self, costmap: Costmap, radius: float, inflation: float) -> None:
        self._map, self._radius, self._inflation = costmap, radius, inflation
        self._graph: sparse.csr_matrix | None = None
        self._version = -1

    def free(self, x: float, y: float) -> bool:
        """True when the robot's disc fits at the point."""
        return self._map.clearance(x, y) >= self._radius

    def field(self, x: float, y: float) -> Field:
        """Costs from a point; a start that is too close to something is moved to the nearest free cell."""
        start = nearest_free(self._map.distance >= self._radius, self._map.cell(x, y))
        index = start[0] * self._map.shape[1] + start[1]
        cost, previous = csgraph.dijkstra(
            self._edges(), directed=False, indices=index, return_predecessors=True, min_only=False
        )
        return Field(start, cost.reshape(self._map.shape), previous)

    def path(self, field: Field, start: Point, goal: Point) -> list[Point] | None:
        """Points [map] every SPACING from start to goal; None when there is no path."""
        row, column = self._map.cell(*goal)
        if not math.isfinite(field.cost[row, column]):
            return None
        width = self._map.shape[1]
        index, cells = row * width + column, []
        while index >= 0:
            cells.append(index)
            index = int(field.previous[index])
        points = [self._map.point(*divmod(i, width)) for i in reversed(cells)]
        return self._resample(self._shorten([start, *points[1:-1], goal]))

    def cost_to(self, field: Field, goal: Point) -> float:
        """Path cost [m and more] to a point; inf when there is no way."""
        return float(field.cost[self._map.cell(*goal)])

    def possible(self, start: Point, goals: Sequence[Point], distance: Array | None = None) -> bool:
        """True when there is a way to one of the goals by a `distance` [m] from each cell to the nearest obstacle.

        Without it, by the static map alone.
        """
        distance = self._map.static_distance if distance is None else distance
        labels, _ = ndimage.label(distance >= self._radius, np.ones((3, 3)))
        here = labels[nearest_free(distance >= self._radius, self._map.cell(*start))]
        return bool(here) and any(labels[self._map.cell(*goal)] == here for goal in goals)

    def _edges(self) -> sparse.csr_matrix:
        if self._graph is not None and self._version == self._map.version:
            return self._graph
        distance = self._map.distance
        free = distance >= self._radius
        lack = np.clip((self._inflation - distance) / (self._inflation - self._radius), 0, 1)
        weight = 1.0 + _WEIGHT * np.square(lack)
        self._graph = graph_of(free, self._map.resolution, 1, weight)
        self._version = self._map.version
        return self._graph

    def _shorten(self, points: list[Point]) -> list[Point]:
        """Straight lines where they keep the clearance that the path had, and room for the base.

        Where it stands closer to something than it needs, nothing on its way is closer still.
        """
        kept, i = [points[0]], 0
        clearances = np.array([self._map.clearance(*p) for p in points])
        fits = min(self._radius, float(clearances[0]))
        while i < len(points) - 1:
            j = min(len(points) - 1, i + _JUMP)
            while j > i + 1:
                least = float(clearances[i : j + 1 : 3].min())
                straight = self._map.line_clearance(points[i], points[j])
                if straight >= min(least, self._inflation) - _LOST and straight >= (self._radius if i else fits):
                    break
                j -= max(1, (j - i) // 4)
            kept.append(points[j])
            i = j
        return kept

    @staticmethod
    def _resample(points: Sequence[Point]) -> list[Point]:
        array = np.array(points)
        lengths = np.hypot(*np.diff(array, axis=0).T)
        along = np.concatenate([[0.0], np.cumsum(lengths)])
        count = max(2, math.ceil(along[-1] / SPACING) + 1)
        s = np.linspace(0, along[-1], count)
        return list(
            zip(np.interp(s, along, array[:, 0]).tolist(), np.interp(s, along, array[:, 1]).tolist(), strict=True)
        )
