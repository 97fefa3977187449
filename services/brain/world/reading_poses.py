"""Where the base can stand to see another side of an object, by the floor plan. Pure."""

import math
from collections.abc import Sequence

from common.approach import ROOM, Point, clearance
from common.floor_plan import FloorPlan
from common.geometry import Pose2, wrap
from services.brain.world.standing_poses import WAY_COST

DIRECTIONS = 24
"""Directions around the object that are tried."""
DISTANCES = (0.55, 0.65, 0.75, 0.85, 0.95)
"""Distances [m] of the base from the object; from further away small print is not read."""
FARTHEST = DISTANCES[-1]
"""Distance [m] of the base from an object up to which its print is read from where the robot stands."""
APART = 0.6
"""Angle [rad] to the directions from which it was seen that shows another side. Chosen: a third of what a can shows."""


def reading_pose(floor_plan: FloorPlan, point: Point, here: Pose2, seen_from: Sequence[float]) -> Pose2 | None:
    """A pose (x, y, theta) [map] that faces the point (2,), APART from the directions [rad] from there to where it was
    seen from, near it and near `here`; None where the plan leaves no room for one in the point's room."""
    room = floor_plan.room_at(*point)
    options: list[tuple[float, Pose2]] = []
    for k in range(DIRECTIONS):
        angle = math.tau * k / DIRECTIONS
        if not shows_another_side(angle, seen_from):
            continue
        for distance in DISTANCES:
            x, y = point[0] + distance * math.cos(angle), point[1] + distance * math.sin(angle)
            if floor_plan.room_at(x, y) is room and clearance(floor_plan, x, y) >= ROOM:
                cost = distance + WAY_COST * math.dist((x, y), here[:2])
                options.append((cost, (x, y, wrap(angle + math.pi))))
                break
    return min(options)[1] if options else None


def shows_another_side(angle: float, seen_from: Sequence[float]) -> bool:
    """Whether a direction [rad] is APART from all those that an object was seen from."""
    return all(abs(wrap(angle - seen)) >= APART for seen in seen_from)
