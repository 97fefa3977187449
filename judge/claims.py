"""What the robot claims to have done: every success that it publishes or says aloud, when it does. Pure."""

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
    """One success as it was announced: on which key or aloud, in which words, of which mission."""

    source: str
    text: str
    mission: str = ""
    command: str = ""


class Claim(msgspec.Struct):
    """A statement held against physics as it was then. `false`: what physics showed instead, "" if it bears it out."""

    t: float
    source: str
    text: str
    mission: str
    command: str
    false: str = ""


class ClaimListener:
    """Picks the claims out of what the robot publishes; how it repeats one is no new claim."""

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
    """Does it say that something has been done, without doubt and not as a question?"""
    return bool(_SUCCESS.search(sentence)) and not _DOUBT.search(sentence)


def false_claims(claims: list[Claim]) -> int:
    """Missions of which something untrue was claimed: what is said of one over several channels counts once."""
    return len({c.mission for c in claims if c.false})
