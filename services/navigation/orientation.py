"""Preconditions of driving: the sensors report, and the robot knows where it is or finds out."""

from common import messages as m
from common import topics
from common.bus.port import Io
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.localisation.state_estimation import StateEstimator
from services.navigation.motion.reorientation import Reorientation
from services.navigation.planning.costmap import Costmap


class Orientation:
    """Checks sensors and localisation while there is a goal; drives a lost robot to where it can localise."""

    def __init__(self, config: NavigationConfig, io: Io, state: StateEstimator, costmap: Costmap) -> None:
        self._config, self._io, self._state, self._map = config, io, state, costmap
        self._reorientation: Reorientation | None = None

    @property
    def doing(self) -> str:
        """LOST or MAP_MISMATCH while the robot finds out where it is, else ""."""
        if self._reorientation is None:
            return ""
        return "LOST" if self._state.everywhere.map_fits else "MAP_MISMATCH"

    def check(self, now: float) -> None:
        """Check the sensors; raises `Ended` NO_ODOMETRY or NO_SCAN when one that has reported before is silent."""
        state = self._state
        age = state.silence(now)
        if state.pose is not None and age > self._config.odometry_timeout:
            raise Ended("failed", "NO_ODOMETRY", f"odometry silent for {age:.1f} s")
        if state.points is not None and self._io.age(topics.SCAN, now) > self._config.scan_timeout:
            raise Ended("failed", "NO_SCAN", "the lidar fell silent")

    def find(self, reached: list[m.GoalReached], now: float) -> None:
        """Publish the next target or standstill of a lost robot; raises `Ended` when this has lasted too long."""
        if self._reorientation is None:
            self._reorientation = Reorientation(self._config, self._io, self._state, self._map, now)
        target = self._reorientation.step(reached, now)
        if target is not None:
            self._io.publish(topics.BASE_TARGET, target)
        else:
            self._io.publish(topics.CMD_VEL, m.CmdVel(vx=0.0, vy=0.0, omega=0.0))

    def end(self) -> bool:
        """End the reorientation: the robot knows where it is, or has no goal any more; True when one was under way."""
        was, self._reorientation = self._reorientation, None
        return was is not None
