"""Where the base can stand before an object, by the floor plan. Pure."""

import math
from collections.abc import Sequence

from common.approach import ROOM, WAY_COST, clearance, delivers_at_home, poses_for
from common.floor_plan import FloorPlan
from common.furniture_tops import support_at
from common.geometry import Point, Pose2, wrap

DIRECTIONS = 24
"""Directions around the object that are tried."""
DISTANCES = (0.55, 0.65, 0.75, 0.85, 0.95)
"""Distances [m] of the base from the object; from further away small print is not read."""
FARTHEST = DISTANCES[-1]
"""Distance [m] of the base from an object up to which its print is read from where the robot stands."""
APART = 0.6
"""Angle [rad] to the directions from which it was seen that shows another side. Chosen: a third of what a can shows."""


def standing_pose(floor_plan: FloorPlan, point: Point, here: Pose2) -> Pose2:
    """A pose (x, y, theta) [map] that faces the point (2,) from as near as the arm wants it, `here` is the robot's.

    It is in the point's room and has ROOM on the floor; where the plan leaves no such pose, the one with most room.
    """
    room = floor_plan.room_at(*point)
    options = [
        (penalty + WAY_COST * math.dist(pose[:2], here[:2]), pose, clearance(floor_plan, pose[0], pose[1]))
        for penalty, pose in poses_for(point, support_at(floor_plan, *point))
        if floor_plan.room_at(pose[0], pose[1]) is room
    ]
    free = [(cost, pose) for cost, pose, space in options if space >= ROOM]
    if free:
        return min(free)[1]
    if options:
        return max(options, key=lambda option: option[2])[1]
    return min(poses_for(point, support_at(floor_plan, *point)))[1]


def place_pose(floor_plan: FloorPlan, name: str, here: Pose2) -> Pose2 | None:
    """The standing pose of a place, room or surface by name or alias; None for one that the plan does not have."""
    for place in (floor_plan.home, *floor_plan.places):
        if name == place.name or name in place.aliases:
            return place.x, place.y, place.theta
    for room in floor_plan.rooms:
        if name == room.name or name in room.aliases:
            return *room.middle, 0.0
    receptacle = floor_plan.receptacle(name)
    if receptacle is None:
        return None
    if receptacle.name == floor_plan.delivery and delivers_at_home(floor_plan):
        return floor_plan.home.x, floor_plan.home.y, floor_plan.home.theta
    return standing_pose(floor_plan, (receptacle.center[0], receptacle.center[1]), here)


# --- where the base can stand to see another side of an object, by the floor plan
def reading_pose(
    floor_plan: FloorPlan,
    point: Point,
    here: Pose2,
    seen_from: Sequence[float],
    distances: Sequence[float] = DISTANCES,
) -> Pose2 | None:
    """A pose (x, y, theta) [map] that faces the point (2,), APART from the directions [rad] from there to where it was
    seen from, near it and near `here`; None where the plan leaves no room for one in the point's room at one of the
    `distances` [m]."""
    room = floor_plan.room_at(*point)
    options: list[tuple[float, Pose2]] = []
    for k in range(DIRECTIONS):
        angle = math.tau * k / DIRECTIONS
        if not shows_another_side(angle, seen_from):
            continue
        for distance in distances:
            x, y = point[0] + distance * math.cos(angle), point[1] + distance * math.sin(angle)
            if floor_plan.room_at(x, y) is room and clearance(floor_plan, x, y) >= ROOM:
                cost = distance + WAY_COST * math.dist((x, y), here[:2])
                options.append((cost, (x, y, wrap(angle + math.pi))))
                break
    return min(options)[1] if options else None


def shows_another_side(angle: float, seen_from: Sequence[float]) -> bool:
    """Whether a direction [rad] is APART from all those that an object was seen from."""
    return all(abs(wrap(angle - seen)) >= APART for seen in seen_from)
