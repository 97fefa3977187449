"""Navigation: goals in words or poses -> paths on the costmap -> a stream of target poses for the base."""

import math

from common import messages as m
from common import topics
from common.config import config_dir
from common.geometry import Pose2
from common.io import Io
from common.scene import Receptacle
from services.navigation.config import NavigationConfig
from services.navigation.costmap import Costmap
from services.navigation.drive import Drive, Ended
from services.navigation.places import Places, load_places
from services.navigation.planner import PathPlanner
from services.navigation.senses import Senses
from services.navigation.standoff import poses_for


class NavigationService:
    """Drives the base to items, places and poses; `arrived` only after the base says that it is there."""

    NAME = "navigation"
    HZ = 20
    CONFIG = NavigationConfig
    READS = (
        topics.NAVIGATION_GOAL, topics.NAV_GOAL, topics.GOAL_REACHED, topics.ODOMETRY, topics.JOINT_STATES,
        topics.SCAN, topics.WORLD_OBJECTS, topics.ROBOT_STOP,
    )  # fmt: skip
    WRITES = (
        topics.NAVIGATION_STATUS, topics.NAVIGATION_FEEDBACK, topics.BASE_TARGET, topics.POSE, topics.NAV_PATH,
        topics.CMD_VEL,
    )  # fmt: skip

    def __init__(self, config: NavigationConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._places = Places(io.scene, load_places(config_dir()))
        self._map = Costmap(io.scene, config.resolution, config.obstacle_memory)
        self._planner = PathPlanner(self._map, config.footprint_radius + config.clearance, config.inflation)
        self._drive: Drive | None = None
        self._seen: set[tuple[str, int]] = set()
        self._senses = Senses(config, io, self._map)
        self._now = 0.0
        self._from_brain = True
        self._status = m.NavigationStatus(status="idle")
        io.publish(topics.NAVIGATION_STATUS, self._status)

    def step(self, now: float) -> None:
        io, self._now = self._io, now
        self._senses.step(now)
        if io.drain(topics.ROBOT_STOP) and self._drive:
            self._finish(Ended("failed", "STOPPED", "robot/stop"))
        for goal in io.drain(topics.NAVIGATION_GOAL):
            goal.id = goal.id or io.new_id("navigation")
            self._take(goal.id, goal.attempt, goal.goal.strip(), None)
        for pose in io.drain(topics.NAV_GOAL):
            self._take(pose.id, pose.attempt, "", pose)
        reached = io.drain(topics.GOAL_REACHED)
        if self._drive is not None:
            self._advance(reached, now)

    # --- goals
    def _take(self, goal_id: str, attempt: int, text: str, pose: m.NavGoal | None) -> None:
        if (goal_id, attempt) in self._seen:
            self._publish(self._status)
            return
        self._seen.add((goal_id, attempt))
        if self._drive is not None:
            self._finish(Ended("failed", "PREEMPTED", f"replaced by {text or 'a pose'}"))
        self._from_brain = pose is None
        self._status = m.NavigationStatus(status="navigating", goal_id=goal_id, attempt=attempt)
        self._io.log.info("goal", goal=text or "pose", id=goal_id, attempt=attempt)
        if text == "stop":
            self._hold()
            self._report("idle", "STOPPED", "the base holds")
            return
        try:
            choices = self._pose_choices(pose) if pose else self._choices(text)
        except Ended as ended:
            self._finish(ended)
            return
        self._drive = Drive(self._config, self._map, self._planner, choices, f"{goal_id}/{attempt}", self._now)
        self._report("navigating", "", text)

    def _choices(self, text: str) -> list[tuple[float, Pose2]]:
        """Base poses that fulfil a goal in words, with penalties.

        Raises:
            Ended: an unknown goal, place or object.
        """
        verb, _, rest = text.partition(" ")
        rest = rest.strip()
        if text == "return_to_start":
            return [(0.0, self._places.home)]
        if verb == "goto" and rest:
            place = self._places.place(rest)
            if place is None:
                raise Ended("failed", "UNKNOWN_PLACE", f"no place {rest!r}; known: {self._places.similar(rest)}")
            return self._before(place) if isinstance(place, Receptacle) else [(0.0, place)]
        if verb == "find" and rest:
            reported = self._io.latest(topics.WORLD_OBJECTS)
            found = self._places.item(rest, reported.objects if reported else [])
            if found is None:
                raise Ended("failed", "UNKNOWN_OBJECT", f"nobody has seen a {rest} and places.toml has no spot for it")
            if isinstance(found, tuple):
                return [(0.0, found)]
            config = self._config
            return [
                choice
                for o in found
                for choice in poses_for(
                    (o.position[0], o.position[1]),
                    self._places.receptacle_of(o),
                    config.stand_off,
                    config.edge_distance,
                )
            ]
        raise Ended("failed", "UNKNOWN_GOAL", f"{text!r}: expected find, goto, return_to_start or stop")

    def _before(self, r: Receptacle) -> list[tuple[float, Pose2]]:
        if r.name == self._io.scene.delivery:
            return [(0.0, self._places.home)]
        return poses_for((r.center[0], r.center[1]), r, self._config.stand_off, self._config.edge_distance)

    def _pose_choices(self, goal: m.NavGoal) -> list[tuple[float, Pose2]]:
        if goal.frame != "map":
            raise Ended("failed", "BAD_POSE", f"frame {goal.frame!r}: only map is known")
        low, high = self._io.scene.low, self._io.scene.high
        if not all(map(math.isfinite, (goal.x, goal.y, goal.theta))):
            raise Ended("failed", "BAD_POSE", "the pose is not finite")
        if not (low[0] <= goal.x <= high[0] and low[1] <= goal.y <= high[1]):
            raise Ended("failed", "BAD_POSE", f"({goal.x:.2f}, {goal.y:.2f}) is outside the map")
        return [(0.0, (goal.x, goal.y, goal.theta))]

    # --- driving
    def _advance(self, reached: list[m.GoalReached], now: float) -> None:
        drive = self._drive
        assert drive is not None
        senses = self._senses
        age = senses.silence(now)
        if senses.pose is not None and age > self._config.odometry_timeout:
            self._finish(Ended("failed", "NO_ODOMETRY", f"odometry silent for {age:.1f} s"))
            return
        if senses.points is not None and self._io.age(topics.SCAN, now) > self._config.scan_timeout:
            self._finish(Ended("failed", "NO_SCAN", "the lidar fell silent"))
            return
        try:
            target = drive.step(senses.pose, reached, senses.points, now)
        except Ended as ended:
            self._finish(ended)
            return
        if target is not None:
            target.x, target.y, target.theta = senses.localiser.to_odometry((target.x, target.y, target.theta))
            self._io.publish(topics.BASE_TARGET, target)
        if path := drive.take_new_path():
            self._io.publish(topics.NAV_PATH, m.NavPath(t=now, points=path[::4], goal_id=self._status.goal_id))
            self._feedback()
        elif drive.due_feedback(now):
            self._feedback()

    def _finish(self, ended: Ended) -> None:
        if ended.status == "failed" and self._drive is not None and self._senses.pose is not None:
            self._hold()
        self._report(ended.status, ended.code, ended.detail)
        self._drive = None
        log = self._io.log.info if ended.status == "arrived" else self._io.log.warning
        log(ended.status, id=self._status.goal_id, code=ended.code, detail=ended.detail)

    def _hold(self) -> None:
        """Brake: a velocity stream that falls silent at once."""
        self._drive = None
        self._io.publish(topics.CMD_VEL, m.CmdVel(vx=0.0, vy=0.0, omega=0.0))

    def _report(self, status: m.NavStatus, code: str, detail: str) -> None:
        old = self._status
        self._status = m.NavigationStatus(
            status=status, goal_id=old.goal_id, attempt=old.attempt, code=code, detail=detail
        )
        self._publish(self._status)

    def _publish(self, status: m.NavigationStatus) -> None:
        if self._from_brain:
            self._io.publish(topics.NAVIGATION_STATUS, status)
        self._feedback()

    def _feedback(self) -> None:
        status, drive = self._status, self._drive
        left = drive.remaining if drive else 0.0
        feedback = m.NavigationFeedback(
            goal_id=status.goal_id,
            status=status.status,
            distance_remaining=left,
            eta=left / 0.4,
            recoveries=drive.recoveries if drive else 0,
            code=status.code,
        )
        self._io.publish(topics.NAVIGATION_FEEDBACK, feedback)
