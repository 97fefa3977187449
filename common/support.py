"""What a thing rests on, by the scene's geometry alone."""

import math

from common.scene import Receptacle, Scene

ON_TOP = 0.03
"""Height [m] of an underside above or below a surface that still counts as on it: a lying thing's hull, a rim."""
MARGIN = 0.02
"""Distance [m] beyond the edge of a surface that still counts as over it."""


def support(scene: Scene, x: float, y: float, bottom: float) -> str:
    """The receptacle that a thing with its underside at height `bottom` rests on or in; "" if none."""
    for r in scene.receptacles:
        if not inside(r, x, y):
            continue
        low, high = (-0.01, r.depth) if r.depth else (r.center[2] - ON_TOP, r.center[2] + ON_TOP)
        if low <= bottom <= high:
            return r.name
    return "floor" if bottom < ON_TOP else ""


def inside(r: Receptacle, x: float, y: float) -> bool:
    """True when a point is over the surface of a receptacle."""
    c, s = math.cos(r.yaw), math.sin(r.yaw)
    dx, dy = x - r.center[0], y - r.center[1]
    return abs(c * dx + s * dy) <= r.size[0] / 2 + MARGIN and abs(c * dy - s * dx) <= r.size[1] / 2 + MARGIN
