"""The way the robot came, for going back a little."""

import math
from collections import deque

from common.geometry import Pose2
from services.navigation.costmap import Costmap
from services.navigation.planner import Point

STEP, LENGTH = 0.05, 40


class Trail:
    """The last two metres, a point every 5 cm."""

    def __init__(self) -> None:
        self._points: deque[Point] = deque(maxlen=LENGTH)

    def add(self, pose: Pose2) -> None:
        if not self._points or math.dist(self._points[-1], pose[:2]) > STEP:
            self._points.append((pose[0], pose[1]))

    def retreat(self, pose: Pose2, costmap: Costmap, radius: float, limit: float) -> Pose2:
        """The farthest point of the trail within `limit` that is free all the way; else where the robot stands."""
        here = best = (pose[0], pose[1])
        for point in reversed(self._points):
            if math.dist(point, here) > limit or costmap.line_clearance(here, point) < radius:
                break
            best = point
        return *best, pose[2]
