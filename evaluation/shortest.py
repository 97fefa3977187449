"""The shortest collision-free way of a mission on the true floor plan: the yardstick for what was driven."""

import math
from collections.abc import Sequence
from itertools import pairwise, permutations

from scipy.sparse import csgraph

from common.approach import poses_for
from common.geometry import Point, Pose2
from common.grid_graph import graph_of, nearest_free
from common.scene import Receptacle, Scene
from services.navigation.config import NavigationConfig
from services.navigation.planning.costmap import Costmap

MAX_ORDERED = 5
"""Objects whose every order is tried for the shortest way: 120 orders."""
REACH = 2
"""Rows and columns of the longest step of a way [cells]: 16 directions."""


class ShortestPaths:
    """Lengths of shortest paths for the base as a disc; 16 directions, then pulled tight."""

    def __init__(self, scene: Scene) -> None:
        config = NavigationConfig()
        self._config, self._scene = config, scene
        self._map = Costmap(scene, config.resolution, 1.0)
        self._free = self._map.distance >= config.footprint_radius
        self._graph = graph_of(self._free, config.resolution, REACH)

    def length(self, start: Point, ends: Sequence[Point]) -> float:
        """Length [m] of the path to the nearest of `ends`; inf when none can be reached."""
        points = self.path(start, ends)
        return sum(math.dist(a, b) for a, b in pairwise(points)) if points else math.inf

    def path(self, start: Point, ends: Sequence[Point]) -> list[Point]:
        """The corners of the shortest path to the nearest of `ends`, from there back; empty when there is none."""
        width = self._map.shape[1]
        cost, previous = csgraph.dijkstra(
            self._graph, directed=False, indices=self._index(start), return_predecessors=True
        )
        goals = [self._index(e) for e in ends]
        if not goals:
            return []
        best = min(goals, key=lambda g: cost[g])
        if not math.isfinite(cost[best]):
            return []
        cells = [best]
        while previous[cells[-1]] >= 0:
            cells.append(int(previous[cells[-1]]))
        return self._tight([self._map.point(*divmod(c, width)) for c in cells])

    def _tight(self, points: list[Point]) -> list[Point]:
        corners, i = points[:1], 0
        radius = self._config.footprint_radius
        while i < len(points) - 1:
            j = len(points) - 1
            while j > i + 1 and self._map.line_clearance(points[i], points[j]) < radius:
                j -= max(1, (j - i) // 8)
            corners.append(points[j])
            i = j
        return corners

    def _index(self, point: Point) -> int:
        row, column = nearest_free(self._free, self._map.cell(*point))
        return row * self._map.shape[1] + column

    # --- missions
    def stands(self, x: float, y: float, receptacle: Receptacle | None) -> list[Point]:
        """Where the base may stand to reach a point on a receptacle."""
        config = self._config
        found = [p for _, p in poses_for((x, y), receptacle, config.stand_off, config.edge_distance)]
        free = [(p[0], p[1]) for p in found if self._map.clearance(p[0], p[1]) >= config.footprint_radius]
        return free or [(p[0], p[1]) for p in found]

    def _goal(self, name: str) -> list[Point]:
        scene = self._scene
        receptacle = scene.receptacle(name)
        if name == scene.delivery or receptacle is None:
            return [(scene.home.x, scene.home.y)]
        return self.stands(receptacle.center[0], receptacle.center[1], receptacle)

    def mission(self, start: Pose2, deliveries: Sequence[tuple[Point, str, str]]) -> float:
        """Length [m] of the way from `start` over every (object's place, what it is on, its goal), best order."""
        scene = self._scene
        pick = [self.stands(*where, scene.receptacle(on)) for where, on, _ in deliveries]
        drop = [self._goal(goal) for _, _, goal in deliveries]
        carry = [min(self.length(p, d) for p in _spread(ps)) for ps, d in zip(pick, drop, strict=True)]
        count = len(deliveries)
        if not count:
            return 0.0
        first = [self.length((start[0], start[1]), p) for p in pick]
        between = [[min(self.length(d, p) for d in _spread(drop[i])) for p in pick] for i in range(count)]
        orders = permutations(range(count)) if count <= MAX_ORDERED else iter([tuple(range(count))])
        return min(first[o[0]] + sum(carry) + sum(between[a][b] for a, b in pairwise(o)) for o in orders)


def _spread(points: Sequence[Point]) -> Sequence[Point]:
    """A few of many standing places, the first of them among them."""
    return points[:: max(1, len(points) // 4)] or points
