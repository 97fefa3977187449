"""The states of a mission: whether one is under way, the colour of each, and the spans of time it was in them."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from common import messages as m

STATE_COLOURS = {
    "IDLE": "#ced4da", "WAITING": "#ced4da", "LISTENING": "#a5d8ff", "CONFIRMING": "#ffd8a8", "PLANNING": "#d0bfff",
    "GROUNDING": "#99e9f2", "NAVIGATING": "#74c0fc", "GRABBING": "#ffc078", "RETURNING": "#4dabf7",
    "RELEASING": "#ffe066", "COMPLETED": "#8ce99a", "ERROR": "#ff8787",
}  # fmt: skip
"""Colours of the states (CSS); chosen: one hue a kind of work, light enough for black text."""
OTHER_STATE = "#dee2e6"
"""Colour (CSS) of a state that this version does not know."""


def under_way(state: m.BrainState | None) -> bool:
    """True while a mission is being worked on."""
    if state is None or not state.mission_id:
        return False
    ended = state.state in ("COMPLETED", "ERROR")
    return not (ended and state.last is not None and state.last.id == state.mission_id)


def limb_words(status: m.NavigationFeedback | m.ManipulationStatus) -> str:
    """The status of base or arm in words: what it is doing, or how it ended and why."""
    doing = f"{status.status} {getattr(status, 'phase', '')}".rstrip()
    why = f"{status.code} {status.detail}".strip()
    return f"{doing}: {why}" if why else doing


def spans(entries: Sequence[dict[str, Any]], began: float, ended: float) -> list[tuple[str, float, float]]:
    """(state, from, to) [s since the mission began] for each stretch of log entries in one state, without gaps."""
    found: list[tuple[str, float, float]] = []
    changes = [(e["state"], min(max(0.0, e["t"] - began), ended - began)) for e in entries]
    changes.append(("", ended - began))
    for (state, start), (_, end) in pairwise(changes):
        if found and found[-1][0] == state:
            found[-1] = (state, found[-1][1], end)
        elif state:
            found.append((state, start, end))
    return found
