"""Two whole robots of a meeting in one simulated flat, from the command to drive until both have ended."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.encounters.meetings import Meeting
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
from common.time.lockstep import DT, InProcess
from services.navigation.config import NavigationConfig
from services.navigation.service import NavigationService
from services.sim.config import Guest, SimConfig
from services.sim.service import SimService

NAMES = ("anna", "bert")

LIMIT = 150.0
"""Robot time [s] of one meeting."""
BODY = 2 * HALF_WIDTH
"""Side of a robot's base [m]."""
CORNER = 0.284
"""How far the rounded corners of its bumper are from its middle [m]."""


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


@dataclass
class Robot:
    """One of the two: its bus, and the joints of its body in physics."""

    bus: MemoryBus
    joints: NDArray[np.float64]

    @property
    def true(self) -> Pose2:
        x, y, theta, *_ = self.joints.tolist()
        return x, y, theta


class Pair:
    """The two robots of a meeting, or with `alone` one of them, in one simulated flat."""

    def __init__(self, meeting: Meeting, alone: int | None = None) -> None:
        self.meeting = meeting
        numbers = (0, 1) if alone is None else (alone,)
        first, *others = numbers
        buses = {n: MemoryBus() for n in numbers}
        plan = {name: getattr(meeting.home, name) for name in FloorPlan.__struct_fields__}
        self._clock = ManualClock()

        def io(kind: Any, n: int) -> MemoryIo:
            x, y, theta = meeting.starts[n]
            scene = Scene(**plan | {"home": Place(name="home", x=x, y=y, theta=theta)})
            return MemoryIo(
                buses[n], kind.NAME, kind.READS, kind.WRITES, household=told(scene), world=scene, clock=self._clock
            )

        buses[first].neighbours = {NAMES[n]: buses[n] for n in others}
        sim_io = io(SimService, first)
        sim_io.out_stamp = -1
        self._sim = SimService(SimConfig(guests=tuple(Guest(NAMES[n], *meeting.starts[n]) for n in others)), sim_io)
        self._world = InProcess(self._sim, sim_io, self._clock)
        for n in numbers:
            own = io(NavigationService, n)
            own.robot = NAMES[n]
            self._world.add(NavigationService(NavigationConfig(), own), own)
        bodies = zip(numbers, self._sim.physics.robots, strict=True)
        self.robots = {n: Robot(buses[n], body.joints) for n, body in bodies}
        for n, robot in self.robots.items():
            robot.bus.send(topics.BRAIN_STATE, m.BrainState(state="WAITING"))
            if alone is None:
                robot.bus.neighbours = {NAMES[1 - n]: buses[1 - n]}

    @property
    def gap(self) -> float:
        """Distance [m] between the two bases."""
        return gap(self.robots[0].true, self.robots[1].true)

    def advance(self, seconds: float) -> None:
        """Let robot time pass."""
        for _ in range(round(seconds / DT)):
            self._world.advance()

    def run(self) -> Outcome:
        """Run the meeting to its end."""
        outcome = Outcome()
        took: dict[int, float | None] = {}
        begun: dict[int, float] = {}
        self.advance(0.5)
        goals = {n: goal for n in self.robots if (goal := self.meeting.goals[n]) is not None}
        start = self._clock.now()
        while len(took) < len(goals):
            now = self._clock.now()
            for n, goal in goals.items():
                bus = self.robots[n].bus
                if n not in begun and now - start >= self.meeting.delay * n:
                    begun[n] = now
                    x, y, theta = goal
                    bus.send(topics.NAV_GOAL, m.NavGoal(x=x, y=y, theta=theta, id=f"drive.{n}"))
                elif n in begun and n not in took and topics.NAVIGATION_FEEDBACK.key in bus.last:
                    said = codec.decode(topics.NAVIGATION_FEEDBACK, bus.last[topics.NAVIGATION_FEEDBACK.key])
                    if said.status == "arrived":
                        took[n] = now - begun[n]
                    elif said.status == "failed" or now - start > LIMIT:
                        took[n] = None
                        outcome.codes.append(said.code or said.status)
            self.advance(0.05)
            if len(self.robots) == 2:
                outcome.nearest = min(outcome.nearest, self.gap)
        outcome.took = [took[n] for n in goals]
        outcome.touched = any("/" in touch.thing for touch in self._sim.physics.contacts.touches)
        return outcome
