"""Manipulation: goals, progress and grasp candidates."""

from typing import Literal

from common.messages.base import Message, Quat, Vec3
from common.messages.perception import ObjectRef

ManipStatus = Literal["idle", "executing", "done", "failed"]


class ManipulationGoal(Message):
    """`grab`, `release`, `place <receptacle>`, `home` or `stop`.

    `object`: which to grab, or next to which to place. `to`: the receptacle on which what is grabbed is to be put.
    """

    goal: str
    id: str = ""
    attempt: int = 1
    object: ObjectRef | None = None
    to: str = ""


class ManipulationStatus(Message):
    """`blockers`: labels of the objects in the way of what could not be grasped, the worst first; `stance`: a pose
    (x, y, theta) of the base in frame map from which the arm reaches what it does not from here.
    """

    status: ManipStatus
    goal_id: str = ""
    attempt: int = 0
    phase: str = ""
    code: str = ""
    detail: str = ""
    blockers: list[str] = []
    stance: Vec3 | None = None


class HandVelocity(Message):
    """The hand led by a person: `linear` [m/s] and `angular` [rad/s], base frame; 0.25 s of silence means stop.

    `fingers`: "open" or "close" from now on, "" as they are. `home`: to the carry pose instead, as long as it is sent.
    """

    linear: Vec3 = (0.0, 0.0, 0.0)
    angular: Vec3 = (0.0, 0.0, 0.0)
    fingers: Literal["", "open", "close"] = ""
    home: bool = False


class GraspCandidate(Message):
    """Pose of the pinch point (z: approach, y: across the fingers) and width there [m], in frame map."""

    name: str
    position: Vec3
    orientation: Quat
    width: float
    state: Literal["open", "failed", "chosen"] = "open"


class GraspCandidates(Message):
    """What manipulation considers for the object that it is about to grab, in the order it tries, for viewers."""

    t: float
    object: str
    candidates: list[GraspCandidate]
    goal_id: str = ""
