"""Goal executor: choose a pose, plan a path, follow it, wait out or go around what blocks it, give up in time."""

import math
from collections.abc import Sequence

from common import messages as m
from common.geometry import Array, Point, Pose2
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.motion.collision_avoidance import avoid
from services.navigation.motion.contacts import UnseenObstacles
from services.navigation.motion.obstacle_tracker import Obstacle
from services.navigation.motion.path_follower import Lookahead
from services.navigation.motion.progress import PASSING, PERSON, Progress
from services.navigation.motion.recovery import Recovery
from services.navigation.motion.retreat import PassingPlace, Retreat
from services.navigation.motion.route import DETOUR_PAUSE, STRAYED_PERIOD, Route
from services.navigation.motion.targets import Targets
from services.navigation.motion.waiting import Waiting
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner


class Navigator:
    """Drives the base to one of several poses: each step returns the next target pose [map], or raises `Ended`.

    `recoveries` counts detours and retreats, `doing` is what is under way: "", WAITING, PERSON_IN_WAY, ROBOT_IN_WAY,
    DETOUR, BACKING_OFF, HELD_UP or GIVING_WAY. `remaining` is the path that is left [m], `met` what held it up last
    [map]. `patience`: how long it waits for who may be people [s].
    """

    def __init__(
        self,
        config: NavigationConfig,
        costmap: Costmap,
        planner: PathPlanner,
        contacts: UnseenObstacles,
        choices: list[tuple[float, Pose2]],
        name: str,
        now: float,
        patience: float = PASSING,
    ) -> None:
        self._config, self._map = config, costmap
        costmap.let_people_pass(False)
        self._route = Route(config, costmap, planner, choices)
        self._progress = Progress(config, now)
        self._recovery = Recovery(config, costmap, planner)
        self.waiting = Waiting(config, costmap, self._progress, self._recovery, patience)
        self._contacts = contacts
        self._targets = Targets(name)
        self.recoveries = 0
        self.remaining = 0.0
        self.doing = ""
        self.met: Point | None = None

    @property
    def eta(self) -> float:
        """Estimated time to arrival [s]."""
        waiting = self._config.blocked_wait if self.doing else 0.0
        return self.remaining / self._config.usual_speed + waiting

    def take_new_path(self) -> list[Point] | None:
        """The path being followed, the first time that it is asked for after a change, else None."""
        return self._route.take_new_path()

    def step(
        self,
        pose: Pose2 | None,
        reached: list[m.GoalReached],
        points: Array | None,
        obstacles: Sequence[Obstacle],
        now: float,
    ) -> m.BaseTarget | None:
        """The next target; `points` (n, 2) [map] is what the lidar sees around, `obstacles` the people there.

        Raises:
            Ended: arrived, or failed TIMEOUT, NO_PATH, BLOCKED, or PERSON_IN_WAY where only people block the way.
        """
        pose = self._targets.where(pose, reached)
        if pose is None:
            return self._without_odometry(now)
        if not self.begun:
            self._begin(pose, now)
        self._progress.check(now)
        self._recovery.note_pose(pose)
        target = self._go_on(pose, points, obstacles, now)
        here, stands, radius = (pose[0], pose[1]), self._map.people_pass, self._config.footprint_radius
        moving = [o for o in obstacles if o.moves]
        aside = avoid(here, (target.x, target.y), moving, self._map, radius, stands)
        if aside is None:
            return target
        self.doing = "GIVING_WAY"
        self._recovery.made_room(now)
        self._progress.restart_clock(now)
        self._contacts.interrupt()
        return self._targets.aside((*aside, pose[2]))

    def _go_on(self, pose: Pose2, points: Array | None, obstacles: Sequence[Obstacle], now: float) -> m.BaseTarget:
        if self._recovery.under_way is not None:
            return self._go_back(self._recovery.under_way, pose, points, obstacles, now)
        if self._route.follower is None:
            return self._wait(pose, obstacles, now)
        return self._follow(pose, points, obstacles, now)

    def _without_odometry(self, now: float) -> m.BaseTarget | None:
        """The goal itself as the target, once a second: without odometry the base's own controller does the rest."""
        if self._progress.deadline == math.inf:
            self._progress.set_limit(self._config.timeout_margin * 2, now)
        if now > self._progress.deadline:
            raise Ended("failed", "TIMEOUT", "no odometry, and the base never reported that it arrived")
        if not self._route.due(now):
            return None
        self._route.planned_at = now
        return self._targets.goal(min(self._route.choices)[1])

    @property
    def begun(self) -> bool:
        """True once the first plan was made."""
        return self._targets.start is not None

    def ahead(self, pose: Pose2, now: float) -> list[Point]:
        """The rest of the path [map], planned anew where there is none; empty if none is found."""
        if self._route.follower is None and self.begun and self._route.due(now):
            self._plan(pose, now)
        return self._route.follower.left() if self._route.follower is not None else []

    def give_way(self, spot: Pose2, now: float) -> m.BaseTarget:
        """The target while another robot goes first: `spot` [map]; raises `Ended` TIMEOUT."""
        self._progress.check(now)
        self._progress.extend(now)
        self._recovery.under_way, self.doing = None, "GIVING_WAY"
        self.waiting.end()
        return self._targets.aside(spot)

    def go_on(self, now: float) -> None:
        """Go on to the goal after giving way: the next step plans from where the robot is."""
        self._progress.restart(now)
        self._route.follower, self._route.planned_at = None, -math.inf
        self.waiting.end()

    def relocated(self, now: float) -> None:
        """Begin anew with the next step, keeping only the goal: the pose estimate has jumped."""
        self._recovery.relocated()
        self._route.abandon()
        self._targets.start, self._progress.deadline = None, math.inf
        self._progress.restart(now)
        self.waiting.end()

    def _begin(self, pose: Pose2, now: float) -> None:
        """Make the first plan.

        Raises:
            Ended: NO_PATH, when even an empty flat has none.
        """
        self._targets.start = pose
        if self._plan(pose, now):
            return
        if not self._route.possible(pose):
            raise Ended("failed", "NO_PATH", "no free way leads there")
        self._progress.set_limit(self._config.timeout_margin + self._config.blocked_wait * 10, now)

    def _plan(self, pose: Pose2, now: float, people: Sequence[Obstacle] = ()) -> bool:
        """Choose pose and path anew; when there is no path now, returns False and changes nothing."""
        found = self._route.plan(pose, now, people)
        if found == "detour":
            self.recoveries += 1
            self.doing = "DETOUR"
        if found in ("new", "detour") and self._route.follower is not None:
            self._progress.begin_path(self._route.follower.remaining(pose), now)
        return bool(found)

    def _follow(self, pose: Pose2, points: Array | None, obstacles: Sequence[Obstacle], now: float) -> m.BaseTarget:
        if self._route.outdated and self._route.due(now):
            self._replan(pose, obstacles, now)
        follower = self._route.follower
        if follower is None:
            return self._wait(pose, obstacles, now)
        ahead = follower.step(pose, self._map, self._config.footprint_radius, points)
        self.remaining = ahead.remaining
        if ahead.strayed:
            # There is another way from where it has been led to.
            if self._route.due(now, STRAYED_PERIOD):
                self._route.follower = None
                self._plan(pose, now)
            return self._targets.next(pose)
        self._watch(ahead, pose, obstacles, now)
        return self._targets.ahead(ahead.pose, ahead.final)

    def _watch(self, ahead: Lookahead, pose: Pose2, obstacles: Sequence[Obstacle], now: float) -> None:
        """Begin a recovery when the path has been blocked, or the robot has made no progress, for too long."""
        if self._progress.advanced(ahead.remaining, now) and (
            self.doing != "DETOUR" or now - self._route.detour_at > DETOUR_PAUSE
        ):
            self.doing = ""
        if ahead.blocked:
            self.doing = self.waiting.on_blocked_path(pose, obstacles, now)
            if self.waiting.too_long(now):
                self._recover(pose, now, "the way is blocked", by_people=self.waiting.for_people)
            return
        self.waiting.end()
        if met := self._contacts.check(pose, ahead.pose, now):
            self.met = met
            self._recover(pose, now, "held up by something unseen", "HELD_UP")
        elif self._progress.stuck(now):
            self._recover(pose, now, "no progress")

    def _replan(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> None:
        """Plan around what was seen; where no path leads round it, drive the old one up to `keep_off` from it."""
        if (self._plan(pose, now, people) and not self._route.waits) or self._route.follower is None:
            return
        ahead = self._route.blocked_at(pose)
        if ahead is not None and ahead < self._config.keep_off:
            self._route.follower = None

    def _wait(self, pose: Pose2, obstacles: Sequence[Obstacle], now: float) -> m.BaseTarget:
        """The target while there is no path: stand, plan every second, begin a recovery after too long."""
        if self._route.due(now):
            if self._plan(pose, now, obstacles):
                self.waiting.end()
                return self._targets.next(pose)
            self.waiting.note_blocker(self._route.blocked_by(pose, now))
        self.doing = self.waiting.without_path(pose, obstacles, now)
        if self.waiting.too_long(now):
            by_people = self.waiting.for_people
            who = "somebody" if by_people else "something"
            self._recover(pose, now, f"{who} stands in every way there", by_people=by_people)
        return self._targets.next(pose)

    def _recover(self, pose: Pose2, now: float, why: str, doing: str = "BACKING_OFF", by_people: bool = False) -> None:
        """Begin to back off; raises `Ended` BLOCKED, or PERSON_IN_WAY, after the last retry."""
        self._recovery.back_off(pose, now, why, PERSON if by_people else "BLOCKED", doing == "HELD_UP")
        self.recoveries += 1
        self.doing = doing
        self.waiting.end()

    def _go_back(
        self, retreat: Retreat | PassingPlace, pose: Pose2, points: Array | None, people: Sequence[Obstacle], now: float
    ) -> m.BaseTarget:
        """The target of a recovery under way; plans anew once that is over."""
        if isinstance(retreat, PassingPlace):
            self.doing = "GIVING_WAY"
            self._progress.extend(now)
        if retreat.over(pose, people, now):
            self._recovery.under_way = None
            self._progress.restart(now)
            self._route.follower = None
            self._plan(pose, now)
            self.waiting.end()
        return self._targets.next(retreat.step(pose, points))
