"""Homes of the generator with things that have habits, and what a robot saw of them over some days."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from common import messages as m
from common import topics
from common.bus.memory import MemoryBus, MemoryIo
from common.config import DEFAULT_DIR
from common.geometry import Array, Pose2
from common.household import Household, load_words, mapped
from common.viewpoints import Viewpoints, viewpoints_of
from evaluation.homes.home import draw_home
from services.brain.home.sighting_log import SightingLog
from services.navigation.config import NavigationConfig
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

CONFIG = NavigationConfig()
THINGS = (("mug", "mug"), ("book", "book"), ("can", "can"), ("ball", "ball"), ("keys", ""))
"""Names and kinds; nobody knows what kind keys are."""
DAY = 86400.0  # seconds
SEEN = 0.5
"""Share of the days on which the robot sees a thing."""
FAVOURITES, LOYALTY = 3, 0.8
"""Surfaces that a thing is mostly on, and the share of days on which it is on one of them."""
PROPER = 0.5
"""Share of things one of whose favourites is where their kind belongs; the others' are anywhere."""


@dataclass
class Place:
    """A home as navigation has it."""

    household: Household
    viewpoints: Viewpoints
    costmap: Costmap
    planner: PathPlanner

    def seconds(self, here: Pose2, there: Sequence[Pose2]) -> Array:
        """Time (n,) to drive to each pose and look; inf where there is no way."""
        field = self.planner.field(here[0], here[1])
        ways = np.array([self.planner.cost_to(field, (p[0], p[1])) for p in there])
        seconds: Array = ways / CONFIG.usual_speed + CONFIG.look_time
        return seconds


def homes(count: int, seed: int) -> Iterator[tuple[int, Place]]:
    words = load_words(DEFAULT_DIR)
    for n in range(seed, seed + count):
        household = mapped(draw_home(n, ()), words)
        costmap = Costmap(household, CONFIG.resolution, CONFIG.obstacle_memory)
        planner = PathPlanner(costmap, CONFIG.footprint_radius + CONFIG.clearance, CONFIG.inflation)
        yield n, Place(household, viewpoints_of(household, None), costmap, planner)


def habits(place: Place, kind: str, rng: np.random.Generator) -> Array:
    """The share of days (s,) on which a thing is on each surface, by its number among those that are no bins."""
    surfaces = [r for r in place.household.receptacles if r.kind != "bin"]
    shares = np.array([r.size[0] * r.size[1] for r in surfaces])
    shares *= (1 - LOYALTY) / shares.sum()
    rule = next((d for d in place.household.words.tidy if kind in d.kinds), None)
    proper = [n for n, r in enumerate(surfaces) if rule is not None and {r.name, r.kind} & set(rule.to)]
    liked = rng.permutation(len(surfaces))[:FAVOURITES].tolist()
    if proper and rng.random() < PROPER:
        liked[0] = proper[int(rng.integers(len(proper)))]
    shares[liked] += LOYALTY * rng.dirichlet(np.ones(len(liked)))
    found: Array = shares / shares.sum()
    return found


def watched(place: Place, things: dict[str, tuple[str, Array]], days: int, rng: np.random.Generator) -> m.Sightings:
    """What the brain keeps of the days before."""
    surfaces = [r for r in place.household.receptacles if r.kind != "bin"]
    bus = MemoryBus()
    reads, writes = topics.subscribed("brain"), topics.published("brain")
    io = MemoryIo(bus, "brain", reads, writes, household=place.household, lockstep=False)
    log = SightingLog(io)
    for day in range(days):
        now, seen = (day + 0.5) * DAY, []
        for number, (thing, (kind, shares)) in enumerate(things.items()):
            where = surfaces[int(rng.choice(len(surfaces), p=shares))]
            if rng.random() < SEEN:
                seen.append(_object(thing, kind, where.name, where.center, now, number))
        bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=now, objects=seen))
        io.begin(None, now)
        log.step(now)
    return m.Sightings(t=days * DAY, sightings=list(log.rows))


def _object(thing: str, kind: str, on: str, position: m.Vec3, now: float, number: int) -> m.WorldObject:
    return m.WorldObject(label=thing, kind=kind, colour="", position=position, on=on, seen_at=now, id=str(number))
