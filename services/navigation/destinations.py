"""Poses for a goal, by the household with its current names, perception's reports and where the base stood before."""

from common import messages as m
from common import topics
from common.bus.port import Io
from common.config import config_dir, load
from common.geometry import Pose2
from common.viewpoints import viewpoints_of
from common.whereabouts import likelihood
from services.navigation.approach_history import ApproachHistory
from services.navigation.config import NavigationConfig
from services.navigation.goals import Choices, Goals
from services.navigation.places import Places, PlacesFile
from services.navigation.search.coverage import SearchCoverage
from services.navigation.search.search import Search


class Destinations:
    """Finds the poses of each goal; `goals` translates goals to poses, `coverage` is what searches have looked at."""

    def __init__(self, config: NavigationConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._places = load("places", PlacesFile, config_dir(), {})
        self._approaches = ApproachHistory()
        self._goal_id = ""
        self._learn_names()
        self.coverage = SearchCoverage(viewpoints_of(io.household, None))

    @property
    def watched(self) -> bool:
        """True while perception runs, or may run: objects in view will be reported."""
        return self._io.peer("perception") is not None

    def _learn_names(self) -> None:
        self._named = self._io.household
        self.goals = Goals(self._named, Places(self._named, self._places), self._config)

    def goal_sent(self, goal_id: str, item: str) -> None:
        """Begin a goal; `item` is the object that it leads to, "" for none. Called before all else for this goal."""
        if self._io.household is not self._named:
            self._learn_names()
        self._goal_id = goal_id
        self._approaches.goal_sent(item)

    def arrived(self, pose: Pose2 | None) -> None:
        """Note that the goal was reached, with the base at `pose`."""
        self._approaches.arrived(self._goal_id, pose)

    def standing_at(self, goal: m.NavGoal) -> Choices:
        """The poses for a goal of `nav_goal`, those used before penalised; raises `Ended` BAD_POSE."""
        return self._approaches.penalised(self._goal_id, self.goals.pose(goal, self.objects()))

    def before(self, item: str) -> Choices:
        """Poses before every reported object that `item` can mean, used ones penalised; empty when there is none."""
        return self._approaches.penalised(self._goal_id, self.goals.before(item, self.objects()))

    def known(self, item: str) -> bool:
        """True when a reported object can be meant by the words `item`."""
        return self.goals.known(item, self.objects())

    def search(self, item: str, now: float) -> Search:
        """A new search for an item, which looks first where the item or its like was seen or belongs."""
        self.coverage.viewpoints = viewpoints_of(self._io.household, self._io.latest(topics.ROBOT_DESCRIPTION))
        seen = self._io.latest(topics.SIGHTINGS)
        rows, at = (seen.sightings, seen.t) if seen is not None else ([], 0.0)
        likely = likelihood(item, self._io.household, rows, at, self.coverage.viewpoints)
        return Search(item, self.coverage, self._config, now, likely)

    def objects(self) -> list[m.WorldObject]:
        """The objects of perception's newest report."""
        reported = self._io.latest(topics.WORLD_OBJECTS)
        return reported.objects if reported else []
