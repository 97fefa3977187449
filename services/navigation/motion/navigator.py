"""Goal executor: choose a pose, plan a path, follow it, wait out or go around what blocks it, give up in time."""

import math
from collections.abc import Sequence

from common import messages as m
from common.geometry import Pose2
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.motion.blind_base import BlindBase
from services.navigation.motion.breadcrumbs import Breadcrumbs
from services.navigation.motion.collision_avoidance import avoid
from services.navigation.motion.obstacle_tracker import Obstacle
from services.navigation.motion.path_follower import Lookahead, PathFollower
from services.navigation.motion.progress import CLOSE, BlockedTimer, Progress, Standoff, waiting_for
from services.navigation.motion.retreat import PassingPlace, Retreat, passing_place
from services.navigation.motion.route import DETOUR_PAUSE, Route
from services.navigation.planning.costmap import Array, Costmap
from services.navigation.planning.planner import PathPlanner, Point

REPLAN_PERIOD = 1.0
"""Least time between two plans [s]; chosen: what the lidar sees seldom changes faster."""
FEEDBACK_PERIOD = 1.0
"""Time between two feedbacks without news [s]; chosen: often enough for a person who watches."""
OUT_OF_SIGHT = 3.0
"""Age from which what was seen may be gone when there is no path [s]; chosen: longer than somebody hides a cell."""


class Navigator:
    """Steps at the service's rate; returns the next target pose [map] for the base, raises `Ended` when over.

    `recoveries` counts detours and retreats, `doing` is what is under way: "", WAITING, PERSON_IN_WAY, ROBOT_IN_WAY,
    DETOUR, BACKING_OFF or GIVING_WAY. `remaining` is the path that is left [m].
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
        self._config, self._map = config, costmap
        self._name, self._started = name, now
        self._route = Route(config, costmap, planner, choices)
        self._progress = Progress(config, now)
        self._blocked = BlockedTimer()
        self._breadcrumbs = Breadcrumbs()
        self._base = BlindBase()
        self._targets = 0
        self._planner = planner
        self._retreat: Retreat | PassingPlace | None = None
        self._standoff = Standoff()
        self._feedback_at = -math.inf
        self._retries = 0
        self.robots: Sequence[tuple[float, float, float]] = ()
        """Circles (x, y, radius) [map, m] of robots that are about to make way."""
        self.recoveries = 0
        self.remaining = 0.0
        self.doing = ""

    @property
    def final_id(self) -> str:
        """Id of the target pose that is the goal itself."""
        return self._name

    @property
    def eta(self) -> float:
        """Seconds that are left, as far as one can tell."""
        waiting = self._config.blocked_wait if self.doing else 0.0
        return self.remaining / self._config.usual_speed + waiting

    def take_new_path(self) -> list[Point] | None:
        """The path being followed, once after it has changed."""
        return self._route.take_new_path()

    def due_feedback(self, now: float) -> bool:
        """True once every FEEDBACK_PERIOD."""
        if now - self._feedback_at < FEEDBACK_PERIOD:
            return False
        self._feedback_at = now
        return True

    def step(
        self,
        pose: Pose2 | None,
        reached: list[m.GoalReached],
        points: Array | None,
        obstacles: Sequence[Obstacle],
        now: float,
    ) -> m.BaseTarget | None:
        """`points` (n, 2) [map] is what the lidar sees around, `obstacles` the people there.

        Raises:
            Ended: arrived, or failed TIMEOUT, NO_PATH or BLOCKED.
        """
        for answer in reached:
            if answer.reached and answer.target_id == self.final_id:
                raise Ended("arrived")
            if answer.reached and answer.target_id == f"{self._name}#{self._targets}":
                self._base.reached(pose)
        pose = self._base.where(pose)
        if pose is None:
            return self._without_odometry(now)
        if self._base.start is None:
            self._begin(pose, now)
        if now > self._progress.deadline:
            raise Ended("failed", "TIMEOUT", f"not there after {now - self._started:.0f} s")
        self._breadcrumbs.add(pose)
        target = self._go_on(pose, points, obstacles, now)
        here = (pose[0], pose[1])
        moving = [o for o in obstacles if o.moves]
        aside = avoid(here, (target.x, target.y), moving, self._map, self._config.footprint_radius)
        if aside is None:
            return target
        self._base.sent, self.doing = None, "GIVING_WAY"
        self._progress.excuse(now)
        return self._hold_at((*aside, pose[2]))

    def _go_on(self, pose: Pose2, points: Array | None, obstacles: Sequence[Obstacle], now: float) -> m.BaseTarget:
        if self._retreat is not None:
            return self._go_back(self._retreat, pose, points, obstacles, now)
        if self._route.follower is None:
            return self._wait(pose, obstacles, now)
        return self._follow(pose, points, obstacles, now)

    def _without_odometry(self, now: float) -> m.BaseTarget | None:
        """The goal itself is sent, once a second, and the base's own controller does the rest."""
        if self._progress.deadline == math.inf:
            self._progress.allow(self._config.timeout_margin * 2, now)
        if now > self._progress.deadline:
            raise Ended("failed", "TIMEOUT", "no odometry, and the base never reported that it arrived")
        if now - self._route.planned_at < REPLAN_PERIOD:
            return None
        self._route.planned_at = now
        x, y, theta = min(self._route.choices)[1]
        return m.BaseTarget(x=x, y=y, theta=theta, id=self.final_id)

    # --- other robots
    @property
    def begun(self) -> bool:
        """It has planned its way."""
        return self._base.start is not None

    def ahead(self, pose: Pose2, now: float) -> list[Point]:
        """The way that is left [map], planned anew where it was left; empty: there is none now."""
        if self._route.follower is None and self.begun and now - self._route.planned_at > REPLAN_PERIOD:
            self._plan(pose, now)
        return self._route.follower.left() if self._route.follower is not None else []

    def give_way(self, spot: Pose2, now: float) -> m.BaseTarget:
        """Go to `spot` [map] meanwhile, or stay there.

        Raises:
            Ended: TIMEOUT.
        """
        if now > self._progress.deadline:
            raise Ended("failed", "TIMEOUT", f"not there after {now - self._started:.0f} s")
        self._progress.hold_up(now)
        self._base.sent, self._retreat, self.doing = None, None, "GIVING_WAY"
        self._blocked.clear()
        return self._hold_at(spot)

    def go_on(self, now: float) -> None:
        """The way is free again, from wherever the robot is by now."""
        self._progress.restart(now)
        self._route.follower, self._route.planned_at = None, -math.inf
        self._blocked.clear()

    def relocated(self, now: float) -> None:
        """The robot is not where it seemed to be: everything but the goal begins anew with the next step."""
        self._retreat, self._breadcrumbs = None, Breadcrumbs()
        self._route.abandon()
        self._base.start, self._progress.deadline = None, math.inf
        self._progress.restart(now)
        self._blocked.clear()

    # --- planning
    def _begin(self, pose: Pose2, now: float) -> None:
        """The first plan.

        Raises:
            Ended: NO_PATH, when even an empty flat has none.
        """
        self._base.start = pose
        if self._plan(pose, now):
            return
        if not self._route.possible(pose):
            raise Ended("failed", "NO_PATH", "no free way leads there")
        self._progress.allow(self._config.timeout_margin + self._config.blocked_wait * 10, now)

    def _plan(self, pose: Pose2, now: float, people: Sequence[Obstacle] = ()) -> bool:
        """Choose pose and path anew; False, and nothing changes, when there is no path now."""
        found = self._route.plan(pose, now, people)
        if found == "detour":
            self.recoveries += 1
            self.doing = "DETOUR"
        if found in ("new", "detour") and self._route.follower is not None:
            self._progress.follow(self._route.follower.remaining(pose), now)
        return bool(found)

    def _follow(self, pose: Pose2, points: Array | None, obstacles: Sequence[Obstacle], now: float) -> m.BaseTarget:
        if self._route.outdated and now - self._route.planned_at > REPLAN_PERIOD:
            self._replan(pose, obstacles, now)
        follower = self._route.follower
        if follower is None:
            return self._wait(pose, obstacles, now)
        ahead = follower.step(pose, self._map, self._config.footprint_radius, points)
        self.remaining = ahead.remaining
        self._watch(ahead, pose, obstacles, now)
        self._targets += 1
        self._base.sent = ahead.pose
        x, y, theta = ahead.pose
        number = self.final_id if ahead.final else f"{self._name}#{self._targets}"
        return m.BaseTarget(x=x, y=y, theta=theta, id=number)

    def _watch(self, ahead: Lookahead, pose: Pose2, obstacles: Sequence[Obstacle], now: float) -> None:
        """Lose patience with a blocked path, and with no progress on a free one."""
        if self._progress.advanced(ahead.remaining, now) and (
            self.doing != "DETOUR" or now - self._route.detour_at > DETOUR_PAUSE
        ):
            self.doing = ""
        if ahead.blocked:
            self._progress.excuse(now)
            self._wait_for(pose, obstacles, now)
            if self._blocked.blocked((pose[0], pose[1]), obstacles, now) > self._config.blocked_wait:
                self._recover(pose, now, "the way is blocked")
        else:
            self._blocked.clear()
            if self._progress.stuck(now):
                self._recover(pose, now, "no progress")

    def _replan(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> None:
        """Around what was seen; when there is no path round it, on towards it, but not up to it."""
        if (self._plan(pose, now, people) and not self._route.waits) or self._route.follower is None:
            return
        ahead = self._route.blocked_at(pose)
        if ahead is not None and ahead < self._config.keep_off:
            self._route.follower = None

    # --- recovery
    def _wait(self, pose: Pose2, obstacles: Sequence[Obstacle], now: float) -> m.BaseTarget:
        """No path at this moment: stand, look for one every second, lose patience in time."""
        self._wait_for(pose, obstacles, now)
        blocked = self._blocked.blocked((pose[0], pose[1]), obstacles, now)
        if now - self._route.planned_at > REPLAN_PERIOD and self._plan(pose, now, obstacles):
            self._blocked.clear()
        elif blocked > self._config.blocked_wait:
            self._recover(pose, now, "something stands in every way there")
        return self._hold_at(pose)

    def _wait_for(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> None:
        """Blocked at this moment: by a person, who may want to get past the robot, or by something."""
        if any(math.dist(pose[:2], (x, y)) < CLOSE + radius for x, y, radius in self.robots):
            self.doing = "ROBOT_IN_WAY"
            self._progress.hold_up(now)
            self._blocked.clear()
            return
        self.doing = waiting_for((pose[0], pose[1]), people)
        if self.doing == "PERSON_IN_WAY":
            self._progress.hold_up(now)
            self._let_pass(pose, people, now)

    def _hold_at(self, pose: Pose2) -> m.BaseTarget:
        self._targets += 1
        return m.BaseTarget(x=pose[0], y=pose[1], theta=pose[2], id=f"{self._name}#{self._targets}")

    def _recover(self, pose: Pose2, now: float, why: str) -> None:
        """Go back a little the way it came, then look for another path; after the retries report.

        These are all the retries of a blocked path: whoever sent the goal adds none.

        Raises:
            Ended: BLOCKED.
        """
        if self._retries >= self._config.retries:
            raise Ended("failed", "BLOCKED", f"{why} after {self._retries} retries")
        self._retries += 1
        self.recoveries += 1
        self.doing = "BACKING_OFF"
        self._blocked.clear()
        self._map.doubt(now, OUT_OF_SIGHT)
        config = self._config
        back = self._breadcrumbs.retreat(pose, self._map, config.footprint_radius, config.back_off)
        self._retreat = Retreat(back, now + config.back_off_time, config.corridor)

    def _let_pass(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> None:
        """Whoever waits for the robot to go first gets room."""
        person = self._standoff.with_whom((pose[0], pose[1]), people, now)
        if person is None:
            return
        path = passing_place(pose, person, self._map, self._planner)
        if path is not None:
            config = self._config
            follower = PathFollower(path, (*path[-1], pose[2]), config.lookahead, config.corridor)
            radius = config.footprint_radius
            self._retreat = PassingPlace(follower, person, self._map, radius, config.corridor, now)

    def _go_back(
        self,
        retreat: Retreat | PassingPlace,
        pose: Pose2,
        points: Array | None,
        people: Sequence[Obstacle],
        now: float,
    ) -> m.BaseTarget:
        """Out of the way, and then another plan."""
        if isinstance(retreat, PassingPlace):
            self.doing = "GIVING_WAY"
            self._progress.hold_up(now)
        if retreat.over(pose, people, now):
            self._retreat = None
            self._progress.restart(now)
            self._route.follower = None
            self._plan(pose, now)
            self._blocked.clear()
        return self._hold_at(retreat.step(pose, points))
