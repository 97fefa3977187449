"""What the bar at the top of the page tells: the mission under way; between missions how the last one ended."""

from typing import Any

from common import messages as m


def under_way(state: m.BrainState | None) -> bool:
    """A mission is being worked on; one that was gone on with has the name of the one that was cut short."""
    if state is None or not state.mission_id:
        return False
    ended = state.state in ("COMPLETED", "ERROR")
    return not (ended and state.last is not None and state.last.id == state.mission_id)


def left_off(state: m.BrainState | None) -> str:
    """The command of the mission that can be gone on with; "" when there is none."""
    if state is None or state.last is None or under_way(state):
        return ""
    return state.last.command if state.last.resumable else ""


def bar(state: m.BrainState | None, sim: m.SimStatus | None, t: float) -> dict[str, Any]:
    """Of what brain and sim say at robot time `t`, what belongs there; plain values for JSON."""
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
        "left": left_off(state),
    }
