"""One goal under way: choose a pose, plan, follow, wait out or go around what blocks, give up in time."""

import math
from collections.abc import Sequence

from common import messages as m
from common.geometry import Pose2
from services.navigation.avoid import avoid
from services.navigation.config import NavigationConfig
from services.navigation.costmap import Array, Costmap
from services.navigation.follow import Carrot, Follower
from services.navigation.movers import Mover
from services.navigation.patience import Patience
from services.navigation.planner import PathPlanner, Point
from services.navigation.trail import Trail

REPLAN_PERIOD = 1.0
FEEDBACK_PERIOD = 1.0
PROGRESS = 0.05
DETOUR_PAUSE = 4.0
SHORTER = 0.85
OUT_OF_SIGHT = 3.0


class Ended(Exception):
    """The goal has ended with this status, code and detail."""

    def __init__(self, status: m.NavStatus, code: str = "", detail: str = "") -> None:
        super().__init__(detail)
        self.status, self.code, self.detail = status, code, detail


class Drive:
    """Steps at the service's rate; returns the next target pose [map] for the base, raises `Ended` when over.

    `recoveries` counts detours and retreats, `doing` tells which is under way: "", WAITING,
    DETOUR, BACKING_OFF or GIVING_WAY.
    """

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
        self._patience = Patience()
        self._movers: Sequence[Mover] = ()
        self._backing_until: float | None = None
        self._back_to: Pose2 = (0.0, 0.0, 0.0)
        self._trail = Trail()
        self._new_path: list[Point] | None = None
        self._feedback_at = -math.inf
        self._detour_at = -math.inf
        self._via_pose: Pose2 | None = None
        self._assumed: Pose2 | None = None
        self._first_pose: Pose2 | None = None
        self._retries = 0
        self.recoveries = 0
        self.remaining = 0.0
        self.doing = ""

    @property
    def final_id(self) -> str:
        return self._name

    @property
    def eta(self) -> float:
        """Seconds that are left, as far as one can tell."""
        now_waiting = self._config.blocked_wait if self.doing else 0.0
        return self.remaining / self._config.usual_speed + now_waiting

    def take_new_path(self) -> list[Point] | None:
        path, self._new_path = self._new_path, None
        return path

    def due_feedback(self, now: float) -> bool:
        if now - self._feedback_at < FEEDBACK_PERIOD:
            return False
        self._feedback_at = now
        return True

    def step(
        self,
        pose: Pose2 | None,
        reached: list[m.GoalReached],
        points: Array | None,
        movers: Sequence[Mover],
        now: float,
    ) -> m.BaseTarget | None:
        """`points` (n, 2) is what the lidar sees around, in frame map; raises `Ended`."""
        for answer in reached:
            if answer.reached and answer.target_id == self.final_id:
                raise Ended("arrived")
            if answer.reached and answer.target_id == f"{self._name}#{self._via}":
                self._trust(pose)
        pose = self._assumed or pose
        if pose is None:
            return self._blind(now)
        if self._first_pose is None:
            self._begin(pose, now)
        if now > self._deadline:
            raise Ended("failed", "TIMEOUT", f"not there after {now - self._started:.0f} s")
        self._trail.add(pose)
        self._movers = movers
        target = self._go_on(pose, points, now)
        if target is None:
            return None
        here = (pose[0], pose[1])
        aside = avoid(here, (target.x, target.y), movers, self._map, self._config.footprint_radius)
        if aside is None:
            return target
        self._via_pose, self.doing = None, "GIVING_WAY"
        self._best_at = now
        return self._hold_at((*aside, pose[2]))

    def _go_on(self, pose: Pose2, points: Array | None, now: float) -> m.BaseTarget | None:
        if self._backing_until is not None:
            return self._back(pose, now)
        if self._follower is None:
            return self._wait(pose, now)
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
    def _begin(self, pose: Pose2, now: float) -> None:
        """The first plan.

        Raises:
            Ended: NO_PATH, when even an empty flat has none.
        """
        self._first_pose = pose
        if self._plan(pose, now):
            return
        if not self._planner.possible((pose[0], pose[1]), [(g[0], g[1]) for _, g in self._choices]):
            raise Ended("failed", "NO_PATH", "no free way leads there")
        self._deadline = now + self._config.timeout_margin + self._config.blocked_wait * 10

    def _plan(self, pose: Pose2, now: float) -> bool:
        """Choose the pose to stand at and the way there; False, and nothing changes, when there is none now."""
        field = self._planner.field(pose[0], pose[1])
        costs = []
        for penalty, goal in self._choices:
            here = math.hypot(goal[0] - pose[0], goal[1] - pose[1]) < 0.05
            if here or self._planner.free(goal[0], goal[1]):
                cost = self._planner.cost_to(field, (goal[0], goal[1]))
                costs.append((penalty + 0.15 * cost, goal))
        self._planned_at, self._planned_version = now, self._map.version
        score, goal = min(costs, default=(math.inf, (0.0, 0.0, 0.0)))
        path = self._planner.path(field, (pose[0], pose[1]), (goal[0], goal[1])) if math.isfinite(score) else None
        if path is None:
            return False
        follower = Follower(path, goal, self._config.lookahead, self._config.corridor)
        old = self._follower
        if old is not None and self._blocked_at(old, pose) is None:
            if follower.remaining(pose) > SHORTER * old.remaining(pose):
                return True
        elif old is not None and now - self._detour_at > DETOUR_PAUSE:
            self.recoveries += 1
            self._detour_at, self.doing = now, "DETOUR"
        self._follower, self._new_path = follower, path
        length = follower.remaining(pose)
        self._best, self._best_at = length, now
        limit = now + length / self._config.min_average_speed + self._config.timeout_margin
        self._deadline = max(limit, self._deadline if math.isfinite(self._deadline) else 0.0)
        return True

    def _blocked_at(self, follower: Follower, pose: Pose2) -> float | None:
        """How far ahead [m] something that was seen lies on the path; None when it is clear."""
        return follower.blocked_at(pose, self._map, self._config.footprint_radius - 0.02)

    def _follow(self, pose: Pose2, points: Array | None, now: float) -> m.BaseTarget | None:
        if self._map.version != self._planned_version and now - self._planned_at > REPLAN_PERIOD:
            self._replan(pose, now)
        follower = self._follower
        if follower is None:
            return self._wait(pose, now)
        carrot = follower.step(pose, self._map, self._config.footprint_radius, points)
        self.remaining = carrot.remaining
        self._watch(carrot, pose, now)
        self._via += 1
        self._via_pose = carrot.pose
        x, y, theta = carrot.pose
        return m.BaseTarget(x=x, y=y, theta=theta, id=self.final_id if carrot.final else f"{self._name}#{self._via}")

    def _watch(self, carrot: Carrot, pose: Pose2, now: float) -> None:
        """Patience: with a blocked way, and with no progress on a free one."""
        if carrot.remaining < self._best - PROGRESS:
            self._best, self._best_at = carrot.remaining, now
            if self.doing != "DETOUR" or now - self._detour_at > DETOUR_PAUSE:
                self.doing = ""
        if carrot.blocked:
            self._best_at, self.doing = now, "WAITING"
            if self._patience.blocked((pose[0], pose[1]), self._movers, now) > self._config.blocked_wait:
                self._recover(pose, now, "the way is blocked")
        else:
            self._patience.clear()
            if now - self._best_at > self._config.no_progress:
                self._recover(pose, now, "no progress")

    def _replan(self, pose: Pose2, now: float) -> None:
        """Around what was seen; when there is no way round, on towards it, but not up to it."""
        if self._plan(pose, now) or self._follower is None:
            return
        ahead = self._blocked_at(self._follower, pose)
        if ahead is not None and ahead < self._config.keep_off:
            self._follower = None

    # --- recovery
    def _wait(self, pose: Pose2, now: float) -> m.BaseTarget:
        """No way at this moment: stand, look for one every second, lose patience in time."""
        self.doing = "WAITING"
        blocked = self._patience.blocked((pose[0], pose[1]), self._movers, now)
        if now - self._planned_at > REPLAN_PERIOD and self._plan(pose, now):
            self._patience.clear()
        elif blocked > self._config.blocked_wait:
            self._recover(pose, now, "something stands in every way there")
        return self._hold_at(pose)

    def _hold_at(self, pose: Pose2) -> m.BaseTarget:
        self._via += 1
        return m.BaseTarget(x=pose[0], y=pose[1], theta=pose[2], id=f"{self._name}#{self._via}")

    def _recover(self, pose: Pose2, now: float, why: str) -> None:
        """Go back a little the way it came, then look for another path; after the retries report.

        These are all the retries of a blocked way: whoever sent the goal adds none.

        Raises:
            Ended: BLOCKED.
        """
        if self._retries >= self._config.retries:
            raise Ended("failed", "BLOCKED", f"{why} after {self._retries} retries")
        self._retries += 1
        self.recoveries += 1
        self.doing = "BACKING_OFF"
        self._patience.clear()
        self._map.doubt(now, OUT_OF_SIGHT)
        config = self._config
        self._back_to = self._trail.retreat(pose, self._map, config.footprint_radius, config.back_off)
        self._backing_until = now + self._config.back_off_time

    def _back(self, pose: Pose2, now: float) -> m.BaseTarget | None:
        assert self._backing_until is not None
        if now >= self._backing_until:
            self._backing_until = None
            self._best, self._best_at = math.inf, now
            self._follower = None
            self._plan(pose, now)
            self._patience.clear()
        return self._hold_at(self._back_to)
