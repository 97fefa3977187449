"""Where the base can stand before an object, by the floor plan. Pure."""

import math

from common.approach import ROOM, Point, clearance, delivers_at_home, poses_for
from common.floor_plan import FloorPlan
from common.geometry import Pose2

WAY_COST = 0.15
"""What a metre of way adds to a pose's penalty [m/m]: the weight with which navigation compares its own poses."""


def standing_pose(floor_plan: FloorPlan, point: Point, here: Pose2) -> Pose2:
    """A pose (x, y, theta) [map] that faces the point (2,) from as near as the arm wants it, `here` is the robot's.

    It is in the point's room and has ROOM on the floor; where the plan leaves no such pose, the one with most room.
    """
    room = floor_plan.room_at(*point)
    options = [
        (penalty + WAY_COST * math.dist(pose[:2], here[:2]), pose, clearance(floor_plan, pose[0], pose[1]))
        for penalty, pose in poses_for(point, floor_plan.support_at(*point))
        if floor_plan.room_at(pose[0], pose[1]) is room
    ]
    free = [(cost, pose) for cost, pose, space in options if space >= ROOM]
    if free:
        return min(free)[1]
    if options:
        return max(options, key=lambda option: option[2])[1]
    return min(poses_for(point, floor_plan.support_at(*point)))[1]


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
