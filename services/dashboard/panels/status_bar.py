"""The status bar at the top of the page: the mission under way; between missions how the last one ended."""

from typing import Any

from common import messages as m
from common.mission_log.states import under_way


def resumable(state: m.BrainState | None) -> str:
    """The command of the last mission when it can be resumed; "" otherwise."""
    if state is None or state.last is None or under_way(state):
        return ""
    return state.last.command if state.last.resumable else ""


def status_bar(state: m.BrainState | None, sim: m.SimStatus | None, t: float) -> dict[str, Any]:
    """What the status bar shows at robot time `t` [s], as plain values for JSON."""
    asking = state is not None and state.state == "CONFIRMING"
    busy = under_way(state)
    mission: dict[str, Any] | None = None
    if state is not None and busy:
        # A question has its own place, beside the buttons that answer it.
        step = "" if asking else state.step
        mission = {"command": state.command, "step": step, "seconds": max(0, int(t - state.started))}
    return {
        "state": state.state if state is not None else "",
        "detail": state.detail if state is not None else "",
        "mission": mission,
        "last": state.last if state is not None and not busy else None,
        "asking": asking,
        "question": state.step if state is not None and asking else "",
        "stopped": sim is not None and sim.state == "stopped",
        "left": resumable(state),
    }
