"""The planner: commands to plans."""

from typing import Literal

import msgspec

from common.messages.base import Message
from common.messages.brain import MissionOutcome
from common.messages.speech import Transcription

PlannerBackend = Literal["grammar", "llm"]
StepAction = Literal[
    "navigate", "find", "grasp", "place", "release", "say", "wait", "return", "teach", "forget", "name", "rule"
]
GRIPPER = "gripper"
"""The target of a step that only opens or closes the hand."""
AROUND = "around"
"""The target of a `navigate` that turns on the spot to look all around."""


class KnownWorld(Message):
    objects: list[str] = []
    places: list[str] = []
    receptacles: list[str] = []
    held: str = ""


class RejectedPlan(Message):
    """A plan that cannot be carried out; `step`: number from 1 of the step that `reason` is about, 0 for all of it."""

    steps: list["PlanStep"] = []
    reason: str = ""
    step: int = 0


class PlanStep(Message):
    """One step of a plan. `grasp` and `release` with the target `gripper` close and open the hand around nothing.

    `near`: of `place`, the object on the target next to which; "" anywhere on it. `text`: of `say` what is said, of
    `teach`, `name` and `forget` the name; `teach` gives it to `object`, or with "" to what stands before the robot or
    is held; `name` to the room, surface or place `object`, or to what the robot stands in or before. `rule`: `object`
    in words goes to `target` from now on. `forget` with the target "place" or "rule" takes these back.
    `seconds`: how long to `wait`, 0 for a moment.
    """

    action: StepAction
    object: str = ""
    target: str = ""
    text: str = ""
    near: str = ""
    seconds: float = 0.0

    @property
    def words(self) -> str:
        """The step as people read it, such as `place red mug desk`."""
        parts = (self.action, self.object, self.target, self.text, self.near and f"near {self.near}")
        return " ".join(part for part in parts if part)

    @property
    def hand_alone(self) -> bool:
        """A step of the gripper that needs no arm and names no object."""
        return self.action in ("grasp", "release") and self.target == GRIPPER and not self.object


class History(Message):
    """What a command may refer to beyond itself: `it`, `put it back`, `why did you fail`, `what are you doing`.

    `doing`: the command under way, `step` what is done for it at the moment, both "" when nothing is. `last`: how the
    last mission ended. `objects`: labels that it handled, in order. `taken_from`: the receptacle that each thing stood
    on before it was grasped, by label, the latest last. `said`: what the robot said last.
    """

    doing: str = ""
    step: str = ""
    last: MissionOutcome | None = None
    objects: list[str] = []
    taken_from: dict[str, str] = {}
    said: str = ""


class PlanRequest(Message):
    """`done`: steps already carried out for this command, from a sender that asks again after a plan marked `again`.

    `mission_id`: what the requests of one mission have in common, "" when the sender has no missions.
    `alternatives`: what may have been said instead of the command, from a sender that only wants to know which of all
    these to ask the person about: `suggestion` of the plan, "" where it is the command without a doubt.
    """

    id: str
    command: str
    world: KnownWorld = msgspec.field(default_factory=KnownWorld)
    rejected: RejectedPlan | None = None
    done: list["PlanStep"] | None = None
    mission_id: str = ""
    history: History = msgspec.field(default_factory=History)
    alternatives: list[Transcription] = []


SENSELESS = "I do not understand"
"""How the `detail` of a plan begins against words that fit no wording; any other is why something cannot be done."""


class ActionPlan(Message):
    """`again`: these steps only go and look; the command has to be planned anew with what they show.

    `suggestion`: without steps, the known command that comes nearest to what was said, to be asked about first.
    """

    request_id: str
    steps: list[PlanStep]
    source: str = ""
    detail: str = ""
    again: bool = False
    suggestion: str = ""


class PlannerStatus(Message):
    """Who plans now: the `model` at `url`, or the grammar; `detail` says why there is no model."""

    backend: PlannerBackend
    model: str = ""
    url: str = ""
    detail: str = ""
