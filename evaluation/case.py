"""A scenario as data: all that a run needs, as drawn by its seed."""

from typing import Literal

import msgspec

from common.household import Household
from common.scene import Scene
from evaluation.faults.messages import Rule
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.reports import FaultReport
from judge.claims import Claim
from judge.effects import Effect, Shown
from judge.evidence import Evidence, Want
from judge.goal import Goal

Expect = Literal["delivered", "nothing", "stopped", "shown", "reported"]
Outcome = Literal[
    "delivered", "declined", "stopped", "shown", "reported", "failed", "false_success", "timeout", "crashed",
    "not struck",
]  # fmt: skip
Cause = str


class Line(msgspec.Struct, frozen=True):
    """A sentence that the simulated user says unasked.

    `when` is `ready`, `ended` (after a mission) or a state of the brain; `after` seconds of robot time pass first.
    `goal` is what this line's own mission should bring about, against which its claims are held; None: the case's.
    `thing` is what they really want of it; "": as the case has it.
    """

    text: str
    when: str = "ready"
    after: float = 0.0
    goal: Goal | None = None
    thing: str = ""


class Speaker(msgspec.Struct, frozen=True):
    """The user's voice: recordings of sentences (16 kHz int16 samples), else the robot's own voice at `pace`.

    `room`: echoes and the hum of a room in place of white noise.
    """

    name: str = ""
    recordings: dict[str, bytes] = {}
    pace: float = 1.0
    room: bool = False


class TimedFault(msgspec.Struct, frozen=True):
    """A fault that is injected `after` seconds from when the brain was first in `state`.

    The service's process is killed, and started again after `back_after` seconds; or it hangs for `seconds`. The
    simulation goes on from its checkpoint. `router`: nobody hears anybody for `seconds`. `host`: with `jump`,
    everybody's clock leaps ahead by so many seconds; with `full` the disk takes nothing more for so many. A service
    named with `full` is killed while it does.
    """

    service: str
    state: str
    seconds: float = 0.0
    jump: float = 0.0
    full: float = 0.0
    back_after: float = 1.0
    after: float = 0.0


class Showing(msgspec.Struct, frozen=True, kw_only=True):
    """A teaching before the case: an object is named `name`, in another `scene` laid out by `seed`.

    With a `sentence`, or without one by a click on the map `at` (x, y, z) [m].
    """

    scene: Scene
    household: Household
    name: str
    seed: int
    sentence: str = ""
    at: tuple[float, float, float] | None = None


class Case(msgspec.Struct, kw_only=True):
    """`lines` are what the person says, `thing` what they really want, `called` their words for it if it has others,
    `expect` what physics should show.

    `shown`: all that is wanted is delivered and all `effects` are seen. `wants` and `effects` are as things should be
    at the end. Without a `scene` (the world) it is the shipped flat; without a `household` the robot is
    told all of it. `honest`: a spoken, published failure counts as well as a
    delivery.
    `showing`: what the robot was shown before. `explores`: it maps the home first, and knows what it made of it; lines
    call rooms of the world in braces by what the map calls them.
    `replaced`: classes that stand in for services, see `Stack`. `wake`: a command that opens a dialogue starts with
    the wake word. `silent`: the person answers no question.
    """

    suite: str
    seed: int
    name: str
    command: str
    lines: tuple[Line, ...]
    wants: tuple[Want, ...] = ()
    effects: tuple[Effect, ...] = ()
    thing: str = ""
    called: str = ""
    expect: Expect = "delivered"
    honest: bool = False
    spoken: bool = False
    wake: bool = False
    silent: bool = False
    noise: float | None = None
    speaker: Speaker = Speaker()
    fault: str = ""
    rules: tuple[Rule, ...] = ()
    physical: tuple[PhysicalFault, ...] = ()
    timed_faults: tuple[TimedFault, ...] = ()
    settings: tuple[str, ...] = ()
    replaced: tuple[str, ...] = ()
    scene: Scene | None = None
    household: Household | None = None
    showing: Showing | None = None
    explores: bool = False
    limit: float = 600.0

    @property
    def goal(self) -> Goal:
        """The goal at the end of the case."""
        return Goal(self.wants, self.effects)

    def goal_of(self, line: Line) -> Goal:
        """The goal that claims after this line are held against; empty, so none is true, if nothing is to be done."""
        if line.goal is not None:
            return line.goal
        return self.goal if self.expect in ("delivered", "shown", "reported") else Goal()

    @property
    def faults(self) -> int:
        """Faults that the case injects [count]."""
        return len(self.rules) + len(self.physical) + len(self.timed_faults)


class Observed(msgspec.Struct, kw_only=True):
    """What the examiner observed in one case, before it is judged.

    `claimed`: the last outcome, `failed_at`, `code` and `explained` the stage, code and spoken words of its failure;
    `claims`: every success announced at any time, held against physics as it was then;
    `shortfall`: what is not as the case wants it at the end. `wrong`: things in the hand that nobody asked for.
    `missions`: where the robot maps first, each line and what was not as it wants it when its mission ended;
    `mapping`: how exploring went.
    `fault_reports`: what the faults really did; `fault_at`: when the first did [s of robot time]; `recovery`: seconds
    from then until the mission's next step.
    """

    evidence: Evidence = msgspec.field(default_factory=Evidence)
    shown: list[Shown] = []
    wrong: list[str] = []
    claims: list[Claim] = []
    shortfall: str = "nothing was seen"
    missions: list[tuple[str, str]] = []
    mapping: dict[str, object] = {}
    claimed: str = "none"
    reason: str = ""
    failed_at: str = ""
    code: str = ""
    explained: str = ""
    ended: bool = False
    stopped: bool = False
    states: list[str] = []
    said: list[str] = []
    stage: str = ""
    robot_seconds: float = 0.0
    shortest: float = 0.0
    fault_reports: list[FaultReport] = []
    fault_at: float | None = None
    recovery: float | None = None
    crash: str = ""


class Result(msgspec.Struct, kw_only=True):
    """One row of the report. `false_claims`: missions of which a success was claimed that physics did not show."""

    seed: int
    command: str
    outcome: Outcome
    evidence: dict[str, object]
    cause: Cause
    name: str = ""
    delivered: bool = False
    met: bool = False
    false_claims: int = 0
    spl: float = 0.0
    sim_seconds: float = 0.0
    wall_seconds: float = 0.0
