"""The other robots of the flat: drive intents received and sent, and the right of way between them and this robot."""

import math
from dataclasses import dataclass

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Array, Point, Pose2
from common.mission_log.states import under_way
from services.navigation.config import NavigationConfig
from services.navigation.motion.navigator import Navigator
from services.navigation.others.motion import NEAR, Other, Way, closes_in
from services.navigation.others.right_of_way import AHEAD, RightOfWay, goes_first
from services.navigation.planning.changes import fingerprint
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

PERIOD = 0.2
"""Time between two messages [s]: the rate of the topic."""
OWN = 0.2
"""How far beyond another robot's footprint points are still its own [m]: what it drives until the next message."""
SILENT = 1.5
"""Silence after which a robot is taken for what the lidar sees of it [s]; chosen: seven messages."""
THIN, TOLD = 4, 120
"""Of its path a robot tells each so many-th point, of so many at most [count]: 0.2 m apart, 6 m ahead."""
DENSE = 0.1
"""Between the points of another robot's way [m]: as dense as the distance between two ways has to be known."""
MOVING = 1.0
"""Time [s] after its last move in which a robot that gets out of the way is waited for."""
STILL, STALLED = 0.05, 4.0
"""Way [m] within which a robot stands still, and for how long [s] it does before it counts as what stands there."""
UNMOVED = 30.0
"""For how long [s] a robot that should make way and does not move counts as fixed; chosen: somebody has braked it."""


@dataclass
class _Known:
    """What was heard last of a robot, when its message changed, and where and since when it stands."""

    told: m.DriveIntent
    at: float
    stood: Point
    since: float


class Neighbours:
    """The other robots: `first` go first, `others` make way for this one.

    In the `circles` (x, y, radius) [map, m] lidar points are of one of them.
    """

    def __init__(self, config: NavigationConfig, io: Io, costmap: Costmap, planner: PathPlanner) -> None:
        self._config, self._io, self._map = config, io, costmap
        self.right_of_way = RightOfWay(costmap, planner, config.footprint_radius, config.corridor, config.lookahead)
        self._heard: dict[str, _Known] = {}
        self._known: dict[str, _Known] = {}
        self._told_at = -math.inf
        self._unmoved_until = -math.inf
        self._stood: tuple[Point, float] = ((math.inf, math.inf), 0.0)
        self._plan = fingerprint(io.household)
        self.state: m.DriveState = "fixed"
        self.circles: list[tuple[float, float, float]] = []
        self.first: list[Other] = []
        self.others: list[Other] = []

    @property
    def alone(self) -> bool:
        """True for a robot without a name, which cannot have others on its router."""
        return not self._io.robot or self._config.flat == "none"

    @property
    def flat(self) -> str:
        """The flat's identifier, the same for all its robots: by configuration, the simulation's world or the map."""
        if self._config.flat:
            return self._config.flat
        status = self._io.latest(topics.SIM_STATUS)
        return f"{self._plan}/{status.epoch}" if status is not None else self._plan

    # --- hearing
    def hear(self, pose: Pose2 | None, driving: bool, now: float) -> None:
        """Take the newest drive intents of the others; `driving`: this robot has a goal."""
        if self.alone:
            return
        for name, told in self._io.others(topics.DRIVE_INTENT).items():
            if told.flat == self.flat and all(map(math.isfinite, (told.x, told.y, told.radius))):
                self._note(name, told, now)
        self._known = {n: k for n, k in self._heard.items() if now - k.at < SILENT}
        self.circles = [(k.told.x, k.told.y, k.told.radius + OWN) for k in self._known.values()]
        self.state = self._standing(pose, driving, now)
        if self.state == "fixed":
            self.right_of_way.go_on()
        me, stuck = self._io.robot, self.right_of_way.stuck(now)

        self.first, self.others, fixed = [], [], []
        for name, k in sorted(self._known.items()):
            told = k.told
            if self._stands(told):
                fixed.append((told.x, told.y, told.radius))
            elif goes_first(me, self.state, name in stuck, name, told.state, me in told.cannot_yield_to):
                self.first.append(_other(name, k, now))
            else:
                self.others.append(_other(name, k, now))
        self._map.obstacles.disown(self.circles)
        self._map.place(fixed, "robots")

    def _note(self, name: str, told: m.DriveIntent, now: float) -> None:
        old, here = self._heard.get(name), (told.x, told.y)
        if old is None:
            self._heard[name] = _Known(told, now, here, now)
        elif told is not old.told:
            old.told, old.at = told, now
            if math.dist(here, old.stood) > STILL:
                old.stood, old.since = here, now

    def _stands(self, told: m.DriveIntent) -> bool:
        """True for a robot that does not get out of the way, and so is an obstacle."""
        if told.state == "free":
            return self._io.robot in told.cannot_yield_to
        return told.state == "fixed"

    def _standing(self, pose: Pose2 | None, driving: bool, now: float) -> m.DriveState:
        """Whether this robot drives, may be asked to make way, or stays."""
        if pose is None or math.dist(pose[:2], self._stood[0]) > STILL:
            self._stood = ((pose[0], pose[1]) if pose is not None else self._stood[0]), now
        if self.right_of_way.way and now - self._stood[1] > STALLED:
            self._unmoved_until = now + UNMOVED
        if now < self._unmoved_until:
            return "fixed"
        brain = self._io.latest(topics.BRAIN_STATE)
        idle = brain is not None and not under_way(brain)
        return "driving" if driving else "free" if idle else "fixed"

    # --- giving way
    def steer(self, navigator: Navigator | None, pose: Pose2 | None, points: Array | None, now: float) -> Pose2 | None:
        """The pose [map] to go to while others go first; None when the robot may go on along its own path.

        `navigator` drives it, None where it drives nowhere; `points` (n, 2) is what the lidar sees.
        """
        if self.alone or pose is None or (navigator is not None and not navigator.begun):
            return None
        right, ahead = self.right_of_way, None
        if navigator is not None:
            navigator.waiting.robots = [(*o.place, o.radius) for o in (*self.first, *self.others)]
            ahead = np.array(navigator.ahead(pose, now)) if self.first else None
        was = right.gives_way
        spot = right.step(pose, ahead, self.first, points, now)
        if spot is None and navigator is not None and self._too_near(pose, navigator, now):
            return pose
        if was != right.gives_way:
            self._stood = (pose[0], pose[1]), now
            self._io.log.info("gives way" if right.gives_way else "goes on", to=",".join(right.for_whom))
            if navigator is not None and spot is None:
                navigator.go_on(now)
        return spot

    def _too_near(self, pose: Pose2, navigator: Navigator, now: float) -> bool:
        """True while another robot that makes way has not done so yet."""
        near = [
            o for o in self.others if now - self._known[o.name].since < MOVING and math.dist(pose[:2], o.place) < NEAR
        ]
        if not near or not (ahead := navigator.ahead(pose, now)):
            return False
        way = Way(np.array([pose[:2], *ahead])).cut(AHEAD)
        return any(closes_in(way, self._config.footprint_radius, o) for o in near)

    # --- telling
    def tell(self, pose: Pose2 | None, path: list[Point], now: float) -> None:
        """Publish this robot's drive intent, five times a second."""
        if self.alone or pose is None or now - self._told_at < PERIOD - 1e-6:
            return
        self._told_at = now
        right = self.right_of_way
        if right.gives_way:
            path = right.way
        kept = path[:TOLD]
        self._io.publish(
            topics.DRIVE_INTENT,
            m.DriveIntent(
                t=now,
                flat=self.flat,
                x=pose[0],
                y=pose[1],
                theta=pose[2],
                radius=self._config.footprint_radius,
                state=self.state,
                path=kept[::THIN] + kept[-1:] if kept else [],
                gives_way_to=right.for_whom,
                cannot_yield_to=right.stuck(now),
            ),
        )


def _other(name: str, k: _Known, now: float) -> Other:
    way = Way(np.array([(k.told.x, k.told.y), *k.told.path], float))
    return Other(name, way.resampled(DENSE), k.told.radius, stalled=now - k.since > STALLED)
