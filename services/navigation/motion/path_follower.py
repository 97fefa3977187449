"""Path follower: pure pursuit for a holonomic base, with a heading and a brake for what the lidar sees.

Source of pure pursuit: Coulter, "Implementation of the pure pursuit path tracking algorithm", CMU-RI-TR-92-01, 1992.
"""

import math
from dataclasses import dataclass

import numpy as np

from common.geometry import Array, Point, Pose2, wrap
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import SPACING

TURN_AT = 0.9
"""Path left from which on the base turns to the goal's heading [m]; chosen: so that it faces there on arrival."""
SLOW_TURN = 0.6
"""Turn from which on the base slows down [rad]; chosen: beyond it the base would drive sideways."""
MIN_STEP, TURNING_STEP = 0.08, 0.2
"""Least and greatest distance of the target while it turns [m]; chosen: the base keeps moving slowly."""
WINDOW = 40
"""Points ahead among which the nearest is looked for [count]: 2 m, so that progress does not jump to a later bend."""
KEEP = 0.10
"""Distance kept from the lidar point that stops it [m]; chosen: for the lidar's noise and delay."""
STOPPED = 0.05
"""A target this near is none: the path is blocked [m]; chosen: the play of the pose estimate."""
OFF = 1.0
"""Distance from the path that counts towards what is left, at most [m]."""
SLACK = 0.03
"""How much closer to a wall than it stands the base may come on the way back to its path [m]: half a cell."""


@dataclass(frozen=True)
class Lookahead:
    """The target pose [map]; `final`: it is the goal, `blocked`: something stands before it; `remaining` path [m].

    `strayed`: it has been led off the path, and furniture or a wall of the map is between.
    """

    pose: Pose2
    final: bool
    blocked: bool
    remaining: float
    strayed: bool = False


class PathFollower:
    """Follows one path, `lookahead` [m] before the robot; progress along it never goes back.

    `corridor` is the half width [m] that must be free of lidar points.
    """

    def __init__(self, path: list[Point], goal: Pose2, lookahead: float, corridor: float) -> None:
        self.path, self.goal = path, goal
        self._points = np.array(path)
        self._lookahead, self._corridor = lookahead, corridor
        self._index = 0

    def remaining(self, pose: Pose2) -> float:
        """Metres of path left."""
        ahead = len(self.path) - 1 - self._index
        off = math.hypot(self.path[self._index][0] - pose[0], self.path[self._index][1] - pose[1])
        return ahead * SPACING + min(off, OFF)

    def left(self) -> list[Point]:
        """The points [map] that lie ahead."""
        return self.path[self._index :]

    def blocked_at(self, pose: Pose2, costmap: Costmap, radius: float) -> float | None:
        """Metres along the path to where it comes closer than `radius` to something seen; None when it does not."""
        ahead = self._points[self._index + 1 :]
        near = np.hypot(ahead[:, 0] - pose[0], ahead[:, 1] - pose[1]) < radius
        close = costmap.seen_within(ahead, radius) & ~near
        return float(np.argmax(close) + 1) * SPACING if close.any() else None

    def ahead(self, distance: float) -> Point:
        """The point `distance` [m] on along the path, at most its end."""
        return self.path[min(len(self.path) - 1, self._index + round(distance / SPACING))]

    def step(self, pose: Pose2, costmap: Costmap, radius: float, points: Array | None) -> Lookahead:
        """The next target; `points` (n, 2) [map] is what the lidar sees now."""
        window = self._points[self._index : self._index + WINDOW]
        self._index += int(np.argmin(np.hypot(window[:, 0] - pose[0], window[:, 1] - pose[1])))
        remaining = self.remaining(pose)
        near_end = remaining < TURN_AT
        reach = min(len(self.path) - 1, self._index + round(self._lookahead / SPACING))
        here = (pose[0], pose[1])
        while reach > self._index + 2 and costmap.line_clearance(here, self.path[reach]) < radius - 0.005:
            reach -= 2
        target = self.path[reach]
        if _shut_off(here, target, costmap, radius):
            return Lookahead(pose, False, False, remaining, strayed=True)
        heading = self.goal[2] if near_end else math.atan2(target[1] - pose[1], target[0] - pose[0])
        turn = abs(wrap(heading - pose[2]))
        final = reach == len(self.path) - 1
        if turn > SLOW_TURN and not near_end:
            target = _towards(here, target, max(MIN_STEP, TURNING_STEP * math.cos(min(turn, math.pi / 2))))
            final = False
        stop, short = braked(here, target, points, self._corridor)
        if short:
            blocked = math.dist(here, stop) < STOPPED
            return Lookahead((*stop, heading), False, blocked, remaining)
        pose_to = self.goal if final else (target[0], target[1], heading)
        return Lookahead(pose_to, final, False, remaining)


def _shut_off(here: Point, target: Point, costmap: Costmap, radius: float) -> bool:
    """Furniture or a wall of the map is nearer to the straight way to `target` than to where the base stands."""
    fixed = costmap.static_distance
    stands = float(fixed[costmap.cell(*here)])
    return costmap.line_clearance(here, target, fixed) < min(radius - 0.005, stands - SLACK)


def braked(here: Point, target: Point, points: Array | None, corridor: float) -> tuple[Point, bool]:
    """How far towards `target` the base may go for what the lidar sees, and whether that is short of it."""
    free = _room(here, target, points, corridor)
    if free >= math.dist(here, target):
        return target, False
    return _towards(here, target, max(0.0, free - KEEP)), True


def _room(here: Point, target: Point, points: Array | None, corridor: float) -> float:
    """How far [m] the base can go towards `target` before lidar `points` (n, 2) come into a corridor of that half
    width [m]; inf when there are none."""
    length = math.hypot(target[0] - here[0], target[1] - here[1])
    if points is None or not len(points) or length < 1e-6:
        return math.inf
    ux, uy = (target[0] - here[0]) / length, (target[1] - here[1]) / length
    x, y = points[:, 0] - here[0], points[:, 1] - here[1]
    along, across = x * ux + y * uy, np.abs(y * ux - x * uy)
    ahead = (along > 0) & (across < corridor)
    if not ahead.any():
        return math.inf
    touch = along[ahead] - np.sqrt(np.maximum(corridor**2 - np.square(across[ahead]), 0.0))
    return float(max(0.0, touch.min()))


def _towards(here: Point, target: Point, distance: float) -> Point:
    """The point `distance` [m] from `here` on the way to `target`, which is the farthest."""
    length = math.hypot(target[0] - here[0], target[1] - here[1])
    if length <= distance or length < 1e-9:
        return target
    return here[0] + (target[0] - here[0]) * distance / length, here[1] + (target[1] - here[1]) * distance / length
