"""Random meetings of two robots in one flat: starts and goals."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from common.floor_plan import FloorPlan, Place, Wall
from common.geometry import Pose2
from common.household import Household, load_household, mapped
from services.navigation.config import NavigationConfig
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

APARTMENT = load_household("apartment")
CONFIG = NavigationConfig()
DOORS = (
    ((1.3, -0.75), (3.7, -0.75)),
    ((-0.45, 0.9), (-0.45, 3.1)),
    ((4.25, -0.1), (4.25, 2.1)),
    ((1.3, 3.2), (3.6, 3.2)),
)
"""Points on both sides of each door of the apartment."""


@dataclass(frozen=True)
class Meeting:
    """Starts and goals of two robots; a goal of None: the robot has nothing to do."""

    home: Household
    starts: tuple[Pose2, Pose2]
    goals: tuple[Pose2 | None, Pose2 | None]
    delay: float = 0.0


def corridor() -> Household:
    """Two rooms joined by a corridor of 1.1 m in which two robots cannot pass each other."""
    ways = [((0, 0), (13, 0)), ((13, 0), (13, 4)), ((13, 4), (0, 4)), ((0, 4), (0, 0))]
    for x in (4.0, 9.0):
        ways += [((x, 0), (x, 1.45)), ((x, 2.55), (x, 4))]
    ways += [((4, 1.45), (9, 1.45)), ((4, 2.55), (9, 2.55))]
    walls = tuple(Wall(start=a, end=b) for a, b in ways)
    home = Place(name="home", x=1.0, y=2.0, theta=0.0)
    return mapped(FloorPlan(name="corridor", low=(0.0, 0.0), high=(13.0, 4.0), home=home, walls=walls))


class Guide:
    """Free points and ways of a home."""

    def __init__(self, home: Household) -> None:
        self.costmap = Costmap(home, CONFIG.resolution, 1.0)
        self.planner = PathPlanner(self.costmap, CONFIG.footprint_radius + CONFIG.clearance, CONFIG.inflation)
        self._home = home

    def near(self, rng: np.random.Generator, at: tuple[float, float], spread: float) -> Pose2:
        """A free pose around a point."""
        while True:
            x, y = (np.array(at) + rng.uniform(-spread, spread, 2)).tolist()
            if self.costmap.clearance(x, y) > 0.4:
                return x, y, float(rng.uniform(-math.pi, math.pi))

    def anywhere(self, rng: np.random.Generator) -> Pose2:
        """A free pose from which the whole home can be reached."""
        low, high = np.array(self._home.low), np.array(self._home.high)
        home = (self._home.home.x, self._home.home.y)
        while True:
            x, y = rng.uniform(low, high).tolist()
            if self.costmap.clearance(x, y) > 0.4 and self.planner.path(self.planner.field(*home), home, (x, y)):
                return x, y, float(rng.uniform(-math.pi, math.pi))


def at_door(rng: np.random.Generator) -> Meeting:
    """A meeting of two robots that want through the same door, from both sides."""
    guide, (a, b) = Guide(APARTMENT), DOORS[int(rng.integers(len(DOORS)))]
    one, two = guide.near(rng, a, 0.4), guide.near(rng, b, 0.4)
    return Meeting(APARTMENT, (one, two), (guide.near(rng, b, 0.6), guide.near(rng, a, 0.6)), float(rng.uniform(0, 3)))


def in_corridor(rng: np.random.Generator) -> Meeting:
    """A meeting in a corridor through which both want and in which they cannot pass each other."""
    home = corridor()
    guide, x = Guide(home), rng.uniform(0.0, 1.0, 2)
    one, two = guide.near(rng, (2.0 + 2.0 * x[0], 2.0), 0.1), guide.near(rng, (11.0 - 2.0 * x[1], 2.0), 0.1)
    goals = guide.near(rng, (11.0, 2.0), 1.0), guide.near(rng, (2.0, 2.0), 1.0)
    return Meeting(home, (one, two), goals, float(rng.uniform(0, 6)))


def anywhere(rng: np.random.Generator) -> Meeting:
    """Two drives through the flat between places that are drawn."""
    guide = Guide(APARTMENT)
    while True:
        one, two, to_one, to_two = (guide.anywhere(rng) for _ in range(4))
        if math.dist(one[:2], two[:2]) > 1.2 and math.dist(to_one[:2], to_two[:2]) > 1.2:
            return Meeting(APARTMENT, (one, two), (to_one, to_two))


def swapped(rng: np.random.Generator) -> Meeting:
    """A meeting in which each robot goes to where the other one is."""
    guide = Guide(APARTMENT)
    while True:
        one, two = guide.anywhere(rng), guide.anywhere(rng)
        if math.dist(one[:2], two[:2]) > 2.5:
            return Meeting(APARTMENT, (one, two), (two, one))


def idle(rng: np.random.Generator) -> Meeting:
    """A meeting in which one robot stands in a door with nothing to do and the other wants through."""
    guide, (a, b) = Guide(APARTMENT), DOORS[int(rng.integers(len(DOORS)))]
    middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    driver = guide.near(rng, a, 0.4), guide.near(rng, b, 0.6)
    return Meeting(APARTMENT, ((*middle, float(rng.uniform(-3, 3))), driver[0]), (None, driver[1]))


KINDS: dict[str, Callable[[np.random.Generator], Meeting]] = {
    "door": at_door, "corridor": in_corridor, "anywhere": anywhere, "swapped": swapped, "idle in a door": idle,
}  # fmt: skip
