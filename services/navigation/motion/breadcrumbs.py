"""The last two metres that the base has driven, for going back a little."""

import math
from collections import deque

from common.geometry import Point, Pose2
from services.navigation.planning.costmap import Costmap

SPACING = 0.05
"""Distance between two points [m]; chosen: the costmap's resolution."""
COUNT = 40
"""Points that are kept [count]: the last 2 m, four times `navigation.back_off`."""


class Breadcrumbs:
    """Keeps the last points [map] where the base has been."""

    def __init__(self) -> None:
        self._points: deque[Point] = deque(maxlen=COUNT)

    def add(self, pose: Pose2) -> None:
        """Note where the robot is."""
        if not self._points or math.dist(self._points[-1], pose[:2]) > SPACING:
            self._points.append((pose[0], pose[1]))

    def retreat(self, pose: Pose2, costmap: Costmap, radius: float, limit: float) -> Pose2:
        """The farthest point within `limit` [m] to which a disc of `radius` [m] can go back; else where it stands."""
        here = best = (pose[0], pose[1])
        for point in reversed(self._points):
            if math.dist(point, here) > limit or costmap.line_clearance(here, point) < radius:
                break
            best = point
        return *best, pose[2]
