"""The brain: state, mission and behaviour tree."""

from typing import Literal

from common.messages.base import Message, Vec3

BrainStateName = Literal[
    "IDLE", "WAITING", "LISTENING", "CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING",
    "GRABBING", "RETURNING", "RELEASING", "COMPLETED", "ERROR",
]  # fmt: skip
OPEN_STATES: tuple[BrainStateName, ...] = ("WAITING", "LISTENING", "COMPLETED", "ERROR")
"""States in which a command begins a mission."""
SystemStateName = Literal["IDLE", "LISTENING", "PLANNING", "GROUNDING", "NAVIGATING", "EXECUTING", "SUCCESS", "ERROR"]


class BrainState(Message):
    """Where the mission stands; `plan_step`: number from 1 of the plan's step under way, 0 when none is.

    `command_id`: the id of the `voice_command` that the mission under way began with.
    `offered` [map]: where the objects stand that the person is asked about, in the order of the question.
    """

    state: BrainStateName
    t: float = 0.0
    mission_id: str = ""
    command: str = ""
    step: str = ""
    detail: str = ""
    started: float = 0.0
    pipeline: str = ""
    last: "MissionOutcome | None" = None
    plan_step: int = 0
    command_id: str = ""
    offered: list[Vec3] = []


class MissionOutcome(Message):
    """How the last mission ended; `reason` says it to people, the other fields to programs.

    `stage` (a state's name, or another stage in capitals), `code` and `spoken` are those of the failure that ended it,
    "" without one. `resumable`: a `robot/resume` with `go_on` takes it up. `command_id` as in
    `BrainState`.
    """

    id: str
    command: str
    outcome: Literal["delivered", "failed", "cancelled"]
    reason: str = ""
    t: float = 0.0
    stage: str = ""
    code: str = ""
    spoken: str = ""
    resumable: bool = False
    command_id: str = ""


class TreeNode(Message):
    name: str
    type: str
    status: str
    detail: str = ""
    children: list["TreeNode"] = []


class TreeSnapshot(Message):
    t: float
    root: TreeNode
    tick: int = 0


class SystemStatus(Message):
    state: SystemStateName
    mission_id: str = ""
    detail: str = ""
