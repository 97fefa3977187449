"""Where a known shape must stand to explain the points that were seen of it. Pure.

Round objects are profiles turned about a vertical axis, boxes have a yaw. Both stand upright on a surface whose
height is known, so that two or three numbers are sought; the residual says how well the shape explains the points.
"""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Array
from common.kinds import Kind
from services.perception.shapes.least_squares import solve

Ends = tuple[bool, bool]
SAMPLE = 160
"""Points of a segment that are used, evenly spread. Chosen: more only takes longer."""
ROBUST, STRAY = 0.004, 0.007
"""Distance [m] beyond which a point counts less, and beyond which it is left out at last. Chosen: two and four times
the noise."""
EDGE_WEIGHT = 3.0
"""Weight of each visible end of a box, in points of its faces."""
TRIES, SETTLED = 15, 0.001
"""Steps of the solver, and the mean error [m] of a fit at which no further start is tried."""
TINY = 1e-12
"""Stands in for a length of zero in a division [m]."""
_CORNERS = ((1, 1), (1, -1), (-1, 1), (-1, -1))
"""Of a box on the floor plan, in half extents [x, y]."""


@dataclass(frozen=True)
class Fit:
    """Centre (x, y) [m] and yaw [rad] of a shape, and the mean distance [m] of the points from its surface."""

    x: float
    y: float
    yaw: float
    residual: float


@cache
def outline(kind: Kind, size: Vec3, foot: bool = False) -> Array:
    """Starts and directions (radius, height) of the outline's segments (4, k, 1), with its `foot` if asked for."""
    below = [((0, 0), (size[0] / 2, 0))] if foot else []
    ends = np.array([*kind.profile(size), *below]).transpose(1, 2, 0)[..., None]
    return np.concatenate([ends[0], ends[1] - ends[0]])


def from_outline(rho: Array, z: Array, outline: Array) -> tuple[Array, Array, Array]:
    """Distance (n,) of points at radius `rho` and height `z`, and how it grows with either."""
    r0, z0, dr, dz = outline
    across, up = rho - r0, z - z0
    t = np.minimum(np.maximum((across * dr + up * dz) / (dr * dr + dz * dz), 0.0), 1.0)
    across, up = across - t * dr, up - t * dz
    squared = across * across + up * up
    nearest = squared.argmin(axis=0), np.arange(len(rho))
    distance = np.sqrt(squared[nearest])
    far = np.maximum(distance, TINY)
    return distance, across[nearest] / far, up[nearest] / far


def _from_box(local: Array, size: Vec3) -> tuple[Array, Array]:
    """Distance (n,) of points (3, n) in the box's frame from its surface, and its gradient (3, n)."""
    outside = np.abs(local) - np.array(size)[:, None] / 2
    past, deep = np.maximum(outside, 0.0), outside.max(axis=0)
    far = np.sqrt((past * past).sum(axis=0))
    # Out of the box it grows away from the nearest point, within it towards the middle.
    gradient = np.where(far > 0, past / np.maximum(far, TINY), np.where(outside == deep, -1.0, 0.0)) * np.sign(local)
    return np.where(far > 0, far, -deep), gradient


def residuals(kind: Kind, size: Vec3, points: Array, floor: float, p: Array) -> tuple[Array, Array]:
    """Distance (n,) of points (n, 3) from a shape that stands at p = (x, y, yaw) or (x, y), and its slopes (n, k)."""
    dx, dy, z = points[:, 0] - p[0], points[:, 1] - p[1], points[:, 2] - floor
    if kind.shape == "box":
        c, s = math.cos(p[2]), math.sin(p[2])
        x, y = c * dx + s * dy, c * dy - s * dx
        distance, (gx, gy, _) = _from_box(np.array([x, y, z - size[2] / 2]), size)
        return distance, np.array([s * gy - c * gx, -s * gx - c * gy, gx * y - gy * x]).T
    if kind.shape == "sphere":
        r = size[0] / 2
        far = np.sqrt(dx * dx + dy * dy + (z - r) ** 2)
        distance, growth = np.abs(far - r), np.sign(far - r) / np.maximum(far, TINY)
    else:
        rho = np.hypot(dx, dy)
        distance, growth, _ = from_outline(rho, z, outline(kind, size))
        growth = growth / np.maximum(rho, TINY)
    return distance, np.array([-dx * growth, -dy * growth]).T


def distances(kind: Kind, size: Vec3, points: Array, floor: float, x: float, y: float, yaw: float) -> Array:
    """Distance [m] of each point (n, 3) from the surface of a shape that stands at (x, y) on height `floor`."""
    return residuals(kind, size, points, floor, np.array([x, y, yaw]))[0]


def _span(points: Array, camera: Array, ahead: float) -> Array:
    """The leftmost and the rightmost of points (n, 2), seen from `camera`, about the bearing `ahead` [rad]."""
    bearings = np.arctan2(points[:, 1] - camera[1], points[:, 0] - camera[0]) - ahead
    bearings = np.remainder(bearings + math.pi, 2 * math.pi) - math.pi
    return np.array([bearings.min(), bearings.max()])


def end_bearings(size: Vec3, p: Array, camera: Array, ahead: float) -> tuple[Array, Array]:
    """Bearings (2,) of the leftmost and the rightmost corner of a box at p = (x, y, yaw), and their slopes (2, 3)."""
    c, s = math.cos(p[2]), math.sin(p[2])
    x, y = float(p[0] - camera[0]), float(p[1] - camera[1])
    corners = []
    for a, b in _CORNERS:
        dx, dy = (c * a * size[0] - s * b * size[1]) / 2, (s * a * size[0] + c * b * size[1]) / 2
        u, v = x + dx, y + dy
        squared = u * u + v * v
        bearing = math.remainder(math.atan2(v, u) - ahead, 2 * math.pi)
        corners.append((bearing, -v / squared, u / squared, (dx * u + dy * v) / squared))
    outer = np.array([min(corners), max(corners)])
    return outer[:, 0], outer[:, 1:]


def fit(kind: Kind, size: Vec3, points: Array, floor: float, camera: Array, ends: Ends = (True, True)) -> Fit:
    """Place a shape on the surface of height `floor` so that it explains `points` (n, 3), seen from `camera` (3,).

    `ends`: nothing hides its right or its left end, so that a box must end there where its points do.
    """
    used = points[:: max(1, len(points) // SAMPLE)]
    middle = used[:, :2].mean(axis=0)
    away = middle - camera[:2]
    away /= max(1e-6, float(np.linalg.norm(away)))
    boxy = kind.shape == "box"
    yaws = (0.0, 0.5, 1.0, 1.5) if size[0] == size[1] else (0.0, 0.5, 1.0, 1.5, 2.0, 2.5)
    # A box of unequal sides also ends where its points do, or its far side would be free.
    free = np.array(ends) & (boxy and size[0] != size[1])
    ahead, scale = math.atan2(away[1], away[0]), EDGE_WEIGHT * float(np.linalg.norm(middle - camera[:2]))
    edges = _span(points, camera, ahead) if free.any() else None

    def off(p: Array, points: Array) -> tuple[Array, Array]:
        apart, slopes = residuals(kind, size, points, floor, p)
        if edges is None:
            return apart, slopes
        corners, turns = end_bearings(size, p, camera, ahead)
        return np.append(apart, scale * (corners - edges)[free]), np.concatenate([slopes, scale * turns[free]])

    def badness(p: Array) -> float:
        apart = np.minimum(np.abs(off(p, used)[0]), 0.02)
        return float(apart[: len(used)].mean() + apart[len(used) :].sum() / EDGE_WEIGHT)

    if boxy:
        turned = [(yaw, abs(math.cos(yaw - ahead)) * size[0] + abs(math.sin(yaw - ahead)) * size[1]) for yaw in yaws]
        starts = sorted((np.array([*middle + away * 0.4 * deep, yaw]) for yaw, deep in turned), key=badness)
    else:
        # Of a vessel whose front is hidden the far wall is seen from inside: its axis is nearer than the points.
        nearer = (0.25, -0.35) if kind.wall else (0.25,)
        starts = [middle + away * share * size[0] for share in nearer]
    best, cost = starts[0], math.inf
    for tried, begin in enumerate(starts):
        # A box may settle on the wrong side: more of its starts are followed until one explains the points.
        if tried >= 2 and cost < len(used) * SETTLED**2:
            break
        then, new = solve(lambda p: off(p, used), begin, ROBUST, TRIES)
        if new < cost:
            best, cost = then, new
    # Once more without what the shape does not have, such as a mug's handle.
    own = used[off(best, used)[0][: len(used)] < STRAY]
    if len(own) > len(used) // 2:
        best = solve(lambda p: off(p, own), best, ROBUST / 2, TRIES)[0]
    x, y = float(best[0]), float(best[1])
    yaw = float(best[2]) if boxy else 0.0
    left = np.minimum(distances(kind, size, used, floor, x, y, yaw), 0.02)
    return Fit(x, y, math.remainder(yaw, math.pi), float(left.mean()))


def handle_yaw(size: Vec3, points: Array, x: float, y: float, camera: Array) -> tuple[float, bool]:
    """Direction [rad] of a mug's handle, and whether it was seen: without points off the wall, away from `camera`."""
    dx, dy = points[:, 0] - x, points[:, 1] - y
    rho = np.hypot(dx, dy)
    outside = (rho > size[0] / 2 + 0.006) & (rho < size[0] / 2 + 0.04)
    if np.count_nonzero(outside) >= 6:
        return math.atan2(float(dy[outside].mean()), float(dx[outside].mean())), True
    return math.atan2(y - float(camera[1]), x - float(camera[0])), False
