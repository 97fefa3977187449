"""Goals in words or poses to candidate poses of the base."""

import math

from common import messages as m
from common.geometry import Pose2
from common.scene import Receptacle, Scene
from services.navigation.config import NavigationConfig
from services.navigation.drive import Ended
from services.navigation.places import Places
from services.navigation.standoff import poses_for

# Candidate poses, each with a penalty [m].
Choices = list[tuple[float, Pose2]]


class Goals:
    """Every method raises `Ended` when the goal cannot be meant."""

    def __init__(self, scene: Scene, places: Places, config: NavigationConfig) -> None:
        self._scene, self._places, self._config = scene, places, config

    def home(self) -> Choices:
        return [(0.0, self._places.home)]

    def place(self, name: str) -> Choices:
        """Raises `Ended` UNKNOWN_PLACE."""
        place = self._places.place(name)
        if place is None:
            raise Ended("failed", "UNKNOWN_PLACE", f"no place {name!r}; known: {self._places.similar(name)}")
        if not isinstance(place, Receptacle):
            return [(0.0, place)]
        if place.name == self._scene.delivery:
            return self.home()
        return self._before((place.center[0], place.center[1]), place)

    def pose(self, goal: m.NavGoal) -> Choices:
        """Raises `Ended` BAD_POSE."""
        if goal.frame != "map":
            raise Ended("failed", "BAD_POSE", f"frame {goal.frame!r}: only map is known")
        low, high = self._scene.low, self._scene.high
        if not all(map(math.isfinite, (goal.x, goal.y, goal.theta))):
            raise Ended("failed", "BAD_POSE", "the pose is not finite")
        if not (low[0] <= goal.x <= high[0] and low[1] <= goal.y <= high[1]):
            raise Ended("failed", "BAD_POSE", f"({goal.x:.2f}, {goal.y:.2f}) is outside the map")
        return [(0.0, (goal.x, goal.y, goal.theta))]

    def seen(self, item: str, objects: list[m.WorldObject]) -> Choices:
        """Before each object that the words can mean; empty when none is known."""
        return [
            choice
            for o in self._places.matching(item, objects)
            for choice in self._before((o.position[0], o.position[1]), self._places.receptacle_of(o))
        ]

    def spot(self, item: str) -> Choices:
        """Where an item is looked for without eyes."""
        return [(0.0, self._places.spot(item) or self._config.find_spot)]

    def _before(self, point: tuple[float, float], receptacle: Receptacle | None) -> Choices:
        return poses_for(point, receptacle, self._config.stand_off, self._config.edge_distance)
