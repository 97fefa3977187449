"""The next viewpoint of a search for an object that is not in view, from where the robot has looked so far. Pure."""

import math
from collections import Counter
from collections.abc import Collection
from functools import lru_cache
from itertools import product

import numpy as np
from scipy.sparse import csgraph

from common.approach import ROOM
from common.floor_grid import Cells, static_distances
from common.floor_plan import FloorPlan
from common.geometry import Array, Pose2
from common.grid_graph import graph_of, nearest_free
from common.viewpoints import NEAR, Mask, Viewpoints
from common.viewpoints import REACH as FAR

Point = tuple[float, float]
RESOLUTION = 0.05
"""Side of a cell [m]: that of navigation's costmap, so that both agree on which doors are wide enough."""
REACH = 1
"""Rows and columns of a step [cells]: 8 directions, which makes a way 8 % too long at most."""
AMPLE = 0.48
"""Free floor around a viewpoint [m] that is preferred; chosen: the footprint's radius 0.29 and what an unknown chair
takes of it. Where a surface shows from narrower places only, these are taken in the end."""
TRIES = 2
"""Times that a viewpoint is driven to in vain before it is given up [count]."""


def turn(viewpoints: Viewpoints, here: Pose2, looked_from: Collection[Pose2], told: Mask | None = None) -> Pose2 | None:
    """The heading at this spot that shows most that is new of tables, shelves and where it is `told` to be; None when
    turning shows nothing."""
    wanted = viewpoints.listed if told is None else viewpoints.listed | told
    return viewpoints.turn(here, _unseen(viewpoints, looked_from) * wanted)


def elsewhere(
    floor_plan: FloorPlan,
    viewpoints: Viewpoints,
    here: Pose2,
    looked_from: Collection[Pose2],
    unreached: Collection[Pose2] = (),
    likelihood: Array | None = None,
    told: Mask | None = None,
    flat: bool = False,
) -> Pose2 | None:
    """The viewpoint that shows most that is new for the way there; None when everything has been looked at.

    `unreached`: viewpoints that it could not get to, as often as it tried. Another one is chosen as long as there is
    any, then each once more: who stood in the way may have gone. `likelihood` (p,) of each point, as `Viewpoints.best`
    takes it. The points (p,) where it is `told` to be come first, sofas and beds last; where it may lie `flat` these
    points, and in the end the other tables and shelves, are looked at from near as well.
    """
    ways = Ways(floor_plan, (here[0], here[1]))

    def cost(to: Pose2) -> float:
        return ways.length((to[0], to[1]))

    def ample(to: Pose2) -> bool:
        return ways.room((to[0], to[1])) >= AMPLE and math.isfinite(cost(to))

    def fits(to: Pose2) -> bool:
        return math.isfinite(cost(to))

    unseen, far, failed = _unseen(viewpoints, looked_from), _unseen(viewpoints, looked_from, NEAR), Counter(unreached)
    at = told if told is not None else np.zeros(len(unseen), bool)
    orders = [(unseen * at, False), (far * at, True), (unseen * viewpoints.listed, False), (unseen, False)]
    orders = [*orders, (far * viewpoints.listed, True)] if flat else [o for o in orders if not o[1]]
    for most in range(1, TRIES + 1):
        tried = {*looked_from, *(pose for pose, times in failed.items() if times >= most)}
        for (worth, near), free in product(orders, (ample, fits)):
            if (found := viewpoints.best(worth, tried, cost, free, likelihood, near)) is not None:
                return found
    return None


def _unseen(viewpoints: Viewpoints, looked_from: Collection[Pose2], reach: float = FAR) -> Array:
    """1 for each point (p,) that no look has shown within `reach` [m], 0 for the others."""
    unseen: Array = (~viewpoints.covered(looked_from, reach)).astype(float)
    return unseen


# --- how far the base has to drive from where it stands, by the floor plan alone
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
