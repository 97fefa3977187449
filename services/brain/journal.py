"""What happened in which mission: the seam behind which missions are kept on disk."""

from collections import OrderedDict
from typing import Protocol

import msgspec

from common.messages import BrainStateName
from services.brain.mission import Mission, Outcome

KEPT = 200
ENTRIES_KEPT = 500


class Entry(msgspec.Struct, frozen=True):
    """One transition or finding: `cause` is why, `evidence` the message or measurement that said so."""

    t: float
    state: BrainStateName
    cause: str
    evidence: str = ""


class Record(msgspec.Struct):
    """A mission as `tidybot missions` lists it; `steps` counts its goals."""

    id: str
    command: str
    started: float
    outcome: Outcome | None = None
    reason: str = ""
    ended: float = 0.0
    steps: int = 0
    entries: list[Entry] = []


class Journal(Protocol):
    """Missions in order of their start, each with its timeline."""

    def begin(self, mission: Mission) -> None: ...

    def note(self, mission_id: str, entry: Entry) -> None: ...

    def end(self, mission: Mission, outcome: Outcome, reason: str, t: float) -> None: ...

    def missions(self) -> list[Record]: ...

    def mission(self, mission_id: str) -> Record | None: ...


class MemoryJournal:
    """The journal of a process's lifetime: the newest missions only, so that a long run does not grow."""

    def __init__(self) -> None:
        self._records: OrderedDict[str, Record] = OrderedDict()

    def begin(self, mission: Mission) -> None:
        self._records[mission.id] = Record(id=mission.id, command=mission.command, started=mission.started)
        while len(self._records) > KEPT:
            self._records.popitem(last=False)

    def note(self, mission_id: str, entry: Entry) -> None:
        record = self._records.get(mission_id)
        if record is not None and len(record.entries) < ENTRIES_KEPT:
            record.entries.append(entry)

    def end(self, mission: Mission, outcome: Outcome, reason: str, t: float) -> None:
        record = self._records.get(mission.id)
        if record is not None:
            record.command = mission.command
            record.outcome, record.reason, record.ended, record.steps = outcome, reason, t, mission.goals

    def missions(self) -> list[Record]:
        return list(self._records.values())

    def mission(self, mission_id: str) -> Record | None:
        return self._records.get(mission_id)
