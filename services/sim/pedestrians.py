"""People who walk about: the social force model, with walls, furniture, each other and the robot to keep away from.

Sources: Helbing and Molnar, "Social force model for pedestrian dynamics", Physical Review E 51, 4282, 1995, its
constants with circles for ellipses; the range of walls is that of Helbing, Farkas and Vicsek, "Simulating dynamical
features of escape panic", Nature 407, 2000: with that of 1995 nobody gets through a door of 0.9 m.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from common.approach import FOOTPRINT
from common.geometry import Point, Rectangle
from common.scene import Obstacle

RELAXATION = 0.5
"""Time [s] in which somebody takes up the wanted velocity (tau)."""
REPULSION, REACH = 7.0, 0.3
"""Strength [m/s2] and range [m] of keeping away from others: V0 / sigma with V0 = 2.1 m2/s2, and sigma."""
WALL_REPULSION, WALL_REACH = 6.0, 0.08
"""The same of walls and furniture. The range is B of 2000; the strength is chosen: at the speeds of a home people keep
10 to 15 cm from what stands, where A / m = 25 m/s2 is for 1.5 m/s and makes them stop before doors."""
BEHIND = 0.5
"""How much what is behind somebody counts (c), and the half of their field of view [rad] (phi: 200 degrees)."""
VIEW = math.radians(100)
FASTEST = 1.3
"""Greatest speed, in wanted speeds."""
AT_POINT = 0.35
"""Distance [m] at which a point of the path counts as reached. Chosen: a stride's half."""
PATIENCE = (4.0, 5.5, 7.0)
"""Times [s] without getting nearer to the next point after which somebody turns round, one person's after the other's,
so that two who meet do not turn for ever at the same moment. Chosen."""
TO_THE_RIGHT = 0.35
"""Angle [rad] by which somebody evades to the right of what comes towards them. Chosen; people keep to a side, and
circles that meet head on would stand before each other for ever."""
TOUCH = 0.03
"""Gap [m] to the robot at which somebody does not step any nearer: people do not walk into what stands."""


class Pedestrian:
    """One person on a path to and fro. `place` [m]; `others` are those who walk in the same flat."""

    moves = True

    def __init__(self, obstacle: Obstacle, mocap: int, solids: Sequence[Rectangle]) -> None:
        self.obstacle, self.mocap = obstacle, mocap
        self._points = [obstacle.position, *obstacle.path]
        self._patience = PATIENCE[mocap % len(PATIENCE)]
        self._radius = max(obstacle.size[:2]) / 2
        self._solids = np.array(solids, float).reshape(-1, 5)
        self.others: list[Pedestrian] = []
        self.reset()

    def reset(self) -> None:
        """Return to the beginning of the path."""
        self.place: Point = self.obstacle.position
        self._velocity, self._clock = np.zeros(2), 0.0
        self._next, self._step = 1, 1
        self._nearest, self._nearest_at = math.inf, 0.0

    def advance(self, robot: Point, dt: float) -> bool:
        """Walk on by `dt` [s]; True when the person has moved."""
        self._clock += dt
        if self._clock < self.obstacle.start:
            return False
        wanted = self._way(robot)
        force = (wanted - self._velocity) / RELAXATION + self._from_solids()
        force += self._from(robot, FOOTPRINT, wanted)
        for other in self.others:
            if other is not self:
                force += self._from(other.place, other._radius, wanted)
        self._velocity += force * dt
        speed, most = float(np.hypot(*self._velocity)), FASTEST * self.obstacle.speed
        if speed > most:
            self._velocity *= most / speed
        x, y = (float(v) for v in np.array(self.place) + self._velocity * dt)
        gap = math.dist((x, y), robot) - self._radius - FOOTPRINT
        if gap < TOUCH and math.dist((x, y), robot) < math.dist(self.place, robot):
            self._velocity[:] = 0.0
            return False
        self.place = x, y
        return True

    def _way(self, robot: Point) -> NDArray[np.float64]:
        """The velocity [m/s] that the person wants: to the next point, and back when that cannot be reached."""
        goal = self._points[self._next]
        distance = math.dist(goal, self.place)
        if distance < self._nearest - 0.05:
            self._nearest, self._nearest_at = distance, self._clock
        given_up = self._clock - self._nearest_at > self._patience
        if distance < AT_POINT or given_up:
            if given_up or not 0 <= self._next + self._step < len(self._points):
                self._step = -self._step
            self._next = min(max(self._next + self._step, 0), len(self._points) - 1)
            self._nearest, self._nearest_at = math.inf, self._clock
            goal = self._points[self._next]
            distance = math.dist(goal, self.place)
        away = np.array(goal) - self.place
        return away * (self.obstacle.speed / max(distance, 1e-6))

    def _from(self, place: Point, radius: float, wanted: NDArray[np.float64]) -> NDArray[np.float64]:
        """How somebody or the robot at `place` pushes [m/s2]."""
        away = np.array(self.place) - place
        distance = float(np.hypot(*away))
        gap = distance - radius - self._radius
        if gap > 8 * REACH or distance < 1e-6:
            return np.zeros(2)
        towards = -float(away @ wanted) / (distance * max(float(np.hypot(*wanted)), 1e-6))
        seen = 1.0 if towards >= math.cos(VIEW) else BEHIND
        turn = TO_THE_RIGHT if towards > 0.0 else 0.0
        c, s = math.cos(turn), math.sin(turn)
        push = seen * REPULSION * math.exp(-gap / REACH) / distance
        return np.array([c * away[0] - s * away[1], s * away[0] + c * away[1]]) * push

    def _from_solids(self) -> NDArray[np.float64]:
        """How walls and furniture push [m/s2]."""
        if not len(self._solids):
            return np.zeros(2)
        x, y, length, width, yaw = self._solids.T
        c, s = np.cos(yaw), np.sin(yaw)
        dx, dy = self.place[0] - x, self.place[1] - y
        u, v = c * dx + s * dy, c * dy - s * dx
        out_u = u - np.clip(u, -length / 2, length / 2)
        out_v = v - np.clip(v, -width / 2, width / 2)
        apart = np.maximum(np.hypot(out_u, out_v), 1e-6)
        push = WALL_REPULSION * np.exp(-(apart - self._radius) / WALL_REACH) / apart
        return np.array([push @ (c * out_u - s * out_v), push @ (s * out_u + c * out_v)])
