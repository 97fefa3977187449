"""Driving a lost robot, carefully, to where the lidar can tell in which of several places it is."""

from common import messages as m
from common.bus.port import Io, Job
from common.geometry import Pose2
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.localisation.disambiguation import common_ground, most_telling
from services.navigation.localisation.state_estimation import StateEstimator
from services.navigation.motion.contacts import UnseenObstacles
from services.navigation.motion.navigator import Navigator
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

PAUSE = 2.0
"""Time for which it stands before it looks for a spot again, where it cannot move [s]; chosen: people walk on."""


class Reorientation:
    """The motion of a lost robot from when it gets a goal until it knows where it is; poses are in frame odom."""

    def __init__(self, config: NavigationConfig, io: Io, state: StateEstimator, costmap: Costmap, now: float) -> None:
        self._config, self._io, self._state, self._map = config, io, state, costmap
        self._began, self._stand_until = now, now
        self._ground: Costmap | None = None
        self._planner: PathPlanner | None = None
        self._spot: Job[Pose2 | None] | None = None
        self._navigator: Navigator | None = None
        self._places = 0
        self._drives = 0

    def step(self, reached: list[m.GoalReached], now: float) -> m.BaseTarget | None:
        """The next target pose [odom] for the base; None: it should stand.

        Raises:
            Ended: LOST or MAP_MISMATCH, after `lost_patience`.
        """
        state, known = self._state, self._state.everywhere
        if now - self._began > self._config.lost_patience:
            raise self._despair()
        if known.searching or not known.hypotheses or not known.map_fits or now < self._stand_until:
            return None
        if self._ground is None or self._planner is None or self._places != len(known.hypotheses):
            self._ground, self._planner = self._drivable()
            self._spot = self._navigator = None
        if state.fresh:
            state.mark(self._ground, state.odometry, now)
        if self._navigator is None:
            self._choose(self._ground, self._planner, now)
            return None
        try:
            return self._navigator.step(state.odometry, reached, state.points, (), now)
        except Ended as ended:
            self._io.log.info("looked elsewhere", status=ended.status, places=self._places)
            self._ground = self._navigator = None
            return None

    def _drivable(self) -> tuple[Costmap, PathPlanner]:
        """What is free wherever the robot may be."""
        config, state = self._config, self._state
        poses = [h.pose for h in state.everywhere.hypotheses]
        self._places = len(poses)
        radius = config.footprint_radius + config.clearance
        ground = common_ground(self._map, state.odometry, poses, radius + config.resolution)
        return ground, PathPlanner(ground, radius, config.inflation)

    def _choose(self, ground: Costmap, planner: PathPlanner, now: float) -> None:
        if self._spot is None:
            state = self._state
            poses = [h.pose for h in state.everywhere.hypotheses]
            args = (ground, planner, state.field, state.odometry, poses)
            self._spot = self._io.submit(most_telling, *args, seconds=0.2)
        elif self._spot.poll(now):
            spot, self._spot = self._spot.result(), None
            if spot is None:
                self._ground, self._stand_until = None, now + PAUSE
                return
            self._drives += 1
            self._io.log.info("drives to tell places apart", places=self._places)
            contacts = UnseenObstacles(ground, self._config.footprint_radius)
            self._navigator = Navigator(
                self._config, ground, planner, contacts, [(0.0, spot)], f"lost/{self._drives}", now
            )

    def _despair(self) -> Ended:
        known = self._state.everywhere
        if not known.map_fits:
            return Ended("failed", "MAP_MISMATCH", "nowhere in the map is what the lidar sees")
        places = len(known.hypotheses)
        return Ended("failed", "LOST", f"{places} places in the map look like this one" if places > 1 else "not sure")
