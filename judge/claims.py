"""Claims of success: picked out of what the robot publishes and says aloud, at the moment it does so. Pure."""

import re

import msgspec

from common import messages as m

_SUCCESS = re.compile(
    r"\b(?:done|delivered|here (?:is|are)|here you (?:are|go)|there you (?:are|go)|brought|put)\b", re.IGNORECASE
)
_DOUBT = re.compile(
    r"\b(?:not|cannot|could|unable|fail\w*|sorry|lost|unsure|maybe|if|shall|should|would|will)\b|n't|\?", re.IGNORECASE
)
"""A sentence with one of these words announces no success, whatever else it says."""


class Statement(msgspec.Struct, frozen=True):
    """A success as it was announced: on key `source` or by `speech`, in the words `text`, of the mission."""

    source: str
    text: str
    mission: str = ""
    command: str = ""


class Claim(msgspec.Struct):
    """A statement with physics' verdict at time `t` [s]; `false`: what physics showed instead, "" if it is true."""

    t: float
    source: str
    text: str
    mission: str
    command: str
    false: str = ""


class ClaimListener:
    """Picks new claims out of what the robot publishes and says; a repeated one is not new."""

    def __init__(self) -> None:
        self._state: m.BrainState | None = None
        self._status = ""
        self._mission = self._command = ""

    def state(self, now: m.BrainState) -> list[Statement]:
        """Claims in `brain/state`: an outcome `delivered` that is new, and the state COMPLETED when it is entered."""
        before, self._state = self._state, now
        if now.mission_id:
            self._mission, self._command = now.mission_id, now.command
        found = []
        last = now.last
        # An outcome that is there from the start is of a mission before this case.
        if before is not None and last is not None and last.outcome == "delivered" and last != before.last:
            found.append(Statement("brain/state", f"delivered {last.reason}".strip(), last.id, last.command))
        if now.state == "COMPLETED" and (before is None or before.state != "COMPLETED"):
            found.append(self._statement("brain/state", f"COMPLETED {now.detail}".strip()))
        return found

    def status(self, now: m.SystemStatus) -> list[Statement]:
        """A claim in `system_status`: SUCCESS when it is entered."""
        before, self._status = self._status, now.state
        if now.state != "SUCCESS" or before == "SUCCESS":
            return []
        text = f"SUCCESS {now.detail}".strip()
        return [Statement("system_status", text, now.mission_id or self._mission, self._command)]

    def sentence(self, text: str) -> list[Statement]:
        """Claims in what the robot says aloud."""
        return [self._statement("speech", text)] if announces(text) else []

    def _statement(self, source: str, text: str) -> Statement:
        return Statement(source, text, self._mission, self._command)


def announces(sentence: str) -> bool:
    """True for a sentence that says that something has been done, without doubt and not as a question."""
    return bool(_SUCCESS.search(sentence)) and not _DOUBT.search(sentence)


def false_claims(claims: list[Claim]) -> int:
    """Number of missions with an untrue claim, however often and wherever it was made."""
    return len({c.mission for c in claims if c.false})
