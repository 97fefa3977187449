"""Where the base may go for a goal: by the household as people call it now, and by what perception has reported."""

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
    """`goals` is what words and poses mean in the household, `coverage` what searches have looked at."""

    def __init__(self, config: NavigationConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._places = load("places", PlacesFile, config_dir(), {})
        self._approaches = ApproachHistory()
        self._goal_id = ""
        self._learn_names()
        self.coverage = SearchCoverage(viewpoints_of(io.household, None))

    @property
    def watched(self) -> bool:
        """Perception is there to report objects."""
        return self._io.peer("perception") is not None

    def _learn_names(self) -> None:
        self._named = self._io.household
        self.goals = Goals(self._named, Places(self._named, self._places), self._config)

    def goal_sent(self, goal_id: str, item: str) -> None:
        """Before any other call for a goal; `item`: before which it is, "" for anything else."""
        if self._io.household is not self._named:
            self._learn_names()
        self._goal_id = goal_id
        self._approaches.goal_sent(item)

    def arrived(self, pose: Pose2 | None) -> None:
        """The goal has been reached."""
        self._approaches.arrived(self._goal_id, pose)

    def standing_at(self, goal: m.NavGoal) -> Choices:
        """The pose of a goal and those before its object; raises `Ended` BAD_POSE."""
        return self._approaches.penalised(self._goal_id, self.goals.pose(goal, self.objects()))

    def before(self, item: str) -> Choices:
        """Before each reported object that the words can mean; empty when none is known."""
        return self._approaches.penalised(self._goal_id, self.goals.seen(item, self.objects()))

    def known(self, item: str) -> bool:
        """The words can mean a reported object."""
        return self.goals.known(item, self.objects())

    def search(self, item: str, now: float) -> Search:
        """A search by where the item and its like were seen and where they belong."""
        self.coverage.viewpoints = viewpoints_of(self._io.household, self._io.latest(topics.ROBOT_DESCRIPTION))
        seen = self._io.latest(topics.SIGHTINGS)
        rows, at = (seen.sightings, seen.t) if seen is not None else ([], 0.0)
        likely = likelihood(item, self._io.household, rows, at, self.coverage.viewpoints)
        return Search(item, self.coverage, self._config, now, likely)

    def objects(self) -> list[m.WorldObject]:
        """What perception has reported last."""
        reported = self._io.latest(topics.WORLD_OBJECTS)
        return reported.objects if reported else []
