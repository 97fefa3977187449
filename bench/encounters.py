"""Two robots meet in one flat: do both arrive, how near do they come, what does it cost? `python -m bench.encounters`.

Two whole navigation services, each with its own lidar and wheels, drive in one kinematic world in which each is a body
that the other's lidar sees. Every meeting is driven with what robots tell each other of their ways and without it, and
by each of the two alone, which is what time lost is counted against. Exit 1 after a touch or a robot that did not
arrive, with the exchange.
"""

import argparse
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec
import numpy as np

from common import messages as m
from common import topics
from common.approach import HALF_WIDTH
from common.floor_plan import FloorPlan, Place, Wall
from common.geometry import Pose2, Rectangle
from common.household import Household, load_household, mapped
from services.navigation.config import NavigationConfig
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner
from tests.unit.navigation_flat import Flat

APARTMENT = load_household("apartment")
CONFIG = NavigationConfig()
NAMES = ("anna", "bert")
LIMIT = 150.0
"""Robot time [s] of one meeting."""
BODY = 2 * HALF_WIDTH
"""Side of a robot's base [m]."""
CORNER = 0.284
"""How far the rounded corners of its bumper are from its middle [m]."""
MET = 1.5
"""Two robots that came this near to each other have met [m]."""
DOORS = (
    ((1.3, -0.75), (3.7, -0.75)),
    ((-0.45, 0.9), (-0.45, 3.1)),
    ((4.25, -0.1), (4.25, 2.1)),
    ((1.3, 3.2), (3.6, 3.2)),
)
"""Points on both sides of each door of the apartment."""


@dataclass(frozen=True)
class Meeting:
    """Who starts where and goes where; a goal of None: it stands there with nothing to do."""

    home: Household
    starts: tuple[Pose2, Pose2]
    goals: tuple[Pose2 | None, Pose2 | None]
    delay: float = 0.0


@dataclass
class Outcome:
    """`took` [s] by robot, None for one that did not arrive; `nearest` [m] between the bodies; `codes` of failures."""

    took: list[float | None] = field(default_factory=list)
    nearest: float = math.inf
    codes: list[str] = field(default_factory=list)

    @property
    def arrived(self) -> bool:
        return None not in self.took


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
    """Both want through the same door, from both sides."""
    guide, (a, b) = Guide(APARTMENT), DOORS[int(rng.integers(len(DOORS)))]
    one, two = guide.near(rng, a, 0.4), guide.near(rng, b, 0.4)
    return Meeting(APARTMENT, (one, two), (guide.near(rng, b, 0.6), guide.near(rng, a, 0.6)), float(rng.uniform(0, 3)))


def in_corridor(rng: np.random.Generator) -> Meeting:
    """Both want through a corridor in which they cannot pass each other."""
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
    """Each wants to where the other is."""
    guide = Guide(APARTMENT)
    while True:
        one, two = guide.anywhere(rng), guide.anywhere(rng)
        if math.dist(one[:2], two[:2]) > 2.5:
            return Meeting(APARTMENT, (one, two), (two, one))


def idle(rng: np.random.Generator) -> Meeting:
    """One stands in a door with nothing to do, the other wants through."""
    guide, (a, b) = Guide(APARTMENT), DOORS[int(rng.integers(len(DOORS)))]
    middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    driver = guide.near(rng, a, 0.4), guide.near(rng, b, 0.6)
    return Meeting(APARTMENT, ((*middle, float(rng.uniform(-3, 3))), driver[0]), (None, driver[1]))


KINDS: dict[str, Callable[[np.random.Generator], Meeting]] = {
    "door": at_door, "corridor": in_corridor, "anywhere": anywhere, "swapped": swapped, "idle in a door": idle,
}  # fmt: skip


def body(pose: Pose2) -> Rectangle:
    return Rectangle(pose[0], pose[1], BODY, BODY, pose[2])


def gap(one: Pose2, two: Pose2) -> float:
    """Distance [m] between two bases; negative when they overlap."""
    found = math.inf
    for a, b in ((one, two), (two, one)):
        # The edge of one, as points, against the other's square without what its bumper's corners round off.
        c, s = math.cos(a[2]), math.sin(a[2])
        for u, v in _EDGE:
            x, y = a[0] + c * u - s * v, a[1] + s * u + c * v
            found = min(found, float(body(b).signed_distances(np.array(x), np.array(y))))
    return found


_SIDE = np.linspace(-HALF_WIDTH, HALF_WIDTH, 13)
_EDGE = [
    (u, v)
    for side in _SIDE.tolist()
    for u, v in ((side, HALF_WIDTH), (side, -HALF_WIDTH), (HALF_WIDTH, side), (-HALF_WIDTH, side))
    if math.hypot(u, v) <= CORNER
]


class Pair:
    """The two robots of a meeting, or with `alone` one of them."""

    def __init__(self, meeting: Meeting, exchange: bool, alone: int | None = None) -> None:
        self.meeting = meeting
        self.robots: dict[int, Flat] = {}
        for n in (0, 1) if alone is None else (alone,):
            x, y, theta = meeting.starts[n]
            home = msgspec.structs.replace(meeting.home, home=Place(name="home", x=x, y=y, theta=theta))
            robot = Flat(household=home)
            robot.true = robot.wheels = meeting.starts[n]
            robot.io.robot = NAMES[n] if exchange else ""
            robot.bus.send(topics.BRAIN_STATE, m.BrainState(state="WAITING"))
            self.robots[n] = robot
        if exchange and alone is None:
            for n, robot in self.robots.items():
                robot.bus.neighbours = {NAMES[1 - n]: self.robots[1 - n].bus}

    def step(self) -> None:
        """50 ms."""
        for n, robot in self.robots.items():
            other = self.robots.get(1 - n)
            robot.boxes = [body(other.true)] if other is not None else []
            robot.step()

    def run(self, watch: Callable[["Pair"], None] = lambda pair: None) -> Outcome:
        """Drive it to its end."""
        outcome = Outcome()
        took: dict[int, float | None] = {}
        begun: dict[int, float] = {}
        for _ in range(10):
            self.step()
        robots = {n: r for n, r in self.robots.items() if self.meeting.goals[n] is not None}
        start = next(iter(self.robots.values())).now
        while len(took) < len(robots):
            now = next(iter(self.robots.values())).now
            for n, robot in robots.items():
                goal = self.meeting.goals[n]
                assert goal is not None
                if n not in begun and now - start >= self.meeting.delay * n:
                    begun[n] = now
                    x, y, theta = goal
                    robot.bus.send(topics.NAV_GOAL, m.NavGoal(x=x, y=y, theta=theta, id=f"drive.{n}"))
                elif n in begun and n not in took and topics.NAVIGATION_FEEDBACK.key in robot.bus.last:
                    said = robot.feedback()
                    if said.status == "arrived":
                        took[n] = now - begun[n]
                    elif said.status == "failed" or now - start > LIMIT:
                        took[n] = None
                        outcome.codes.append(said.code or said.status)
            self.step()
            if len(self.robots) == 2:
                outcome.nearest = min(outcome.nearest, gap(self.robots[0].true, self.robots[1].true))
            watch(self)
        outcome.took = [took[n] for n in robots]
        return outcome


@dataclass
class Tally:
    """Of one kind of meeting, with or without the exchange."""

    meetings: int = 0
    met: int = 0
    arrived: int = 0
    touched: int = 0
    nearest: list[float] = field(default_factory=list)
    lost: list[float] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def add(self, seed: int, outcome: Outcome, alone: list[float | None]) -> None:
        self.meetings += 1
        self.met += outcome.nearest < MET
        self.arrived += outcome.arrived
        self.touched += outcome.nearest < 0.0
        if outcome.nearest < MET:
            self.nearest.append(outcome.nearest)
            self.lost += [t - a for t, a in zip(outcome.took, alone, strict=True) if t is not None and a is not None]
        if not outcome.arrived or outcome.nearest < 0.0:
            self.notes.append(f"seed {seed}: nearest {outcome.nearest:.2f} m, {', '.join(outcome.codes) or 'arrived'}")

    def row(self) -> str:
        near = f"{min(self.nearest):8.2f} {np.median(self.nearest):8.2f}" if self.nearest else f"{'-':>8} {'-':>8}"
        lost = f"{np.mean(self.lost):8.1f} {max(self.lost):8.1f}" if self.lost else f"{'-':>8} {'-':>8}"
        return f"{self.meetings:8} {self.met:8} {self.arrived:8} {self.touched:8} {near} {lost}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10, help="meetings of each kind (default %(default)s)")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", default="", help="kinds whose name contains this")
    parser.add_argument("--with", dest="ways", choices=("both", "exchange", "nothing"), default="both")
    args = parser.parse_args()
    ways = {"both": (True, False), "exchange": (True,), "nothing": (False,)}[args.ways]
    tallies = {(kind, way): Tally() for kind in KINDS if args.only in kind for way in ways}
    for kind in [k for k in KINDS if args.only in k]:
        for seed in range(args.first, args.first + args.seeds):
            meeting = KINDS[kind](np.random.default_rng([seed, 17]))
            drivers = [n for n in (0, 1) if meeting.goals[n] is not None]
            alone = [Pair(meeting, False, alone=n).run().took[0] for n in drivers]
            for way in ways:
                outcome = Pair(meeting, way).run()
                tallies[kind, way].add(seed, outcome, alone)
                print(
                    f"  {kind}, seed {seed}, {'told' if way else 'not told'}: {outcome} alone {alone}", file=sys.stderr
                )
    heads = ("meetings", "met", "arrived", "touched", "nearest", "median", "lost s", "most")
    print(f"{'':28}" + " ".join(f"{head:>8}" for head in heads))
    for (kind, way), tally in tallies.items():
        print(f"{kind + (', told' if way else ', not told'):28}{tally.row()}")
    for (kind, way), tally in tallies.items():
        for note in tally.notes:
            print(f"{kind}{', told' if way else ', not told'}: {note}")
    return int(any(t.touched or t.arrived < t.meetings for (_, way), t in tallies.items() if way))


if __name__ == "__main__":
    sys.exit(main())
