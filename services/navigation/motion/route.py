"""Choice of a pose among several and of the path to it, kept until a clearly better one is found or it is blocked."""

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple

from common.approach import WAY_COST
from common.geometry import Point, Pose2
from services.navigation.config import NavigationConfig
from services.navigation.motion.obstacle_tracker import Obstacle
from services.navigation.motion.path_follower import PathFollower
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

REPLAN_PERIOD = 1.0
"""Least time between two plans [s]; chosen: what the lidar sees seldom changes faster."""
STRAYED_PERIOD = 0.2
"""The same while it stands off its path, with a wall between [s]: four steps."""
DETOUR_PAUSE = 4.0
"""Time after a detour before another path counts as one [s]; chosen: until then the same obstacle shows more sides."""
SHORTER = 0.85
"""A new path replaces a free one only if it is this much shorter [-]; chosen: so that it does not waver between two."""
HERE = 0.05
"""A pose this near is where the robot stands [m], free or not: the costmap's resolution."""
ROUND = 1.0
"""How much longer a detour is that leads another way and not just round something [m]; chosen: round a person."""
BY = 1.0
"""Who is within this of where a path is blocked is what blocks it [m]: a footprint, and a step since it was seen."""
TOUCHING = 0.02
"""How much closer than its footprint an obstacle must be to block a path [m]: the costmap's rounding."""

Found = Literal["", "kept", "new", "detour"]
"""What a plan has brought: no path, the old one, another, or another because something blocks the old one."""

Blocker = Literal["people", "newcomers", "things"]
"""What blocks every way: people, what has come lately and may be somebody who stands, or what stands there for long."""


class Shut(NamedTuple):
    """A path in which somebody or something stands `at` [map], seen first at `since` [s], with `left` [m] to go."""

    at: Point
    since: float
    left: float


class Route:
    """The chosen pose and its path. `choices`: poses [map] with penalties [m]; `follower`: of the path, or None."""

    def __init__(
        self, config: NavigationConfig, costmap: Costmap, planner: PathPlanner, choices: list[tuple[float, Pose2]]
    ) -> None:
        self._map, self._planner, self.choices = costmap, planner, choices
        self._lookahead, self._corridor, self._speed = config.lookahead, config.corridor, config.usual_speed
        self._radius = config.footprint_radius - TOUCHING
        self.follower: PathFollower | None = None
        self.detour_at = -math.inf
        self.planned_at = -math.inf
        self._planned_version = -1
        self._new_path: list[Point] | None = None
        self._shut: Shut | None = None
        self._given_up: Point | None = None

    @property
    def outdated(self) -> bool:
        """True when the costmap has changed since the last plan, or the robot waits for somebody in the path."""
        return self._map.version != self._planned_version or self.waits

    @property
    def waits(self) -> bool:
        """True while another path is known, but waiting for the first one to become free is expected to be quicker."""
        return self._shut is not None

    def due(self, now: float, period: float = REPLAN_PERIOD) -> bool:
        """True when the last plan was made more than `period` [s] ago."""
        return now - self.planned_at > period

    def take_new_path(self) -> list[Point] | None:
        """The path, the first time that it is asked for after a change, else None."""
        path, self._new_path = self._new_path, None
        return path

    def possible(self, pose: Pose2) -> bool:
        """True when the static map alone has a path to one of the choices."""
        return self._planner.possible((pose[0], pose[1]), [(goal[0], goal[1]) for _, goal in self.choices])

    def blocked_by(self, pose: Pose2, now: float) -> Blocker:
        """What has to go away for there to be a path: only people, also what came lately, or what stands for long."""
        here, goals = (pose[0], pose[1]), [(goal[0], goal[1]) for _, goal in self.choices]
        if self._planner.possible(here, goals, self._map.distance_to_things()):
            return "people"
        if self._planner.possible(here, goals, self._map.distance_to_things(now)):
            return "newcomers"
        return "things"

    def plan(self, pose: Pose2, now: float, people: Sequence[Obstacle] = ()) -> Found:
        """Choose the pose to stand at and the path there; changes nothing where no path is found.

        Somebody of the `people` around who stands in the path is waited for as long as another way would take longer,
        which at worst takes twice the time of who knew what they do. The other way, once it is gone, is not given up
        for the first one until it is blocked as well, or what stood there is seen to be gone.
        """
        field = self._planner.field(pose[0], pose[1])
        costs = []
        for penalty, goal in self.choices:
            here = math.hypot(goal[0] - pose[0], goal[1] - pose[1]) < HERE
            if here or self._planner.free(goal[0], goal[1]):
                cost = self._planner.cost_to(field, (goal[0], goal[1]))
                costs.append((penalty + WAY_COST * cost, goal))
        self.planned_at, self._planned_version = now, self._map.version
        score, goal = min(costs, default=(math.inf, (0.0, 0.0, 0.0)))
        path = self._planner.path(field, (pose[0], pose[1]), (goal[0], goal[1])) if math.isfinite(score) else None
        if path is None:
            return ""
        follower = PathFollower(path, goal, self._lookahead, self._corridor)
        old = self.follower
        found: Found = "new"
        if old is not None and self.blocked_at(pose) is None:
            self._shut = None
            if self._goes_round(pose) or follower.remaining(pose) > SHORTER * old.remaining(pose):
                return "kept"
        else:
            shut = self._shut = self._now_shut(pose, now)
            extra = follower.remaining(pose) - shut.left if shut is not None else 0.0
            if shut is not None and self._waits_for(extra, shut, people, now):
                return "kept" if old is not None else ""
            self._given_up = shut.at if shut is not None and extra > ROUND else None
            if old is not None and now - self.detour_at > DETOUR_PAUSE:
                self.detour_at, found = now, "detour"
        self.follower, self._new_path, self._shut = follower, path, None
        return found

    def abandon(self) -> None:
        """Forget the path, and every reason to keep to one."""
        self.follower = self._shut = self._given_up = None

    def _now_shut(self, pose: Pose2, now: float) -> Shut | None:
        """The blocked path: where it is blocked now or, once the path has been given up, as noted before."""
        old, before = self.follower, self._shut
        if old is None:
            return before
        at = old.ahead(self.blocked_at(pose) or 0.0)
        return before._replace(at=at) if before is not None else Shut(at, now, old.remaining(pose))

    def _waits_for(self, extra: float, shut: Shut, people: Sequence[Obstacle], now: float) -> bool:
        """True while waiting for a person in the path seems quicker than a path that is `extra` [m] longer."""
        somebody = any(math.dist((o.x, o.y), shut.at) < BY + o.radius for o in people)
        return somebody and extra > max(ROUND, (now - shut.since) * self._speed)

    def _goes_round(self, pose: Pose2) -> bool:
        """True while the robot is on a detour and cannot see yet whether the first path is free again."""
        if self._given_up is not None and self._map.line_clearance((pose[0], pose[1]), self._given_up) > 0.0:
            self._given_up = None
        return self._given_up is not None

    def blocked_at(self, pose: Pose2) -> float | None:
        """How far ahead [m] something that was seen blocks the path; None when it is clear, or there is no path."""
        return self.follower.blocked_at(pose, self._map, self._radius) if self.follower is not None else None
