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
from common.geometry import Array, Mask, Point, Pose2
from common.grid_graph import graph_of, nearest_free
from common.viewpoints import LEAST_GAIN, LOOK_COST, NEAR, Viewpoints
from common.viewpoints import REACH as FAR

RESOLUTION = 0.05
"""Side of a cell [m]: that of navigation's costmap, so that both agree on which doors are wide enough."""
REACH = 1
"""Rows and columns of a step [cells]: 8 directions, which makes a way 8 % too long at most."""
AMPLE = 0.48
"""Free floor around a viewpoint [m] that is preferred; chosen: the footprint's radius 0.29 and what an unknown chair
takes of it. Where a surface shows from narrower places only, these are taken in the end."""
CANDIDATES = 6
"""Viewpoints of which it is worked out how the search would go on from them [count]; chosen: twelve are no better."""
FLOOR_WORTH = 0.7
"""What a point of the floor counts, by one of a table [-]. Chosen: fewer than five are a corner that nearly shows."""
TRIES = 2
"""Times that a viewpoint is driven to in vain before it is given up [count]."""


def turn(viewpoints: Viewpoints, here: Pose2, looked_from: Collection[Pose2]) -> Pose2 | None:
    """The heading at this spot that shows most that is new of tables and shelves; None when turning shows nothing."""
    return viewpoints.turn(here, _unseen(viewpoints, looked_from) * viewpoints.listed)


def there(
    floor_plan: FloorPlan,
    viewpoints: Viewpoints,
    here: Pose2,
    looked_from: Collection[Pose2],
    unreached: Collection[Pose2],
    told: Mask,
    floor: Viewpoints | None = None,
    near: bool = False,
) -> Pose2 | None:
    """The viewpoint to go to for what is at the points (p,) where it was `told` to be, then seen from `near`, then on
    the `floor` there; None when that has been looked at. `unreached` as of `elsewhere`."""
    views = _Views(floor_plan, viewpoints, None)
    orders: list[_Order] = [(views, viewpoints.shows, _unseen(viewpoints, looked_from) * told)]
    if near:
        orders.append((views, viewpoints.near, _unseen(viewpoints, looked_from, NEAR) * told))
    if floor is not None:
        orders.append((_Views(floor_plan, floor, None), floor.shows, FLOOR_WORTH * _unseen(floor, looked_from)))
    return _next(orders, here, looked_from, unreached)


def elsewhere(
    floor_plan: FloorPlan,
    viewpoints: Viewpoints,
    here: Pose2,
    looked_from: Collection[Pose2],
    unreached: Collection[Pose2] = (),
    likelihood: Array | None = None,
    near: bool = False,
) -> Pose2 | None:
    """The viewpoint to go to for what is found soonest on the whole way; None when everything has been looked at.

    `unreached`: viewpoints that it could not get to, as often as it tried. Another one is chosen as long as there is
    any, then each once more: who stood in the way may have gone. `likelihood` (p,) of each point, as `Viewpoints.best`
    takes it. Last, if also from `near`, come the tables and shelves that were not seen so.
    """
    views = _Views(floor_plan, viewpoints, likelihood)
    unseen, listed = _unseen(viewpoints, looked_from), viewpoints.listed
    orders: list[_Order] = [(views, viewpoints.shows, unseen)]
    if near:
        orders.append((views, viewpoints.near, _unseen(viewpoints, looked_from, NEAR) * listed))
    return _next(orders, here, looked_from, unreached)


def _next(
    orders: "list[_Order]", here: Pose2, looked_from: Collection[Pose2], unreached: Collection[Pose2]
) -> Pose2 | None:
    failed = Counter(unreached)
    for most in range(1, TRIES + 1):
        tried = {*looked_from, *(pose for pose, times in failed.items() if times >= most)}
        for (views, shows, worth), room in product(orders, (AMPLE, 0.0)):
            if (found := views.next(here, shows, worth, tried, room)) is not None:
                return found
    return None


def _unseen(viewpoints: Viewpoints, looked_from: Collection[Pose2], reach: float = FAR) -> Array:
    """1 for each point (p,) that no look has shown within `reach` [m], 0 for the others."""
    unseen: Array = (~viewpoints.covered(looked_from, reach)).astype(float)
    return unseen


class _Views:
    """The viewpoints (v) of a search, with the ways between them by the floor plan alone.

    `room` (v,): distance [m] from each to the nearest wall, furniture or surface.
    """

    def __init__(self, floor_plan: FloorPlan, viewpoints: Viewpoints, likelihood: Array | None) -> None:
        self._poses, self._ground = viewpoints.poses, _ground(floor_plan)
        self._likely = np.ones(len(viewpoints.points)) if likelihood is None else likelihood
        cells = np.array([self._ground.cells.cell(x, y) for x, y, _ in self._poses], int).reshape(-1, 2)
        self._cells = cells[:, 0], cells[:, 1]
        self.room: Array = self._ground.distance[self._cells]
        self._lengths: dict[Point, Array] = {}

    def next(self, here: Pose2, shows: Mask, worth: Array, tried: Collection[Pose2], room: float) -> Pose2 | None:
        """The one of the viewpoints not `tried` with so much `room` with which a search finds soonest; None when none
        is worth it.

        `shows` (v, p): what counts as shown, `worth` (p,): what each point counts. By what each of the best shows for
        the way there alone, a shelf beside the robot would be passed by and come back to in the end.
        """
        left = np.array([pose not in tried for pose in self._poses], bool) & (self.room >= room)
        best = self._best(here, shows, worth, left, CANDIDATES)
        first = min(best, key=lambda n: self._delay(here, n, shows, worth, left), default=None)
        return self._poses[first] if first is not None else None

    def _best(self, start: Pose2, shows: Mask, worth: Array, left: Mask, most: int) -> list[int]:
        """Those that show most of what is likely for the way there from `start`, the best first."""
        score: Array = shows @ (worth * self._likely) / (self._ways(start) + LOOK_COST)
        score[~left | (shows @ worth < LEAST_GAIN)] = 0.0
        return [n for n in np.argsort(-score, kind="stable")[:most].tolist() if score[n] > 0.0]

    def _delay(self, start: Pose2, first: int | None, shows: Mask, worth: Array, left: Mask) -> float:
        """The way [m] of a search that begins with `first` up to where each point is seen, weighed by likelihood."""
        way = total = 0.0
        left = left.copy()
        while first is not None:
            way += float(self._ways(start)[first]) + LOOK_COST
            total += way * float((worth * self._likely)[shows[first]].sum())
            worth, start, left[first] = worth * ~shows[first], self._poses[first], False
            first = next(iter(self._best(start, shows, worth, left, 1)), None)
        return total + way * float((worth * self._likely).sum())

    def _ways(self, start: Pose2) -> Array:
        """Lengths (v,) [m] of the ways from a pose; inf where none leads or the base does not fit."""
        at = start[0], start[1]
        if at not in self._lengths:
            self._lengths[at] = self._ground.lengths(at)[self._cells]
        return self._lengths[at]


_Order = tuple[_Views, Mask, Array]
"""Viewpoints (v), what of their points (v, p) each shows, and what each point (p,) counts."""


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
