"""Search for an object that was not seen yet: viewpoint after viewpoint, until all is looked at or time is up."""

from common.geometry import Array, Pose2
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner
from services.navigation.search.coverage import SearchCoverage


class Search:
    """One search; `fresh`: the next viewpoint is due at once, without a look from where the base stands.

    `likelihood` (p,): how likely the item is at each point of the coverage, the mean being 1; None: nobody knows.
    """

    def __init__(
        self,
        item: str,
        coverage: SearchCoverage,
        config: NavigationConfig,
        now: float,
        likelihood: Array | None = None,
    ) -> None:
        self.item, self.fresh, self._likelihood = item, False, likelihood
        self._coverage, self._config, self._started = coverage, config, now
        self._tried: set[Pose2] = set()

    @property
    def looked(self) -> int:
        """Viewpoints that were taken or tried [count]."""
        return len(self._tried)

    def timed_out(self, now: float) -> bool:
        """Whether there is time for another viewpoint: returns False, or raises `Ended` TIMEOUT."""
        limit = self._config.find_timeout
        if now > self._started + limit:
            raise Ended("failed", "TIMEOUT", f"no {self.item} after {limit:.0f} s and {self.looked} views")
        return False

    def next(self, pose: Pose2, planner: PathPlanner, costmap: Costmap) -> Pose2:
        """The next viewpoint [map]; raises `Ended` NOT_FOUND when none is left."""
        self.fresh = False
        radius = self._config.footprint_radius + self._config.clearance
        field = planner.field(pose[0], pose[1])
        view = self._coverage.viewpoints.best(
            self._coverage.worth(self._started, self._config.look_memory),
            self._tried,
            cost=lambda to: planner.cost_to(field, (to[0], to[1])),
            free=lambda to: costmap.clearance(to[0], to[1]) >= radius,
            likelihood=self._likelihood,
        )
        if view is None:
            share = self._coverage.share(self._started)
            raise Ended("failed", "NOT_FOUND", f"no {self.item}: {self.looked} views show {share:.0%} of the surfaces")
        self._tried.add(view)
        return view
