"""Whether a goal may drive: the sensors speak, and the robot knows where it is, or finds out."""

from common import messages as m
from common import topics
from common.bus.port import Io
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.localisation.state_estimation import StateEstimator
from services.navigation.motion.reorientation import Reorientation
from services.navigation.planning.costmap import Costmap


class Orientation:
    """Steps while there is a goal; a lost robot looks about and drives to where it can tell places apart."""

    def __init__(self, config: NavigationConfig, io: Io, state: StateEstimator, costmap: Costmap) -> None:
        self._config, self._io, self._state, self._map = config, io, state, costmap
        self._reorientation: Reorientation | None = None

    @property
    def doing(self) -> str:
        """LOST or MAP_MISMATCH while the goal waits for a robot that is lost, else ""."""
        if self._reorientation is None:
            return ""
        return "LOST" if self._state.everywhere.map_fits else "MAP_MISMATCH"

    def check(self, now: float) -> None:
        """Raises `Ended` NO_ODOMETRY or NO_SCAN when a sensor that spoke is silent."""
        state = self._state
        age = state.silence(now)
        if state.pose is not None and age > self._config.odometry_timeout:
            raise Ended("failed", "NO_ODOMETRY", f"odometry silent for {age:.1f} s")
        if state.points is not None and self._io.age(topics.SCAN, now) > self._config.scan_timeout:
            raise Ended("failed", "NO_SCAN", "the lidar fell silent")

    def find(self, reached: list[m.GoalReached], now: float) -> None:
        """One step of a lost robot. Raises `Ended` when it has looked for too long."""
        if self._reorientation is None:
            self._reorientation = Reorientation(self._config, self._io, self._state, self._map, now)
        target = self._reorientation.step(reached, now)
        if target is not None:
            self._io.publish(topics.BASE_TARGET, target)
        else:
            self._io.publish(topics.CMD_VEL, m.CmdVel(vx=0.0, vy=0.0, omega=0.0))

    def known(self) -> bool:
        """The robot knows where it is, or nobody wants it to drive; True when it was looking until now."""
        was, self._reorientation = self._reorientation, None
        return was is not None
