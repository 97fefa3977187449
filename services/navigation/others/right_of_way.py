"""The right of way where two robots meet: which goes first, and whether the other waits or gets out of the way. Pure.

Of two robots that drive the one whose name comes first in the alphabet goes first. One that finds no room to let
the other pass says so, and then goes first. A robot with nothing to do makes way for everybody who drives.
"""

import math
from collections.abc import Sequence

import numpy as np

from common.geometry import Array, Pose2
from common.messages import DriveState
from services.navigation.motion.path_follower import Lookahead, PathFollower
from services.navigation.others.motion import GAP, Other, Way, escapes, passes
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

AHEAD = 5.0
"""Way [m] of another robot that is kept clear: what it drives in the horizon of the prediction."""
STOP = 0.7
"""Way left [m] to where the other's begins at which a robot stops: the path follower's lookahead and a braking way."""
SURE = 0.4
"""For how long [s] the way has to be clear before it goes on; chosen: two messages of the other one."""
SEARCH = 0.5
"""Time between two searches for a place aside [s]; chosen: each takes some 20 ms."""
FARTHEST = 9.0
"""Cost of the way to a place aside [m] at most; chosen: out of a corridor, or through a room."""
SPREAD, TRIED = 0.3, 40
"""Distance between places that are tried [m], and how many at most [count]; chosen: half a footprint."""
ROOM = 0.05
"""What a place aside is farther from the other's way than it has to be [m]; chosen: the base's accuracy."""
STUCK = 12.0
"""For how long [s] a robot that found no room goes first; chosen: time for the other one to get out of its way."""


def goes_first(me: str, state: DriveState, stuck: bool, other: str, their_state: DriveState, they_stuck: bool) -> bool:
    """True when the other robot does; `stuck`: this one finds no room to let it pass, `they_stuck` the same of it."""
    if their_state != "driving" or state == "fixed":
        return False
    if state == "free":
        return True
    if stuck != they_stuck:
        return they_stuck
    return other < me


class RightOfWay:
    """How a robot of `radius` [m] gives way: `for_whom` are the robots it does so for, `stuck` those it cannot.

    `corridor` and `lookahead` [m] are the path follower's.
    """

    def __init__(
        self, costmap: Costmap, planner: PathPlanner, radius: float, corridor: float, lookahead: float
    ) -> None:
        self._map, self._planner = costmap, planner
        self._radius, self._corridor, self._lookahead = radius, corridor, lookahead
        self.for_whom: list[str] = []
        self._stuck: dict[str, float] = {}
        self._follower: PathFollower | None = None
        self._clear_since: float | None = None
        self._searched = -math.inf

    @property
    def gives_way(self) -> bool:
        return bool(self.for_whom)

    @property
    def way(self) -> list[tuple[float, float]]:
        """The path [map] to the place where it waits, empty for a robot that waits where it is."""
        return self._follower.path if self._follower is not None else []

    def stuck(self, now: float) -> list[str]:
        """The robots for which it finds no room to give way."""
        return [name for name, since in self._stuck.items() if now - since < STUCK]

    def go_on(self) -> None:
        """Stop giving way: nobody is near any more."""
        self.for_whom, self._follower, self._clear_since = [], None, None

    def step(
        self, pose: Pose2, ahead: Array | None, first: Sequence[Other], points: Array | None, now: float
    ) -> Pose2 | None:
        """The pose [map] to go to while others go first; None when the robot may go on along its own path.

        `ahead` (n, 2) are the points of its own way, None for a robot that drives nowhere; `first` are the robots that
        go first, `points` (n, 2) what the lidar sees.
        """
        if not first:
            self.go_on()
            return None
        first = [Other(o.name, o.way.cut(AHEAD), o.radius, o.stalled) for o in first]
        here = np.array([pose[:2]])
        in_way = [o for o in first if o.apart(here)[0] < self._needed(o)]
        if self._goes_on(here, ahead, first, in_way, now):
            self.go_on()
            return None
        if in_way and not self._aside(first) and now - self._searched >= SEARCH:
            self._searched = now
            self._follower = self._find(pose, first)
            if self._follower is None:
                self._stuck |= {o.name: now for o in in_way}
        elif not in_way and self._follower is not None and self._arrived(pose):
            self._follower = None
        self.for_whom = [o.name for o in first]
        if self._follower is None:
            return pose
        ahead_of: Lookahead = self._follower.step(pose, self._map, self._radius, points)
        return ahead_of.pose

    def _needed(self, o: Other) -> float:
        return self._radius + o.radius + GAP

    def _goes_on(
        self, here: Array, ahead: Array | None, first: Sequence[Other], in_way: Sequence[Other], now: float
    ) -> bool:
        if ahead is None or not len(ahead):
            clear = not in_way
        else:
            way = Way(np.vstack((here, ahead)))
            met = [o for o in first if not passes(way, self._radius, o)]
            clear = not met or (not in_way and all(self._far(way, o) for o in met))
        if not clear:
            self._clear_since = None
            return False
        if not self.gives_way:
            return True
        if self._clear_since is None:
            self._clear_since = now
        return now - self._clear_since >= SURE

    def _far(self, way: Way, o: Other) -> bool:
        """There is some way left before that of the other one begins."""
        near = o.apart(way.points) < self._needed(o)
        return not near.any() or float(way.lengths[int(np.argmax(near))]) > STOP

    # --- aside
    def _aside(self, first: Sequence[Other]) -> bool:
        """It is on its way to a place that is still out of everybody's."""
        if self._follower is None:
            return False
        goal = np.array([self._follower.goal[:2]])
        return all(o.apart(goal)[0] >= self._needed(o) for o in first)

    def _arrived(self, pose: Pose2) -> bool:
        return self._follower is not None and math.dist(pose[:2], self._follower.goal[:2]) < ROOM

    def _find(self, pose: Pose2, first: Sequence[Other]) -> PathFollower | None:
        """The way to the nearest place where everybody gets past; None where none can be reached."""
        here = (pose[0], pose[1])
        costs = self._planner.field(*here)
        rows, columns = np.nonzero(costs.cost < FARTHEST)
        if not len(rows):
            return None
        cells = np.asarray(self._map.origin + (np.stack((columns, rows), axis=1) + 0.5) * self._map.resolution)
        for o in first:
            out = o.apart(cells) >= self._needed(o) + ROOM
            rows, columns, cells = rows[out], columns[out], cells[out]
        order = np.argsort(costs.cost[rows, columns], kind="stable")
        _, best = np.unique(np.floor(cells[order] / SPREAD), axis=0, return_index=True)
        for number in order[np.sort(best)][:TRIED]:
            spot = (float(cells[number, 0]), float(cells[number, 1]))
            path = self._planner.path(costs, here, spot)
            if path is not None and all(escapes(Way(np.array(path)), self._radius, o) for o in first):
                return PathFollower(path, (*spot, pose[2]), self._lookahead, self._corridor)
        return None
