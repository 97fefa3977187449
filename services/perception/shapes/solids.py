"""Convex solids on a surface by their corners, from which follows how far they reach in a picture. Pure."""

import math
from collections.abc import Callable

import numpy as np

from common.geometry import Array

CIRCLE, SPHERE = 24, 200
"""Corners that stand for a circle and for a sphere: 0.4 and 1 % smaller at most."""
CIRCLES = np.stack([np.cos(np.arange(CIRCLE) * math.tau / CIRCLE), np.sin(np.arange(CIRCLE) * math.tau / CIRCLE)], 1)
# Parameters (k,) to corners (n, 3) in frame map.
Corners = Callable[[Array], Array]


def turned(floor: float) -> Corners:
    """A truncated cone on its foot: p = (x, y, radius below, radius above, height)."""

    def corners(p: Array) -> Array:
        low, high = np.full((CIRCLE, 1), floor), np.full((CIRCLE, 1), floor + abs(p[4]))
        below = np.hstack([p[:2] + CIRCLES * p[2], low])
        return np.concatenate([below, np.hstack([p[:2] + CIRCLES * p[3], high])])

    return corners


def ball(floor: float) -> Corners:
    """A ball on the surface: p = (x, y, radius)."""
    z = 1.0 - (2 * np.arange(SPHERE) + 1) / SPHERE
    turn, flat = np.arange(SPHERE) * math.pi * (3.0 - math.sqrt(5.0)), np.sqrt(1.0 - z * z)
    unit = np.stack([flat * np.cos(turn), flat * np.sin(turn), z], 1)

    def corners(p: Array) -> Array:
        return np.asarray(unit * p[2] + (p[0], p[1], floor + p[2]))

    return corners


def box(floor: float) -> Corners:
    """A box that stands: p = (x, y, yaw, length, width, height)."""
    signs = np.array([(a, b, c) for a in (-0.5, 0.5) for b in (-0.5, 0.5) for c in (0.0, 1.0)])

    def corners(p: Array) -> Array:
        local, (c, s) = signs * p[3:], (math.cos(p[2]), math.sin(p[2]))
        x, y = c * local[:, 0] - s * local[:, 1], s * local[:, 0] + c * local[:, 1]
        return np.stack([p[0] + x, p[1] + y, floor + local[:, 2]], axis=1)

    return corners


def lying(floor: float) -> Corners:
    """A cylinder on its side: p = (x, y, yaw of the axis, radius, length)."""

    def corners(p: Array) -> Array:
        c, s = math.cos(p[2]), math.sin(p[2])
        across, up = CIRCLES[:, 0] * p[3], floor + p[3] + CIRCLES[:, 1] * p[3]
        ends = [
            np.stack([p[0] + e * c * p[4] - s * across, p[1] + e * s * p[4] + c * across, up], axis=1)
            for e in (-0.5, 0.5)
        ]
        return np.concatenate(ends)

    return corners
