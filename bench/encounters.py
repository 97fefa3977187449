"""Two robots meet in one flat: do both arrive, how near do they come, what does it cost? `python -m bench.encounters`.

Two whole navigation services, each with its own lidar and wheels, drive in one kinematic world in which each is a body
that the other's lidar sees. Every meeting is driven with what robots tell each other of their ways and without it, and
by each of the two alone, which is what time lost is counted against. With --physics both are bodies in one MuJoCo
world, with the lidars and wheels of the simulation. Exit 1 after a touch or a robot that did not
arrive, with the exchange.
"""

import argparse
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from bench.meetings import KINDS, Meeting
from common import messages as m
from common import topics
from common.approach import HALF_WIDTH
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.floor_plan import FloorPlan, Place
from common.geometry import Pose2, Rectangle
from common.household import told
from common.scene import Scene
from common.time.clock import ManualClock
from common.time.lockstep import InProcess
from services.navigation.config import NavigationConfig
from services.navigation.service import NavigationService
from services.sim.config import Guest, SimConfig
from services.sim.service import SimService
from tests.unit.navigation_flat import Flat

NAMES = ("anna", "bert")
LIMIT = 150.0
"""Robot time [s] of one meeting."""
BODY = 2 * HALF_WIDTH
"""Side of a robot's base [m]."""
CORNER = 0.284
"""How far the rounded corners of its bumper are from its middle [m]."""
MET = 1.5
"""Two robots that came this near to each other have met [m]."""


@dataclass
class Outcome:
    """`took` [s] by robot, None for one that did not arrive; `nearest` [m] between the bodies; `codes` of failures."""

    took: list[float | None] = field(default_factory=list)
    nearest: float = math.inf
    touched: bool = False
    codes: list[str] = field(default_factory=list)

    @property
    def arrived(self) -> bool:
        return None not in self.took


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
        self.robots: dict[int, Any] = {}
        for n in (0, 1) if alone is None else (alone,):
            x, y, theta = meeting.starts[n]
            home = msgspec.structs.replace(meeting.home, home=Place(name="home", x=x, y=y, theta=theta))
            robot = Flat(household=home)
            robot.true = robot.wheels = meeting.starts[n]
            robot.io.robot = NAMES[n] if exchange else ""
            self.robots[n] = robot
        self._introduce()

    def _introduce(self) -> None:
        for n, robot in self.robots.items():
            robot.bus.send(topics.BRAIN_STATE, m.BrainState(state="WAITING"))
            if len(self.robots) == 2:
                robot.bus.neighbours = {NAMES[1 - n]: self.robots[1 - n].bus}

    @property
    def now(self) -> float:
        """Robot time [s]."""
        return float(next(iter(self.robots.values())).now)

    @property
    def touched(self) -> bool:
        """They have."""
        return len(self.robots) == 2 and gap(self.robots[0].true, self.robots[1].true) < 0.0

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
        start = self.now
        while len(took) < len(robots):
            now = self.now
            for n, robot in robots.items():
                goal = self.meeting.goals[n]
                assert goal is not None
                if n not in begun and now - start >= self.meeting.delay * n:
                    begun[n] = now
                    x, y, theta = goal
                    robot.bus.send(topics.NAV_GOAL, m.NavGoal(x=x, y=y, theta=theta, id=f"drive.{n}"))
                elif n in begun and n not in took and topics.NAVIGATION_FEEDBACK.key in robot.bus.last:
                    answer = robot.bus.last[topics.NAVIGATION_FEEDBACK.key]
                    said = codec.decode(topics.NAVIGATION_FEEDBACK, answer)
                    if said.status == "arrived":
                        took[n] = now - begun[n]
                    elif said.status == "failed" or now - start > LIMIT:
                        took[n] = None
                        outcome.codes.append(said.code or said.status)
            self.step()
            if len(self.robots) == 2:
                outcome.nearest = min(outcome.nearest, gap(self.robots[0].true, self.robots[1].true))
                outcome.touched |= self.touched
            watch(self)
        outcome.took = [took[n] for n in robots]
        return outcome


@dataclass
class Driven:
    """A robot in the simulation, with a navigation of its own."""

    bus: MemoryBus
    world: InProcess
    joints: NDArray[np.float64]

    @property
    def now(self) -> float:
        return self.world.clock.now()

    @property
    def true(self) -> Pose2:
        x, y, theta, *_ = self.joints.tolist()
        return x, y, theta


class InPhysics(Pair):
    """The same in one MuJoCo world."""

    def __init__(self, meeting: Meeting, exchange: bool, alone: int | None = None) -> None:
        self.meeting = meeting
        numbers = (0, 1) if alone is None else (alone,)
        buses = {n: MemoryBus() for n in numbers}
        plan = {name: getattr(meeting.home, name) for name in FloorPlan.__struct_fields__}
        scenes = {}
        for n in numbers:
            x, y, theta = meeting.starts[n]
            scenes[n] = Scene(**plan | {"home": Place(name="home", x=x, y=y, theta=theta)})
        first, *others = numbers
        clock = ManualClock()

        def io(kind: Any, n: int) -> MemoryIo:
            return MemoryIo(
                buses[n], kind.NAME, kind.READS, kind.WRITES, household=told(scenes[n]), world=scenes[n], clock=clock
            )

        buses[first].neighbours = {NAMES[n]: buses[n] for n in others}
        sim_io = io(SimService, first)
        sim_io.out_stamp = -1
        self.sim = SimService(SimConfig(guests=tuple(Guest(NAMES[n], *meeting.starts[n]) for n in others)), sim_io)
        world = InProcess(self.sim, sim_io, clock)
        for n in numbers:
            own = io(NavigationService, n)
            own.robot = NAMES[n] if exchange else ""
            world.add(NavigationService(NavigationConfig(), own), own)
        bodies = zip(numbers, self.sim.physics.robots, strict=True)
        self.robots = {n: Driven(buses[n], world, robot.joints) for n, robot in bodies}
        self._introduce()

    def step(self) -> None:
        for _ in range(5):
            next(iter(self.robots.values())).world.advance()

    @property
    def touched(self) -> bool:
        return any("/" in touch.thing for touch in self.sim.physics.contacts.touches)


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
        self.touched += outcome.touched
        if outcome.nearest < MET:
            self.nearest.append(outcome.nearest)
            self.lost += [t - a for t, a in zip(outcome.took, alone, strict=True) if t is not None and a is not None]
        if not outcome.arrived or outcome.touched:
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
    parser.add_argument("--physics", action="store_true", help="in MuJoCo")
    args = parser.parse_args()
    kind_of_world = InPhysics if args.physics else Pair
    ways = {"both": (True, False), "exchange": (True,), "nothing": (False,)}[args.ways]
    tallies = {(kind, way): Tally() for kind in KINDS if args.only in kind for way in ways}
    for kind in [k for k in KINDS if args.only in k]:
        for seed in range(args.first, args.first + args.seeds):
            meeting = KINDS[kind](np.random.default_rng([seed, 17]))
            drivers = [n for n in (0, 1) if meeting.goals[n] is not None]
            alone = [kind_of_world(meeting, False, alone=n).run().took[0] for n in drivers]
            for way in ways:
                outcome = kind_of_world(meeting, way).run()
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
