"""Navigation: goals in words or poses -> paths on the costmap -> a stream of target poses for the base."""

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from common.goal_inbox import GoalInbox
from services.navigation.config import NavigationConfig
from services.navigation.destinations import Destinations
from services.navigation.ended import Ended
from services.navigation.goals import Choices, Goal, in_words
from services.navigation.localisation.state_estimation import StateEstimator
from services.navigation.map_upkeep import MapUpkeep
from services.navigation.motion.navigator import Navigator
from services.navigation.motion.progress import PASSING, PASSING_BY
from services.navigation.orientation import Orientation
from services.navigation.others.neighbours import Neighbours
from services.navigation.planning.planner import PathPlanner
from services.navigation.reports import Reports
from services.navigation.search.search import Search

STALE = 0.1
"""Age [s] of the odometry from which on nobody knows whether the base moves: ten samples at 100 Hz."""


class NavigationService:
    """Drives the base to items, places and poses. `state`: its pose, `map`: the costmap, `neighbours`: other robots."""

    NAME = "navigation"
    HZ = 20
    CONFIG = NavigationConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: NavigationConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._destinations = Destinations(config, io)
        self._upkeep = MapUpkeep(config, io)
        self.map, self._contacts = self._upkeep.map, self._upkeep.contacts
        # While a map is made its cells are the error: a door that the robot just fits through is passed.
        spare = 0.0 if config.map == "mapping" else config.clearance
        self._planner = PathPlanner(self.map, config.footprint_radius + spare, config.inflation)
        self.state = StateEstimator(config, io, self.map)
        self._navigator: Navigator | None = None
        self._search: Search | None = None
        self._found: Search | None = None
        self._inbox: GoalInbox[Goal, m.NavigationStatus] = GoalInbox(
            io, (topics.NAVIGATION_GOAL, topics.NAV_GOAL), self._take, self._repeat, self._preempted
        )
        self._orientation = Orientation(config, io, self.state, self.map)
        self.neighbours = Neighbours(config, io, self.map, self._planner)
        self._reports = Reports(io, self.state)
        self._legs = 0
        self._now = 0.0

    def step(self, now: float) -> None:
        io, self._now = self._io, now
        self.state.step(now)
        if self.state.fresh and not self.state.lost:
            self._upkeep.see(self.state.unmapped, now)
        self.neighbours.hear(self._known_pose, self._busy, now)
        self.state.robots = self.neighbours.circles
        self._upkeep.step(self._destinations.objects(), now)
        if io.take_all(topics.ROBOT_STOP) and self._busy:
            self._finish(Ended("failed", "STOPPED", "robot/stop"))
        self._inbox.receive()
        reached = io.take_all(topics.GOAL_REACHED)
        try:
            if self._found is not None:
                self._still_there(self._found)
            if self._navigator is not None:
                self._orientation.check(now)
            if self._busy and self._located(reached, now):
                if self._search is not None:
                    self._look_for(self._search, now)
                if self._navigator is not None:
                    self._advance(self._navigator, reached, now)
        except Ended as ended:
            self._finish(ended)
        self._with_others(now)

    @property
    def _known_pose(self) -> Pose2 | None:
        return None if self.state.lost else self.state.pose

    @property
    def _busy(self) -> bool:
        return self._navigator is not None or self._search is not None

    def _repeat(self, goal: Goal, answer: m.NavigationStatus | None) -> None:
        self._reports.publish(answer or self._reports.status, self._navigator)

    def _preempted(self, old: Goal, new: Goal) -> None:
        self._finish(Ended("failed", "PREEMPTED", f"replaced by {in_words(new)}"))

    def _take(self, goal: Goal) -> None:
        text, pose = ("", goal) if isinstance(goal, m.NavGoal) else (goal.goal.strip(), None)
        self._reports.begin(goal)
        self._io.log.info("goal", goal=in_words(goal), id=goal.id, attempt=goal.attempt)
        if text == "stop":
            self._hold()
            self._reports.tell("idle", "STOPPED", "the base holds", None)
            self._inbox.end(goal, self._reports.status)
            return
        try:
            self._begin(text, pose)
        except Ended as ended:
            self._finish(ended)
        else:
            self._reports.tell("navigating", "", text, self._navigator)

    def _begin(self, text: str, pose: m.NavGoal | None) -> None:
        """Raises `Ended` for an unknown goal or place."""
        verb, _, rest = text.partition(" ")
        item = rest.strip() if verb == "find" else ""
        named = pose.object.label if pose is not None and pose.object is not None else item
        self._destinations.goal_sent(self._reports.status.goal_id, named)
        if pose is not None:
            self._go(self._destinations.standing_at(pose))
        elif item:
            self._find(item)
        else:
            self._go(self._destinations.goals.by_words(text))

    def _find(self, item: str) -> None:
        choices = self._destinations.before(item)
        if not self._destinations.watched:
            self._go(choices or self._destinations.goals.expected_at(item))
            return
        search = self._destinations.search(item, self._now)
        if choices:
            self._found = search
            self._go(choices)
        else:
            self._io.log.info("search", item=item)
            self._search = search

    def _go(self, choices: Choices, patience: float = PASSING) -> None:
        self._legs += 1
        name = f"{self._reports.status.goal_id}/{self._reports.status.attempt}/{self._legs}"
        if self._config.map == "mapping":
            patience = PASSING_BY
        self._navigator = Navigator(
            self._config, self.map, self._planner, self._contacts, choices, name, self._now, patience
        )
        self._reports.begin_leg()

    def _look_for(self, search: Search, now: float) -> None:
        """One step of a search; raises `Ended` when it is over without result."""
        if choices := self._destinations.before(search.item):
            self._io.log.info("found", item=search.item, views=search.looked)
            self._search, self._found = None, search
            self._reports.end_leg(self._navigator)
            self._go(choices)
            return
        if not self._destinations.watched:
            self._io.log.warning("nobody looks any more", item=search.item)
            self._search = None
            self._go(self._destinations.goals.expected_at(search.item))
            return
        pose = self.state.pose
        if pose is None or search.timed_out(now):
            return
        looked = self._destinations.coverage.look(pose, now, self._config.look_time)
        if self._navigator is None and (looked or search.fresh):
            view = search.next(pose, self._planner, self.map)
            self._io.log.info("view", item=search.item, number=search.looked, x=view[0], y=view[1])
            self._go([(0.0, view)], PASSING_BY)

    def _still_there(self, found: Search) -> None:
        """Search on when perception, from nearer, no longer takes anything for what is driven to."""
        if not self._destinations.watched or self._destinations.known(found.item):
            return
        self._io.log.info("not there after all", item=found.item)
        self._reports.end_leg(self._navigator)
        self._search, self._found, self._navigator = found, None, None

    def _located(self, reached: list[m.GoalReached], now: float) -> bool:
        """True while the robot knows where it is; else it finds out. Raises `Ended` when it cannot."""
        doing = self._orientation.doing
        if self.state.lost:
            self._orientation.find(reached, now)
        elif self._orientation.end():
            self._contacts.forget()
            if self._navigator is not None:
                self._navigator.relocated(now)
        if self._orientation.doing != doing:
            self._reports.feedback(self._navigator, self._orientation.doing)
        return not self.state.lost

    def _advance(self, navigator: Navigator, reached: list[m.GoalReached], now: float) -> None:
        """Raises `Ended` when the goal has."""
        state = self.state
        if state.age(now) > STALE:
            self._contacts.interrupt()
        try:
            aside = self.neighbours.steer(navigator, self._known_pose, state.points, now)
            target = (
                navigator.give_way(aside, now)
                if aside is not None
                else navigator.step(state.pose, reached, state.points, state.tracker.people(), now)
            )
        except Ended as ended:
            if self._search is None or ended.code == "TIMEOUT":
                raise
            # A view that cannot be reached is one view less.
            self._reports.end_leg(navigator)
            self._navigator = None
            self._search.fresh = ended.status == "failed"
            return
        if target is not None:
            target.x, target.y, target.theta = state.localiser.to_odometry((target.x, target.y, target.theta))
            self._io.publish(topics.BASE_TARGET, target)
        if path := navigator.take_new_path():
            self._io.publish(topics.NAV_PATH, m.NavPath(t=now, points=path[::4], goal_id=self._reports.status.goal_id))
        self._reports.under_way(navigator, bool(path), now)

    def _with_others(self, now: float) -> None:
        """Tell the other robots which way this one takes, and make room for them while it has nothing to do."""
        state, pose, navigator = self.state, self._known_pose, self._navigator
        if self.neighbours.alone:
            return
        if not self._busy and self.neighbours.state == "free":
            aside = self.neighbours.steer(None, pose, state.points, now)
            if aside is not None:
                x, y, theta = state.localiser.to_odometry(aside)
                self._legs += 1
                self._io.publish(topics.BASE_TARGET, m.BaseTarget(x=x, y=y, theta=theta, id=f"aside/{self._legs}"))
        path = navigator.ahead(pose, now) if navigator is not None and pose is not None else []
        self.neighbours.tell(pose, path, now)

    def _finish(self, ended: Ended) -> None:
        navigator, self._search, self._found = self._navigator, None, None
        self._reports.end_leg(navigator)
        self._navigator = None
        self._orientation.end()
        if ended.status == "arrived":
            self._destinations.arrived(self.state.pose)
        if ended.status == "failed" and navigator is not None and self.state.pose is not None:
            self._hold()
        self._reports.tell(ended.status, ended.code, ended.detail, None)
        if self._inbox.active is not None:
            self._inbox.end(self._inbox.active, self._reports.status)
        log = self._io.log.info if ended.status == "arrived" else self._io.log.warning
        log(ended.status, id=self._reports.status.goal_id, code=ended.code, detail=ended.detail)

    def _hold(self) -> None:
        """Brake: a velocity stream that falls silent at once."""
        self._navigator = self._search = self._found = None
        self._orientation.end()
        self._io.publish(topics.CMD_VEL, m.CmdVel(vx=0.0, vy=0.0, omega=0.0))
