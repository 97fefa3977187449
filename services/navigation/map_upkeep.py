"""Keeps the costmap up to date beyond the lidar: lasting changes, low things, and what the base ran into."""

import math
from collections.abc import Sequence

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Array
from services.navigation.config import NavigationConfig
from services.navigation.motion.arm_load import ArmLoad
from services.navigation.motion.contacts import UnseenObstacles
from services.navigation.planning.changes import ChangesFile
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.low_things import LowThings


class MapUpkeep:
    """Owns the costmap `map` and the `contacts` in it; once a second updates, saves and publishes it."""

    def __init__(self, config: NavigationConfig, io: Io) -> None:
        self._io = io
        # Who makes the map takes lasting changes into it.
        lasting_after = math.inf if config.map == "mapping" else config.lasting_after
        self.map = Costmap(io.household, config.resolution, config.obstacle_memory, lasting_after)
        self._changes = ChangesFile(io.state_dir, io.household, lambda why: io.log.warning("map", reason=why))
        if self._changes.load(self.map.obstacles.changes):
            self.map.obstacles.remember(0.0)
        self.contacts = UnseenObstacles(self.map, config.footprint_radius)
        self._low, self._arm = LowThings(self.map), ArmLoad()
        self._second = -1

    def see(self, unmapped: Array, now: float) -> None:
        """Take the points (n, 2) [map] of a scan that the map does not explain."""
        self._low.see(unmapped, now)

    def step(self, objects: Sequence[m.WorldObject], now: float) -> None:
        """Update the costmap once a second; `objects` are those of perception's newest report. In each step: whether
        the arm has run into something."""
        self.contacts.felt = self._arm.presses(self._io.latest(topics.JOINT_STATES))
        if int(now) == self._second:
            return
        self._second = int(now)
        self._changes.save(self.map.obstacles.changes, now)
        self.contacts.forget(now)
        self._low.place(objects)
        if self._io.has_subscribers(topics.COSTMAP):
            self._io.publish(topics.COSTMAP, self.map.picture(now))
