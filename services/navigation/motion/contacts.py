"""Detection of obstacles that no sensor sees, such as a pane of glass: the base is sent on and does not move, or the
arm presses on them."""

import math
from collections import deque
from itertools import pairwise

from common.geometry import Point, Pose2, wrap
from services.navigation.planning.costmap import Costmap

PUSHING = 1.2
"""Time [s] for which the base is sent on and does not move; chosen: several times what it takes to set out."""
MOVED, TURNED = 0.03, 0.1
"""Way [m] and turn [rad] from which on it moves; chosen: more than the play of the pose estimate."""
STOPPED = 0.3
"""Time [s] in which a base under way has not moved although it is sent on; chosen: from 0.2 m/s a base that brakes and
sets out again moves MOVED in less."""
FAST = 0.2
"""Speed [m/s] of a base that is under way; chosen: half of the usual one."""
ONWARD = 0.5
"""Least cosine of the angle between the way that the base came and the way it is sent [-]: who turns about stops."""
AWAY = 0.1
"""Distance [m] of a target from which on it has to move: a driver stops within some centimetres of one."""
SILENT = 0.2
"""Time [s] without a check after which the base was doing something else: four steps."""
RADIUS = 0.05
"""Of what was met [m]: a cell. The planner goes past it by the footprint."""
KEPT = 300.0
"""Time [s] for which it is remembered; chosen: longer than the way round, as nothing but another push tells that
it is gone."""


class UnseenObstacles:
    """Places [map] where something unseen has held the base up, kept in the costmap for some time.

    `felt`: the arm presses on something.
    """

    def __init__(self, costmap: Costmap, footprint: float) -> None:
        self._map, self._ahead = costmap, footprint + costmap.resolution / 2
        self._met: list[tuple[Point, float]] = []
        self._from: Pose2 = (math.inf, 0.0, 0.0)
        self._since = self._at = -math.inf
        self._trail: deque[tuple[float, Pose2]] = deque()
        self.felt = False

    def check(self, pose: Pose2, target: Pose2, now: float) -> Point | None:
        """The place [map] of what holds the base up, else None; call in each step with a free way to `target` [map]."""
        moved = math.dist(pose[:2], self._from[:2]) > MOVED or abs(wrap(pose[2] - self._from[2])) > TURNED
        way = math.dist(pose[:2], target[:2])
        if way < AWAY or now - self._at > SILENT:
            self._trail.clear()
            moved = True
        if moved:
            self._from, self._since = pose, now
        self._at = now
        self._trail.append((now, pose))
        if not (self.felt or now - self._since >= PUSHING or self._stopped_short(target, now)):
            return None
        self._trail.clear()
        self._since = now
        # One that turns on the spot has met it with the arm, which is before it.
        onward = math.atan2(target[1] - pose[1], target[0] - pose[0]) if way >= AWAY else pose[2]
        point = pose[0] + self._ahead * math.cos(onward), pose[1] + self._ahead * math.sin(onward)
        self._met.append((point, now))
        self._tell()
        return point

    def _stopped_short(self, target: Pose2, now: float) -> bool:
        """The base was under way in the direction in which it is sent, and all at once stays where it is."""
        while self._trail and self._trail[0][0] < now - 2 * STOPPED:
            self._trail.popleft()
        before = [pose for at, pose in self._trail if at <= now - STOPPED]
        if len(before) < 2 or self._trail[0][0] > now - 1.8 * STOPPED:
            return False
        (ax, ay, _), (bx, by, turned), (x, y, theta) = before[0], before[-1], self._trail[-1][1]
        came, leap = math.hypot(bx - ax, by - ay), max(math.dist(p[:2], q[:2]) for p, q in pairwise(before))
        # A pose that was corrected all at once says nothing of how the base moves.
        if came < FAST * STOPPED or leap > came / 2 or math.hypot(x - bx, y - by) > MOVED / 2:
            return False
        onward = (bx - ax) * (target[0] - x) + (by - ay) * (target[1] - y)
        far = came * math.hypot(target[0] - x, target[1] - y)
        return abs(wrap(theta - turned)) < TURNED and onward > ONWARD * far

    def interrupt(self) -> None:
        """Start measuring anew: the base is sent elsewhere, or it is not known whether it moves."""
        self._at = -math.inf

    def forget(self, now: float = math.inf) -> None:
        """Forget places met long before `now`; without it all places, for when the pose estimate has jumped."""
        kept = [(point, at) for point, at in self._met if now - at <= KEPT]
        if len(kept) != len(self._met):
            self._met = kept
            self._tell()

    def _tell(self) -> None:
        self._map.place([(*point, RADIUS) for point, _ in self._met], "unseen")
