"""`find` for an object that nobody has seen: a tour of viewpoints with an end."""

from common.geometry import Pose2
from services.navigation.config import NavigationConfig
from services.navigation.costmap import Costmap
from services.navigation.drive import Ended
from services.navigation.planner import PathPlanner
from services.navigation.tour import Memory, Tour


class Search:
    """`fresh`: the next view is due without a look from here."""

    def __init__(self, item: str, memory: Memory, config: NavigationConfig, now: float) -> None:
        self.item, self.fresh = item, False
        self.tour = Tour(memory, now, config.look_memory)
        self._config, self._until = config, now + config.find_timeout

    def timed_out(self, now: float) -> bool:
        """False, or raises `Ended` TIMEOUT."""
        if now > self._until:
            detail = f"no {self.item} after {self._config.find_timeout:.0f} s and {self.tour.looked} views"
            raise Ended("failed", "TIMEOUT", detail)
        return False

    def next(self, pose: Pose2, planner: PathPlanner, costmap: Costmap) -> Pose2:
        """The next view; raises `Ended` NOT_FOUND when none is left."""
        self.fresh = False
        view = self.tour.next(pose, planner, costmap, self._config.footprint_radius + self._config.clearance)
        if view is None:
            seen = f"{self.tour.looked} views show {self.tour.share():.0%} of the surfaces"
            raise Ended("failed", "NOT_FOUND", f"no {self.item}: {seen}")
        return view
