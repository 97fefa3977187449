"""Where a round shape that was knocked over must lie to explain the points that were seen of it. Pure.

A can, a bottle or a mug rests on its side: the profile of `shapes` turned about a horizontal axis one radius above the
surface. A mug or a bowl may also stand upside down: the profile mirrored at half its height.
"""

import math
from itertools import product

import numpy as np
from numpy.typing import NDArray

from common.floor_plan import Vec3
from common.geometry import Array
from common.kinds import Kind
from services.perception.shapes import known as shapes
from services.perception.shapes.known import ROBUST, SAMPLE, STRAY, TINY, TRIES, Fit, from_outline, outline
from services.perception.shapes.least_squares import solve

STARTS = (0.0, math.pi / 4, math.pi / 2, 3 * math.pi / 4)
"""Directions of the axis [rad] from which the fit begins, each both ways round."""
FOLLOWED = 4
"""Starts that are followed to their end: the two ends of a shape differ little from the side."""


def heights(kind: Kind, size: Vec3) -> tuple[float, float]:
    """Lowest and highest top [m] of a shape on its side."""
    return size[0], size[0] + kind.handle


def extents(size: Vec3) -> Vec3:
    """Full extents on its side: along its axis, across it, upwards."""
    return size[2], size[0], size[0]


def _apart(kind: Kind, size: Vec3, points: Array, floor: float, p: Array) -> tuple[Array, Array]:
    """Distance (n,) of points (n, 3) from a shape that lies at p = (x, y, yaw of its axis), and its slopes (n, 3)."""
    c, s = math.cos(p[2]), math.sin(p[2])
    dx, dy, w = points[:, 0] - p[0], points[:, 1] - p[1], points[:, 2] - floor - size[0] / 2
    along, side = c * dx + s * dy, c * dy - s * dx
    rho = np.hypot(side, w)
    distance, outward, endward = from_outline(rho, along + size[2] / 2, outline(kind, size, foot=True))
    sideward = outward * side / np.maximum(rho, TINY)
    slopes = np.array([s * sideward - c * endward, -c * sideward - s * endward, side * endward - along * sideward])
    return distance, slopes.T


def _beside(size: Vec3, points: Array, floor: float, p: Array) -> NDArray[np.bool_]:
    """Which of the points (n, 3) are farther from the axis than the body reaches."""
    side = math.cos(p[2]) * (points[:, 1] - p[1]) - math.sin(p[2]) * (points[:, 0] - p[0])
    beside: NDArray[np.bool_] = np.hypot(side, points[:, 2] - floor - size[0] / 2) > size[0] / 2 + STRAY
    return beside


def fit(kind: Kind, size: Vec3, points: Array, floor: float, camera: Array) -> Fit:
    """Lay a shape on the surface of height `floor` so that it explains `points` (n, 3), seen from `camera` (3,).

    The fit's (x, y) is half-way along the axis; its yaw points from the foot to the top.
    """
    used = points[:: max(1, len(points) // SAMPLE)]
    middle = used[:, :2].mean(axis=0)
    away = middle - camera[:2]
    away /= max(1e-6, float(np.linalg.norm(away)))

    def badness(p: Array) -> float:
        return float(np.minimum(_apart(kind, size, used, floor, p)[0], 0.02).mean())

    turns = [yaw + flip for yaw, flip in product(STARTS, (0.0,) if kind.ends_alike else (0.0, math.pi))]
    starts = sorted((np.array([*(middle + away * size[0] / 4), yaw]) for yaw in turns), key=badness)
    best, cost = starts[0], math.inf
    for begin in starts[:FOLLOWED]:
        then, new = solve(lambda p: _apart(kind, size, used, floor, p), begin, ROBUST, TRIES)
        if new < cost:
            best, cost = then, new
    if kind.handle:
        # Once more without the handle, which the profile does not have.
        own = used[~_beside(size, used, floor, best)]
        if len(own) > len(used) // 2:
            used = own
            best = solve(lambda p: _apart(kind, size, used, floor, p), best, ROBUST / 2, TRIES)[0]
    left = np.minimum(_apart(kind, size, used, floor, best)[0], 0.02)
    return Fit(float(best[0]), float(best[1]), math.remainder(float(best[2]), math.tau), float(left.mean()))


def fit_upside_down(kind: Kind, size: Vec3, points: Array, floor: float, camera: Array) -> Fit:
    """As `shapes.fit` for a shape that stands on its rim."""
    mirrored = points * (1.0, 1.0, -1.0) + (0.0, 0.0, 2 * floor + size[2])
    return shapes.fit(kind, size, mirrored, floor, camera)
