"""Things on the floor that perception has reported and the lidar looks over, as circles in the costmap."""

import math
from collections import deque
from collections.abc import Sequence

import numpy as np

from common import messages as m
from common.geometry import Array
from services.navigation.planning.costmap import Costmap

ON_FLOOR = 0.05
"""Height [m] of an object's lower side up to which it is on the floor: a rug, and the error of what was measured."""
AROUND = 0.1
"""Distance [m] from an object's circle up to which what the lidar saw is a part of it: the error of both, and what
somebody who walks moves on in PICTURE."""
PICTURE = 0.2
"""Time [s] between a picture and the scans that are held against it, at most: two scans."""
LATE = 4.0
"""Time [s] after its picture within which an object is reported; chosen: several times what perception takes."""
UNSEEN = 1.0
"""Distance [m] from the robot within which its head camera may not see a thing on the floor again before the base is
upon it: the picture begins 0.45 m before its middle, and only where it looks."""


class LowThings:
    """Enters low things in a costmap as circles.

    Where the lidar saw something when the picture was taken, as it does of legs of which only the feet are in the
    picture, the circle goes when the lidar no longer sees anything there.
    """

    def __init__(self, costmap: Costmap) -> None:
        self._map = costmap
        self._scans: deque[tuple[float, Array]] = deque()
        self._tall: dict[str, tuple[float, bool]] = {}

    def see(self, points: Array, now: float) -> None:
        """Take the points (n, 2) [map] of a scan that the map does not explain."""
        self._scans.append((now, points))
        while self._scans[0][0] < now - LATE:
            self._scans.popleft()

    def place(self, objects: Sequence[m.WorldObject]) -> None:
        """Enter the reported objects that are on the floor, except those not seen since the costmap was doubted from
        so far off that they would be seen again on the way there."""
        lying = [o for o in objects if not o.held and o.position[2] - o.size[2] / 2 < ON_FLOOR]
        self._tall = {o.label: self._judged(o) for o in lying}
        circles = [_circle(o) for o in lying if self._believed(o) and self._stands(o)]
        self._map.place(sorted(circles), "floor")

    def _judged(self, o: m.WorldObject) -> tuple[float, bool]:
        """When an object was seen last, and whether the lidar saw something there then."""
        known = self._tall.get(o.label)
        if known is not None and known[0] == o.seen_at:
            return known
        x, y, radius = _circle(o)
        around = [points for at, points in self._scans if abs(at - o.seen_at) <= PICTURE]
        near = any((np.hypot(points[:, 0] - x, points[:, 1] - y) < radius + AROUND).any() for points in around)
        return o.seen_at, near

    def _believed(self, o: m.WorldObject) -> bool:
        seen = self._map.obstacles
        return o.seen_at > seen.doubted or math.dist(o.position[:2], seen.doubted_at) < UNSEEN

    def _stands(self, o: m.WorldObject) -> bool:
        x, y, radius = _circle(o)
        return not self._tall[o.label][1] or self._map.obstacles.seen_in((x, y, radius + AROUND))


def _circle(o: m.WorldObject) -> tuple[float, float, float]:
    return o.position[0], o.position[1], math.hypot(o.size[0], o.size[1]) / 2
