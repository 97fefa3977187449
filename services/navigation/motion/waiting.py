"""Waiting while the path is blocked or there is none: what the robot waits for, and when that has lasted too long."""

import math
from collections.abc import Sequence

from common.geometry import Pose2
from services.navigation.config import NavigationConfig
from services.navigation.motion.obstacle_tracker import Obstacle
from services.navigation.motion.progress import CLOSE, PERSON, BlockedTimer, Progress, anybody_near, waiting_for
from services.navigation.motion.recovery import Recovery
from services.navigation.motion.route import Blocker
from services.navigation.planning.costmap import Costmap


class Waiting:
    """The waiting of one goal. `robots`: circles (x, y, radius) [map, m] of robots about to make way; `patience`: how
    long who may be people are waited for [s]."""

    def __init__(
        self, config: NavigationConfig, costmap: Costmap, progress: Progress, recovery: Recovery, patience: float
    ) -> None:
        self._limit, self._map, self._progress, self._recovery = config.blocked_wait, costmap, progress, recovery
        self._timer = BlockedTimer(patience)
        self._blocker: Blocker = "things"
        self.robots: Sequence[tuple[float, float, float]] = ()

    @property
    def for_people(self) -> bool:
        """True when only people block the way."""
        return self._blocker == "people"

    def on_blocked_path(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> str:
        """Call in each step in which the path is blocked; returns what the robot does (`Navigator.doing`)."""
        self._progress.restart_clock(now)
        somebody = self._map.people_pass or anybody_near((pose[0], pose[1]), people)
        self._blocker = "people" if somebody else "things"
        return self._before(pose, people, now, by_people=False)

    def without_path(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> str:
        """Call in each step in which there is no path to the goal; returns what the robot does (`Navigator.doing`)."""
        doing = self._before(pose, people, now, self.for_people)
        if self._blocker == "newcomers":
            self._progress.extend(now)
        return doing

    def note_blocker(self, blocker: Blocker) -> None:
        """Note what kind of obstacle leaves no path to the goal."""
        self._blocker = blocker
        self._map.let_people_pass(self.for_people and self._recovery.stands_its_ground)

    def _before(self, pose: Pose2, people: Sequence[Obstacle], now: float, by_people: bool) -> str:
        """ROBOT_IN_WAY, PERSON_IN_WAY or WAITING by what is near; makes room for a person who waits for the robot."""
        if any(math.dist(pose[:2], (x, y)) < CLOSE + radius for x, y, radius in self.robots):
            self._progress.extend(now)
            self._timer.clear()
            return "ROBOT_IN_WAY"
        doing = waiting_for((pose[0], pose[1]), people, by_people)
        if doing == PERSON:
            self._progress.extend(now)
            self._recovery.let_pass(pose, people, now)
        return doing

    def too_long(self, now: float) -> bool:
        """True when the robot has waited too long; call in each step after `on_blocked_path` or `without_path`."""
        return self._timer.blocked(self._blocker != "things", now) > self._limit

    def end(self) -> None:
        """End the waiting: the path is free, or another one is tried."""
        self._timer.clear()
