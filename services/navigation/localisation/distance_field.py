"""The static map as the lidar sees it: a horizontal cut through the floor plan, as a signed distance field."""

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from common.floor_plan import FloorPlan
from common.furniture_parts import parts
from common.geometry import Array, Rectangle

RESOLUTION = 0.025
"""Distance between nodes [m]; chosen: half the thickness of a table's leg."""
REACH = 0.6
"""Greatest distance that is told apart [m]; chosen: more than the widest weights of localisation."""


def rectangles(floor_plan: FloorPlan, height: float) -> list[Rectangle]:
    """What a horizontal ray at `height` [m] can hit."""
    found: list[Rectangle] = []
    found += [wall.footprint for wall in floor_plan.walls if not wall.glass]
    found += [box.outline for box in floor_plan.furniture if abs(height - box.center[2]) <= box.size[2] / 2]
    for r in floor_plan.receptacles:
        cut = [p for p in parts(r) if abs(height - p.center[2]) <= p.size[2] / 2]
        found += [Rectangle(*r.outline.to_map(*p.center[:2]), *p.size[:2], r.yaw) for p in cut]
    return found


class DistanceField:
    """Signed distance [m] to what the lidar can hit, up to REACH: exact at the nodes, bilinear between them."""

    def __init__(self, floor_plan: FloorPlan, height: float, resolution: float = RESOLUTION) -> None:
        self._resolution = resolution
        self._origin = np.array(floor_plan.low) - REACH
        columns, rows = (np.ceil((np.array(floor_plan.high) + REACH - self._origin) / resolution)).astype(int) + 1
        field = np.full((rows, columns), REACH)
        xs = self._origin[0] + np.arange(columns) * resolution
        ys = self._origin[1] + np.arange(rows) * resolution
        for r in rectangles(floor_plan, height):
            c, s = abs(math.cos(r.yaw)), abs(math.sin(r.yaw))
            wide = (c * r.length + s * r.width) / 2 + REACH
            high = (s * r.length + c * r.width) / 2 + REACH
            i, j = np.searchsorted(xs, (r.x - wide, r.x + wide))
            k, n = np.searchsorted(ys, (r.y - high, r.y + high))
            near = field[k:n, i:j]
            np.minimum(near, r.signed_distances(xs[i:j], ys[k:n][:, None]), out=near)
        self._columns, self._last = columns, np.array((columns, rows)) - 1.001
        self._flat = field.ravel()

    def at(self, points: Array) -> tuple[Array, Array, Array]:
        """Distance and its gradient along x and y (each (n,)) at points (n, 2); beyond the map: at its rim."""
        scaled = np.minimum(np.maximum((points - self._origin) / self._resolution, 0.0), self._last)
        cell = scaled.astype(np.intp)
        u, v = (scaled - cell).T
        index = cell[:, 1] * self._columns + cell[:, 0]
        flat = self._flat
        a, b = flat[index], flat[index + 1]
        c, d = flat[index + self._columns], flat[index + self._columns + 1]
        low, high = a + (b - a) * u, c + (d - c) * u
        gx = ((b - a) * (1 - v) + (d - c) * v) / self._resolution
        return low + (high - low) * v, gx, (high - low) / self._resolution

    def nearest(self, points: Array) -> Array:
        """Distance (n,) at the nearest node to points (n, 2)."""
        scaled = (points - self._origin) / self._resolution + 0.5
        cell = np.minimum(np.maximum(scaled, 0.0), self._last).astype(np.intp)
        found: Array = self._flat[cell[:, 1] * self._columns + cell[:, 0]]
        return found

    def near(self, points: Array, limit: float) -> NDArray[np.bool_]:
        """Which points (n, 2) lie within `limit` [m] of something."""
        found: NDArray[np.bool_] = self.nearest(points) <= limit
        return found


@lru_cache(maxsize=4)
def distance_field(floor_plan: FloorPlan, height: float) -> DistanceField:
    """The field of a floor plan, made once."""
    return DistanceField(floor_plan, height)
