"""What happened in which mission, and where it stands: the seam behind which missions are kept on disk."""

from collections import OrderedDict
from collections.abc import Callable
from typing import Literal

import msgspec

from common.messages import BrainStateName, MissionOutcome
from common.time.clock import unix_time
from services.brain.mission.channel import SentGoal
from services.brain.mission.mission import GripperState, Mission, Outcome

KEPT = 200
"""Missions listed (chosen: some days of use)."""
ENTRIES_KEPT = 500
"""Entries of a mission's timeline (chosen: far above those of a long mission)."""
Kind = Literal["heard", "planned", "saw", "did", "failed", "state", "note"]
Pose = tuple[float, float, float]


class Entry(msgspec.Struct, frozen=True):
    """One transition or finding: `cause` is why, `evidence` the message or measurement that said so.

    `picture` names the picture that shows it, "" when there is none.
    """

    t: float
    state: BrainStateName
    cause: str
    evidence: str = ""
    kind: Kind = "state"
    picture: str = ""


class Record(msgspec.Struct):
    """A mission as `tidybot missions` lists it; `steps` counts its goals, `date` is Unix time of its start.

    `stage`, `code` and `spoken` are those of the failure that ended it.
    """

    id: str
    command: str
    started: float
    outcome: Outcome | None = None
    reason: str = ""
    ended: float = 0.0
    steps: int = 0
    date: float = 0.0
    stage: str = ""
    code: str = ""
    spoken: str = ""
    entries: list[Entry] = []


FORMAT = 3
"""Version of what checkpoints mean: raised when an id of the trees changes (1: names for ids, 2: no guess)."""


class PathNode(msgspec.Struct, frozen=True):
    """One node on the path to the leaf at work: its id, which of the siblings with that id it is, its retries used."""

    node: str = ""
    ordinal: int = 0
    used: int = 0

    def __str__(self) -> str:
        return f"{self.node} {self.ordinal + 1}" if self.ordinal else self.node


class Checkpoint(msgspec.Struct, rename={"gripper": "hand", "suspended": "put_off"}):
    """All that a new process needs to go on: `path` leads to the leaf at work, `sent` are the goals under way.

    `run`: the run of the robot in which it was written. `closed`: the process ended in order, not by a crash.
    `resumes`: times the mission was resumed since it last advanced. `date` is Unix time. `suspended`: how the mission
    stood that a stop has cut short, for a resume that asks to go on with it. `outdated`: a program with other ids of
    nodes has written it, so that `path` leads nowhere.
    """

    mission: Mission
    gripper: GripperState
    path: list[PathNode] = []
    sent: list[SentGoal] = []
    t: float = 0.0
    base: Pose | None = None
    date: float = 0.0
    run: str = ""
    closed: bool = False
    resumes: int = 0
    outdated: bool = False
    suspended: "Checkpoint | None" = None


class Journal:
    """Missions in order of their start, each with its timeline; the newest only, so that a long run does not grow.

    This one is of a process's lifetime. Of one on disk (`SqliteJournal`) nothing is durable before `save` has returned,
    and no method raises because of the medium. `boot` numbers the processes that have used it, from 1.
    """

    def __init__(self, clock: Callable[[], float] = unix_time) -> None:
        self.boot = 1
        self._clock = clock
        self._records: OrderedDict[str, Record] = OrderedDict()
        self._checkpoint = b""

    def begin(self, mission: Mission) -> None:
        """A mission has begun."""
        self._records[mission.id] = Record(mission.id, mission.command, mission.started, date=self._clock())
        while len(self._records) > KEPT:
            self._records.popitem(last=False)

    def keep(self, record: Record) -> None:
        """A mission that an earlier process began."""
        self._records[record.id] = record

    def resume(self, mission: Mission) -> None:
        """Go on with a mission that an earlier process began, or that had been ended by a stop."""
        record = self._records.get(mission.id)
        if record is None:
            self.begin(mission)
        else:
            record.outcome, record.reason, record.ended = None, "", 0.0
            record.stage = record.code = record.spoken = ""

    def note(self, mission_id: str, entry: Entry) -> bool:
        """Add to a mission's timeline; True if there was room for it."""
        record = self._records.get(mission_id)
        if record is None or len(record.entries) >= ENTRIES_KEPT:
            return False
        record.entries.append(entry)
        return True

    def end(self, mission: Mission, outcome: Outcome, reason: str, t: float) -> None:
        """A mission has ended at robot time `t` [s]."""
        record = self._records.get(mission.id)
        if record is not None:
            record.command = mission.command
            record.outcome, record.reason, record.ended, record.steps = outcome, reason, t, mission.goals
            failure = mission.ended_by
            record.stage, record.code, record.spoken = failure.stage, failure.code, failure.spoken

    def save(self, checkpoint: Checkpoint) -> bool:
        """False when the medium refused it."""
        self._checkpoint = msgspec.json.encode(checkpoint)
        return True

    def checkpoint(self) -> Checkpoint | None:
        """What the process before this one left behind."""
        return msgspec.json.decode(self._checkpoint, type=Checkpoint) if self._checkpoint else None

    def missions(self) -> list[Record]:
        """The newest missions, oldest first, without their timelines."""
        return [msgspec.structs.replace(record, entries=[]) for record in self._records.values()]

    def mission(self, mission_id: str) -> Record | None:
        """A mission with its timeline; None when it is not known."""
        return self._records.get(mission_id)

    def last(self) -> Record | None:
        """The newest mission that has ended."""
        return next((r for r in reversed(self._records.values()) if r.outcome is not None), None)

    def close(self) -> None:
        """Let go of the medium."""


def last_outcome(journal: Journal) -> MissionOutcome | None:
    """How the newest ended mission ended, also one of an earlier process."""
    last = journal.last()
    return outcome_of(last) if last is not None else None


def outcome_of(last: Record) -> MissionOutcome | None:
    """How a mission ended; None if it has not."""
    if last.outcome is None:
        return None
    return MissionOutcome(
        id=last.id,
        command=last.command,
        outcome=last.outcome,
        reason=last.reason,
        t=last.ended,
        stage=last.stage,
        code=last.code,
        spoken=last.spoken,
    )
