"""Where the base can stand, by the scene alone: clearance on the floor, and a standing pose before an object. Pure."""

import math
from collections.abc import Iterator

from common.approach import ROOM, Point, poses_for
from common.geometry import Pose2
from common.scene import Scene

WAY_COST = 0.15
"""What a metre of way adds to a pose's penalty [m/m]: the weight with which navigation compares its own poses."""


def clearance(scene: Scene, x: float, y: float) -> float:
    """Distance [m] from a point on the floor to the nearest wall, furniture or surface; 0 within one."""
    return min(_distances(scene, x, y), default=math.inf)


def standing_pose(scene: Scene, point: Point, here: Pose2) -> Pose2:
    """A pose (x, y, theta) [map] that faces the point (2,) from as near as the arm wants it, `here` is the robot's.

    It is in the point's room and has ROOM on the floor; where the scene leaves no such pose, the one with most room.
    """
    room = scene.room_at(*point)
    options = [
        (penalty + WAY_COST * math.dist(pose[:2], here[:2]), pose, clearance(scene, pose[0], pose[1]))
        for penalty, pose in poses_for(point, scene.surface_at(*point))
        if scene.room_at(pose[0], pose[1]) is room
    ]
    free = [(cost, pose) for cost, pose, space in options if space >= ROOM]
    if free:
        return min(free)[1]
    if options:
        return max(options, key=lambda option: option[2])[1]
    return min(poses_for(point, scene.surface_at(*point)))[1]


def place_pose(scene: Scene, name: str, here: Pose2) -> Pose2 | None:
    """The standing pose of a place, room or surface by name or alias; None for one that the scene does not have."""
    for place in (scene.home, *scene.places):
        if name == place.name or name in place.aliases:
            return place.x, place.y, place.theta
    for room in scene.rooms:
        if name == room.name or name in room.aliases:
            return (room.low[0] + room.high[0]) / 2, (room.low[1] + room.high[1]) / 2, 0.0
    receptacle = scene.receptacle(name)
    if receptacle is None:
        return None
    if receptacle.name == scene.delivery:
        return scene.home.x, scene.home.y, scene.home.theta
    return standing_pose(scene, (receptacle.center[0], receptacle.center[1]), here)


def _distances(scene: Scene, x: float, y: float) -> Iterator[float]:
    for wall in scene.walls:
        yield max(0.0, _to_segment(x, y, wall.start, wall.end) - wall.thickness / 2)
    for footprint in scene.footprints:
        yield footprint.distance(x, y)


def _to_segment(x: float, y: float, a: Point, b: Point) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    t = min(1.0, max(0.0, ((x - a[0]) * dx + (y - a[1]) * dy) / max(dx * dx + dy * dy, 1e-9)))
    return math.hypot(x - a[0] - t * dx, y - a[1] - t * dy)
