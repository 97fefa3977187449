"""Names that people teach: what is called how, and the wish to teach or forget a name."""

from typing import Literal

from common.messages.base import Message, Vec3

TeachCode = Literal["", "NO_NAME", "NAME_TAKEN", "NOT_SEEN", "AMBIGUOUS", "UNKNOWN_NAME", "PREEMPTED", "NOT_KEPT"]


class TeachRequest(Message):
    """Call an object `name` from now on, or `forget` the name.

    The object meant is the one with `label` in `world/objects`, else the one nearest to `position` (frame map), else
    what the hand holds, else what stands before the robot. Forgetting needs the name alone.
    """

    name: str
    id: str = ""
    attempt: int = 0
    forget: bool = False
    label: str = ""
    position: Vec3 | None = None


class TeachResult(Message):
    """What came of a `TeachRequest`. `label`: the object that has the name now; `candidates`: labels of the objects
    that could have been meant, for AMBIGUOUS; `detail` says to people why it was not done."""

    goal_id: str
    ok: bool
    attempt: int = 0
    name: str = ""
    label: str = ""
    code: TeachCode = ""
    detail: str = ""
    candidates: list[str] = []


class TaughtName(Message):
    """One taught name and what the object looked like then: `kind` and `colour` in words, `size` full extents [m].

    `views`: how many different looks at it are kept.
    """

    name: str
    kind: str = ""
    colour: str = ""
    size: Vec3 = (0.0, 0.0, 0.0)
    views: int = 0


class TaughtNames(Message):
    """All names that were taught and not forgotten."""

    names: list[TaughtName] = []
