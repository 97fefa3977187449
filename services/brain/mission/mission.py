"""A mission as data: what was asked, how far it came, what is in the hand, why it failed. No bus, no clock."""

from collections.abc import Mapping
from itertools import dropwhile
from typing import Literal

import msgspec

from common import messages as m
from common.robot.grip import grip_of
from services.brain.mission.search import Search
from services.brain.world.neighbours import Stood
from services.brain.world.placement import Rest

Outcome = Literal["delivered", "failed", "cancelled"]

SYSTEM_STATE: Mapping[m.BrainStateName, m.SystemStateName] = {
    "IDLE": "IDLE",
    "WAITING": "IDLE",
    "LISTENING": "LISTENING",
    "CONFIRMING": "LISTENING",
    "PLANNING": "PLANNING",
    "GROUNDING": "GROUNDING",
    "NAVIGATING": "NAVIGATING",
    "RETURNING": "NAVIGATING",
    "GRABBING": "EXECUTING",
    "RELEASING": "EXECUTING",
    "COMPLETED": "SUCCESS",
    "ERROR": "ERROR",
}
"""The brain's states folded onto the eight names of `system_status`."""

LOST_AFTER = 0.5
"""s for which the fingers must be empty before the object counts as lost (chosen: longer than a bump of the base)."""
ORIGINS_KEPT = 20
"""Objects of which the gripper's state remembers where they stood (chosen: a day of use)."""
PERMANENT = frozenset(
    {
        "PREEMPTED", "STOPPED", "CANCELLED", "NO_PEER", "TOO_HEAVY", "TOO_WIDE", "OUT_OF_REACH",
        "UNKNOWN_GOAL", "UNKNOWN_PLACE", "UNKNOWN_OBJECT",
    }
)  # fmt: skip
"""Codes of failures that trying the same again cannot mend."""


class Failure(msgspec.Struct, frozen=True):
    """Why a step failed: `spoken` is a sentence for people, `code` and `detail` are the peer's own words."""

    stage: str
    code: str
    detail: str = ""
    spoken: str = ""

    @property
    def permanent(self) -> bool:
        """True when trying the same again cannot help, or somebody else has taken the robot over."""
        return self.code in PERMANENT

    @property
    def reason(self) -> str:
        """Words and codes in one line, for people."""
        why = ": ".join(part for part in (self.code, self.detail) if part and part not in self.spoken)
        return " ".join(part for part in (self.spoken, f"({self.stage}: {why})" if why else "") if part)


class Heard(msgspec.Struct):
    """How sure the command is: `confidence` 0 to 1 of speech, `confirmed` by a person, `repeat`: to be said again.

    `question`: it is no command, but what a client wants to know from the person. `alternatives`: what else may have
    been said, until the planner has told which of all it is. `words`: what was said first, of which the command
    that was asked about may have left something out.
    """

    confidence: float = 1.0
    confirmed: bool = False
    repeat: bool = False
    question: bool = False
    alternatives: list[m.Transcription] = []
    words: str = ""


class Task(msgspec.Struct):
    """What the fetch pipeline understood: `kind` of intent, `item` as spoken, `label` as the household has it."""

    kind: str = ""
    item: str = ""
    label: str = ""


class Planning(msgspec.Struct):
    """The accepted plan, the last rejected one, and the steps that went and looked before (`look_again`: they do).

    `suggestion`: the command that comes nearest to what was said, while the person has not been asked about it.
    """

    steps: list[m.PlanStep] = []
    rejected: m.RejectedPlan | None = None
    looked: list[m.PlanStep] = []
    look_again: bool = False
    suggestion: str = ""


class Delivery(msgspec.Struct):
    """What the hand has done. `put_down`: the object released last.

    `checked`: what a look after a release showed, in words; `unchecked`: objects put down where nobody could look;
    `lost`: labels of what fell from the hand; `rests`: how objects rested, by the words they were asked for with;
    `around`: by id, what stood near when the hand began to work; `absent`: by label, from where [map] an object was
    taken that was not seen where it had been put down, and when [s] that was; `unlike`: the label of what a look since
    it was put down showed in a shape that it has not where it stands.
    """

    grabbed: bool = False
    released: bool = False
    put_down: str = ""
    checked: list[str] = []
    lost: list[str] = []
    rests: dict[str, Rest] = {}
    unchecked: list[str] = []
    around: dict[str, Stood] = {}
    absent: dict[str, tuple[m.Vec3, float]] = {}
    unlike: str = ""


class Mission(msgspec.Struct):
    """One command from hearing to outcome. Goal ids are `<id>.<n>`; `at`: the place or object the robot stands at.

    `queued`: commands that were given meanwhile and come after it. `command_id`: of the `voice_command` it began with.
    """

    id: str
    command: str = ""
    started: float = 0.0
    goals: int = 0
    at: str = ""
    failure: Failure | None = None
    outcome: Outcome | None = None
    heard: Heard = msgspec.field(default_factory=Heard)
    task: Task = msgspec.field(default_factory=Task)
    planning: Planning = msgspec.field(default_factory=Planning)
    search: Search = msgspec.field(default_factory=Search)
    delivery: Delivery = msgspec.field(default_factory=Delivery)
    queued: list[m.VoiceCommand] = []
    command_id: str = ""

    def destination(self, item: str) -> str:
        """The receptacle on which the plan puts what it grasps under that name; "" if it says none."""
        after = dropwhile(lambda s: s.action != "grasp" or s.object != item, self.planning.steps)
        return next((s.target for s in after if s.action == "place"), "")

    @property
    def handled(self) -> list[str]:
        """Labels of the objects that the plan is about, in its order, as perception has them where it found them."""
        named = dict.fromkeys(s.object for s in self.planning.steps if s.object)
        return [found.label if (found := self.search.found.get(n)) and found.label else n for n in named]

    def next_goal(self) -> str:
        """The id of the next goal."""
        self.goals += 1
        return f"{self.id}.{self.goals}"

    @property
    def ended_by(self) -> Failure:
        """The failure that ended the mission; an empty one if none did."""
        return self.failure if self.failure is not None and self.outcome != "delivered" else Failure("", "")

    def failed_with(self, *codes: str) -> bool:
        """Whether the last failure has one of the codes."""
        return self.failure is not None and self.failure.code in codes

    @property
    def failed_for_good(self) -> bool:
        """The last failure forbids another try of the same."""
        return self.failure is not None and (self.failure.permanent or self.failure.code == "NO_PLAN")

    @property
    def active(self) -> bool:
        """A command was accepted and has not ended."""
        return bool(self.command) and self.outcome is None


class GripperState(msgspec.Struct, rename={"grasp_uncertain": "uncertain"}):
    """What the brain believes is in the gripper. `uncertain` after an interrupted grab or release.

    `taken_from`: the receptacle that each object stood on before it was last grasped, by label, the latest last.
    `felt`: since the grab the fingers have been seen to hold something; only then can they tell of a loss.
    """

    holding: str = ""
    grasp_uncertain: str = ""
    felt: bool = False
    empty_since: float | None = None
    put_down: dict[str, float] = {}
    taken_from: dict[str, str] = {}

    @property
    def note(self) -> str:
        """What to add to the reason of an end: what is, or may be, in the hand."""
        held = self.holding or self.grasp_uncertain
        return f"; {'still' if self.holding else 'perhaps'} holding the {held}" if held else ""

    def mark_grasped(self, label: str, origin: str = "") -> None:
        """Believe that `label` is in the hand; it stood on `origin`, "" if nobody knows."""
        self.taken_from.pop(label, None)
        if origin:
            self.taken_from[label] = origin
            while len(self.taken_from) > ORIGINS_KEPT:
                del self.taken_from[next(iter(self.taken_from))]
        self.holding, self.grasp_uncertain = label, ""
        self.felt, self.empty_since = False, None

    def mark_released(self, now: float) -> None:
        """Believe that the hand is empty, since robot time `now` [s]."""
        if self.holding:
            self.put_down[self.holding] = now
        self.holding = self.grasp_uncertain = ""

    def mark_uncertain(self, label: str) -> None:
        """A grab or release of `label` was cut short; the fingers decide later."""
        self.grasp_uncertain = label

    def resolve_uncertainty(self, evidence: bool | None) -> None:
        """Settle an uncertainty by what the fingers feel; with no evidence the old belief stays."""
        if self.grasp_uncertain and evidence is not None:
            self.holding = self.grasp_uncertain if evidence else ""
            self.grasp_uncertain = ""

    def update(self, evidence: bool | None, now: float) -> None:
        """Once a step: what the fingers say while something should be between them."""
        self.felt = self.felt or evidence is True
        if evidence is False:
            self.empty_since = now if self.empty_since is None else self.empty_since
        else:
            self.empty_since = None

    def has_lost_object(self, now: float) -> bool:
        """Something was felt in the hand and is not any more."""
        return (
            bool(self.holding) and self.felt and self.empty_since is not None and now - self.empty_since >= LOST_AFTER
        )


def gripper_holds(joints: m.JointStates | None) -> bool | None:
    """True when width and force of the gripper speak of an object between the pads; None: no gripper reported."""
    grip = grip_of(joints)
    return None if grip is None else grip.holds()
