"""One goal under way: choose a pose, plan, follow, wait out or go around what blocks, give up in time."""

import math

from common import messages as m
from common.geometry import Pose2
from services.navigation.config import NavigationConfig
from services.navigation.costmap import Array, Costmap
from services.navigation.follow import Follower
from services.navigation.planner import PathPlanner, Point

REPLAN_PERIOD = 1.0
FEEDBACK_PERIOD = 1.0
PROGRESS = 0.05
BACK_OFF = 0.25


class Ended(Exception):
    """The goal has ended with this status, code and detail."""

    def __init__(self, status: m.NavStatus, code: str = "", detail: str = "") -> None:
        super().__init__(detail)
        self.status, self.code, self.detail = status, code, detail


class Drive:
    """Steps at the service's rate; returns the next target pose for the base, raises `Ended` when over."""

    def __init__(
        self,
        config: NavigationConfig,
        costmap: Costmap,
        planner: PathPlanner,
        choices: list[tuple[float, Pose2]],
        name: str,
        now: float,
    ) -> None:
        self._config, self._map, self._planner, self._choices = config, costmap, planner, choices
        self._name, self._started = name, now
        self._follower: Follower | None = None
        self._deadline = math.inf
        self._planned_at = -math.inf
        self._planned_version = -1
        self._via = 0
        self._best, self._best_at = math.inf, now
        self._blocked_since: float | None = None
        self._backing_until: float | None = None
        self._back_to: Pose2 = (0.0, 0.0, 0.0)
        self._new_path: list[Point] | None = None
        self._feedback_at = -math.inf
        self._via_pose: Pose2 | None = None
        self._assumed: Pose2 | None = None
        self._first_pose: Pose2 | None = None
        self.recoveries = 0
        self.remaining = 0.0

    @property
    def final_id(self) -> str:
        return self._name

    def take_new_path(self) -> list[Point] | None:
        path, self._new_path = self._new_path, None
        return path

    def due_feedback(self, now: float) -> bool:
        if now - self._feedback_at < FEEDBACK_PERIOD:
            return False
        self._feedback_at = now
        return True

    def step(
        self, pose: Pose2 | None, reached: list[m.GoalReached], points: Array | None, now: float
    ) -> m.BaseTarget | None:
        for answer in reached:
            if answer.reached and answer.target_id == self.final_id:
                raise Ended("arrived")
            if answer.reached and answer.target_id == f"{self._name}#{self._via}":
                self._trust(pose)
        pose = self._assumed or pose
        if pose is None:
            return self._blind(now)
        if self._follower is None:
            self._plan(pose, now)
        assert self._follower is not None
        if now > self._deadline:
            raise Ended("failed", "TIMEOUT", f"not there after {now - self._started:.0f} s")
        if self._backing_until is not None:
            return self._back(pose, now)
        return self._follow(pose, points, now)

    # --- a base that reports no motion
    def _trust(self, pose: Pose2 | None) -> None:
        """A driver that says `reached` without odometry that moves is believed: the base is where it was sent."""
        still = pose is None or pose == self._first_pose
        if still and self._via_pose is not None:
            self._assumed = self._via_pose

    def _blind(self, now: float) -> m.BaseTarget | None:
        """Without any odometry the goal itself is sent, once a second, and the base's own controller does the rest."""
        if self._deadline == math.inf:
            self._deadline = now + self._config.timeout_margin * 2
        if now > self._deadline:
            raise Ended("failed", "TIMEOUT", "no odometry, and the base never reported that it arrived")
        if now - self._planned_at < REPLAN_PERIOD:
            return None
        self._planned_at = now
        x, y, theta = min(self._choices)[1]
        return m.BaseTarget(x=x, y=y, theta=theta, id=self.final_id)

    # --- planning
    def _plan(self, pose: Pose2, now: float) -> None:
        """Choose the pose to stand at and the way there.

        Raises:
            Ended: NO_PATH.
        """
        if self._first_pose is None:
            self._first_pose = pose
        field = self._planner.field(pose[0], pose[1])
        costs = []
        for penalty, goal in self._choices:
            here = math.hypot(goal[0] - pose[0], goal[1] - pose[1]) < 0.05
            if here or self._planner.free(goal[0], goal[1]):
                cost = self._planner.cost_to(field, (goal[0], goal[1]))
                costs.append((penalty + 0.15 * cost, goal))
        best = min(costs, default=(math.inf, None))
        path = None
        if best[1] is not None and math.isfinite(best[0]):
            path = self._planner.path(field, (pose[0], pose[1]), (best[1][0], best[1][1]))
        self._planned_at, self._planned_version = now, self._map.version
        if path is None or best[1] is None:
            if self._map.sees_unmapped:
                raise Ended("failed", "BLOCKED", "something stands in every way there")
            raise Ended("failed", "NO_PATH", "no free way leads there")
        config = self._config
        self._follower = Follower(path, best[1], config.lookahead, config.corridor)
        self._new_path = path
        length = self._follower.remaining(pose)
        self._best, self._best_at = length, now
        self._deadline = max(
            now + length / config.min_average_speed + config.timeout_margin,
            self._deadline if math.isfinite(self._deadline) else 0.0,
        )

    def _follow(self, pose: Pose2, points: Array | None, now: float) -> m.BaseTarget | None:
        assert self._follower is not None
        radius = self._config.footprint_radius
        if self._map.version != self._planned_version and now - self._planned_at > REPLAN_PERIOD:
            self._replan(pose, now)
        carrot = self._follower.step(pose, self._map, radius, points)
        self.remaining = carrot.remaining
        if carrot.remaining < self._best - PROGRESS:
            self._best, self._best_at = carrot.remaining, now
        if carrot.blocked:
            self._blocked_since = self._blocked_since or now
            self._best_at = now
            if now - self._blocked_since > self._config.blocked_wait:
                self._recover(pose, now, "the way is blocked")
        else:
            self._blocked_since = None
            if now - self._best_at > self._config.no_progress:
                self._recover(pose, now, "no progress")
        self._via += 1
        self._via_pose = carrot.pose
        x, y, theta = carrot.pose
        return m.BaseTarget(x=x, y=y, theta=theta, id=self.final_id if carrot.final else f"{self._name}#{self._via}")

    def _replan(self, pose: Pose2, now: float) -> None:
        try:
            self._plan(pose, now)
        except Ended:
            # No way at this moment: keep the old path, its brake and its patience decide.
            self._planned_at, self._planned_version = now, self._map.version

    # --- recovery
    def _recover(self, pose: Pose2, now: float, why: str) -> None:
        """Back off a little, then look for another path; after the retries report.

        Raises:
            Ended: BLOCKED.
        """
        if self.recoveries >= self._config.retries:
            raise Ended("failed", "BLOCKED", f"{why} after {self.recoveries} retries")
        self.recoveries += 1
        self._blocked_since = None
        back = (pose[0] - BACK_OFF * math.cos(pose[2]), pose[1] - BACK_OFF * math.sin(pose[2]))
        free = self._map.line_clearance((pose[0], pose[1]), back) > self._config.footprint_radius
        self._back_to = (*back, pose[2]) if free else pose
        self._backing_until = now + 2.0

    def _back(self, pose: Pose2, now: float) -> m.BaseTarget | None:
        assert self._backing_until is not None
        if now >= self._backing_until:
            self._backing_until = None
            self._best_at = now
            self._replan(pose, now)
        self._via += 1
        x, y, theta = self._back_to
        return m.BaseTarget(x=x, y=y, theta=theta, id=f"{self._name}#{self._via}")
