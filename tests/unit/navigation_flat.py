"""A flat without physics for tests of navigation: a base that goes where it is told, a lidar by the slab method."""

import math
from pathlib import Path

import msgspec
import numpy as np

from common import messages as m
from common import topics
from common.geometry import Pose2, Rectangle, compose, inverse, wrap
from common.household import Household, load_household
from services.navigation.config import NavigationConfig
from services.navigation.localisation.distance_field import rectangles
from services.navigation.service import NavigationService
from tests.node import Node

SCENE = load_household("apartment")
ANGLES = -math.pi + np.arange(360) * math.radians(1)
SPEED, TURN, BUMPER = 0.5, 1.5, 0.28


def cast(pose: Pose2, boxes: list[Rectangle]) -> np.ndarray:
    """Ranges (360,) to rectangles, an oracle beside the distance field; 11: nothing hit."""
    x, y, sx, sy, yaw = np.array(boxes).T[:, :, None]
    c, s = np.cos(yaw), np.sin(yaw)
    dx, dy, a = pose[0] - x, pose[1] - y, (ANGLES + pose[2])[None, :]
    start = np.stack([c * dx + s * dy, c * dy - s * dx])
    way = np.stack([np.cos(a - yaw), np.sin(a - yaw)])
    way[np.abs(way) < 1e-9] = 1e-9
    half = np.stack([sx, sy]) / 2
    one, two = (-half - start) / way, (half - start) / way
    enters, leaves = np.minimum(one, two).max(axis=0), np.maximum(one, two).min(axis=0)
    hit = (enters < leaves) & (enters > 0)
    return np.where(hit, enters, 11.0).min(axis=0)


def ends(ranges: np.ndarray) -> np.ndarray:
    hit = ranges < 10.0
    return np.stack([np.cos(ANGLES[hit]), np.sin(ANGLES[hit])], 1) * ranges[hit, None]


class Flat(Node):
    """The navigation service in the apartment; `boxes` is what its map does not have, of `glass` what nothing sees too,
    `wheels` its odometry, `mute`: neither that nor scans are reported."""

    def __init__(
        self,
        boxes: list[Rectangle] | None = None,
        household: Household = SCENE,
        state_dir: Path | None = None,
        **parameters: object,
    ) -> None:
        self.boxes, self.glass = boxes or [], list[Rectangle]()
        config = msgspec.convert(parameters, NavigationConfig)
        super().__init__(NavigationService, config, household, state_dir=state_dir)
        self.feedbacks = self.bus.tap(topics.NAVIGATION_FEEDBACK)
        self._targets = self.bus.tap(topics.BASE_TARGET)
        self._stops = self.bus.tap(topics.CMD_VEL)
        self._plan = rectangles(household, 0.2)
        self.true: Pose2 = (0.0, 0.0, 0.0)
        self.wheels: Pose2 = (0.0, 0.0, 0.0)
        self.mute = False
        self._target: m.BaseTarget | None = None
        self._reached = ""
        self.closest = math.inf

    def feed(self) -> None:
        """50 ms: the base moves, the sensors report."""
        self._drive(0.05)
        x, y, theta = self.wheels
        if self.mute:
            return
        self.bus.send(topics.ODOMETRY, m.Odometry(t=self.now, x=x, y=y, theta=theta))
        if self.tick % 10 == 0:
            ranges = cast(self.true, self._plan + self.boxes)
            seen = ranges[ranges < 10.0]
            self.closest = min(self.closest, float(seen.min()))
            self.bus.send(topics.SCAN, m.LaserScan(t=self.now, ranges=ranges.astype("<f4").tobytes()))

    def _drive(self, dt: float) -> None:
        for payload in self._targets:
            self._target = msgspec.json.decode(payload, type=m.BaseTarget)
        if self._stops:
            self._target = None
        self._targets.clear()
        self._stops.clear()
        if self._target is None:
            return
        dx, dy, turn = compose(inverse(self.wheels), (self._target.x, self._target.y, self._target.theta))
        length = math.hypot(dx, dy)
        share = min(1.0, SPEED * dt / length) if length else 0.0
        step = dx * share, dy * share, max(-TURN * dt, min(TURN * dt, turn))
        there = compose(self.true, step)
        if any(pane.distance(*there[:2]) < BUMPER for pane in self.glass):
            return
        self.true, self.wheels = there, compose(self.wheels, (step[0], step[1], step[2] + 1e-4))
        done = length * (1 - share) < 0.02 and abs(wrap(turn - step[2])) < 0.05
        if done and self._reached != self._target.id:
            self._reached = self._target.id
            self.bus.send(topics.GOAL_REACHED, m.GoalReached(reached=True, target_id=self._target.id))

    def ask(self, text: str, goal_id: str = "a.1") -> None:
        self.bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=text, id=goal_id))
        self.step()

    def finish(self, seconds: float) -> m.NavigationStatus:
        """Step until the goal has ended, or for so long."""
        until = self.now + seconds
        while self.now < until and self.status().status == "navigating":
            self.step()
        return self.status()

    def status(self) -> m.NavigationStatus:
        return self.last(topics.NAVIGATION_STATUS)

    def feedback(self) -> m.NavigationFeedback:
        return self.last(topics.NAVIGATION_FEEDBACK)
