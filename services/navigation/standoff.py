"""Standing poses from which the arm reaches an object or a surface."""

import math

from common.geometry import Pose2
from common.scene import Receptacle
from services.navigation.costmap import BIN_WALL
from services.navigation.planner import Point

LATERAL = (0.0, 0.10, -0.10, 0.20, -0.20)
RING = 16


def _local(r: Receptacle, x: float, y: float) -> Point:
    c, s = math.cos(r.yaw), math.sin(r.yaw)
    return c * (x - r.center[0]) + s * (y - r.center[1]), c * (y - r.center[1]) - s * (x - r.center[0])


def poses_for(
    target: Point, receptacle: Receptacle | None, stand_off: float, edge_distance: float
) -> list[tuple[float, Pose2]]:
    """Candidate base poses that face `target`, each with a penalty [m] for how far from ideal it is.

    On a receptacle the base stands before one of its free edges, `edge_distance` off it at least; elsewhere on a ring.
    """
    x, y = target
    found: list[tuple[float, Pose2]] = []
    if receptacle is None or not receptacle.approach:
        for k in range(RING):
            a = 2 * math.pi * k / RING
            found.append((0.0, (x - stand_off * math.cos(a), y - stand_off * math.sin(a), a)))
        return found
    lx, ly = _local(receptacle, x, y)
    c, s = math.cos(receptacle.yaw), math.sin(receptacle.yaw)
    for ax, ay in receptacle.approach:
        edge = receptacle.size[0] / 2 if ax else receptacle.size[1] / 2
        inset = max(0.0, edge - (lx * ax + ly * ay))
        rim = BIN_WALL if receptacle.depth else 0.0
        distance = max(stand_off, inset + rim + edge_distance)
        ux, uy = c * ax - s * ay, s * ax + c * ay
        for side in LATERAL:
            bx, by = x + ux * distance - uy * side, y + uy * distance + ux * side
            theta = math.atan2(y - by, x - bx)
            far = max(0.0, math.hypot(distance, side) - stand_off - 0.04)
            found.append((4.0 * far + 1.5 * abs(side), (bx, by, theta)))
    return found
