"""The two motions of a recovery: a little back the way the robot came, or to a place where a person gets past it."""

import math
from collections.abc import Sequence

import numpy as np

from common.geometry import Array, Point, Pose2
from services.navigation.motion.obstacle_tracker import Obstacle
from services.navigation.motion.path_follower import PathFollower, braked
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

ROOM, APART, ASIDE = 0.9, 2.5, 1.0
"""Clearance, distance from the person, and distance from the line on which the person comes [m] beyond which more is no
better; chosen: a person and a step."""
PER_APART, PER_ASIDE, PER_METRE = 0.4, 0.3, 0.15
"""What a metre of each, and of the way there, is worth against one of clearance [-]; chosen: room counts most."""
FARTHEST = 4.0
"""Cost of the way to a passing place [m] at most: some two or three metres."""
LEAST = 0.15
"""How much better than here a passing place has to be [m]; chosen: else it would only fidget."""
GOING, STAYING = 6.0, 5.0
"""Time to get to a passing place [s], and for which it is left to a person to pass [s]."""
PASSED = 0.8
"""Way after which a person is no longer where they were [m]."""
AT = 0.1
"""Distance at which the robot is there [m]."""


class Retreat:
    """A motion back to the pose `back` [map] that lasts until robot time `until` [s]."""

    def __init__(self, back: Pose2, until: float, corridor: float) -> None:
        self._back, self._until, self._corridor = back, until, corridor

    def over(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> bool:
        """True when the time is up: another path should be planned."""
        return now >= self._until

    def step(self, pose: Pose2, points: Array | None) -> Pose2:
        """The next target, as far as the lidar sees nothing there; `points` (n, 2) [map]."""
        x, y, theta = self._back
        target, _ = braked((pose[0], pose[1]), (x, y), points, self._corridor)
        return (*target, theta)


class PassingPlace:
    """A motion along `follower`'s path to where a person gets past; `person` [map]: where they stood at first."""

    def __init__(self, follower: PathFollower, person: Point, costmap: Costmap, radius: float, now: float) -> None:
        self._follower, self._person, self._map = follower, person, costmap
        self._radius, self._until = radius, now + GOING
        self._there = False

    def over(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> bool:
        """True when the person has gone on, or has not done so in time."""
        if not self._there and math.dist(pose[:2], self._follower.goal[:2]) < AT:
            self._there, self._until = True, now + STAYING
        near = any(math.dist((p.x, p.y), self._person) < PASSED for p in people)
        return now >= self._until or (self._there and not near)

    def step(self, pose: Pose2, points: Array | None) -> Pose2:
        """The next target; `points` (n, 2) [map] is what the lidar sees."""
        return self._follower.step(pose, self._map, self._radius, points).pose


def passing_place(pose: Pose2, person: Point, costmap: Costmap, planner: PathPlanner) -> list[Point] | None:
    """The path to the place nearby with the most room for a person to pass; None when none is better than here."""
    field = planner.field(pose[0], pose[1])
    rows, columns = np.nonzero(field.cost < FARTHEST)
    if not len(rows):
        return None
    xs = costmap.origin[0] + (columns + 0.5) * costmap.resolution
    ys = costmap.origin[1] + (rows + 0.5) * costmap.resolution
    toward = np.array([pose[0] - person[0], pose[1] - person[1]])
    ux, uy = toward / max(float(np.hypot(*toward)), 1e-6)
    dx, dy = xs - person[0], ys - person[1]
    worth = (
        np.minimum(costmap.distance[rows, columns], ROOM)
        + PER_APART * np.minimum(np.hypot(dx, dy), APART)
        + PER_ASIDE * np.minimum(np.abs(ux * dy - uy * dx), ASIDE)
        - PER_METRE * field.cost[rows, columns]
    )
    here = float(worth[np.argmin(np.square(xs - pose[0]) + np.square(ys - pose[1]))])
    best = int(np.argmax(worth))
    if worth[best] < here + LEAST:
        return None
    return planner.path(field, (pose[0], pose[1]), (float(xs[best]), float(ys[best])))
