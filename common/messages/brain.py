"""The brain: state, mission and behaviour tree."""

from typing import Literal

from common.messages.base import Message

BrainStateName = Literal[
    "IDLE", "WAITING", "LISTENING", "CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING",
    "GRABBING", "RETURNING", "RELEASING", "COMPLETED", "ERROR",
]  # fmt: skip
SystemStateName = Literal["IDLE", "LISTENING", "PLANNING", "GROUNDING", "NAVIGATING", "EXECUTING", "SUCCESS", "ERROR"]


class BrainState(Message):
    state: BrainStateName
    t: float = 0.0
    mission_id: str = ""
    command: str = ""
    step: str = ""
    detail: str = ""
    started: float = 0.0
    pipeline: str = ""
    last: "MissionOutcome | None" = None


class MissionOutcome(Message):
    """How the last mission ended."""

    id: str
    command: str
    outcome: Literal["delivered", "failed", "cancelled"]
    reason: str = ""
    t: float = 0.0


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
