"""The missions of a recording, as records like those of the brain's journal, from the topics alone."""

from collections.abc import Iterable
from typing import Any

from common import messages as m
from common import topics
from common.bus import codec
from common.mission_log.states import under_way
from common.recording import Row

TOLD = {
    t.key
    for t in (
        topics.BRAIN_STATE, topics.SPEECH_GOAL, topics.SPEECH_RESULT, topics.VOICE_COMMAND, topics.NAVIGATION_FEEDBACK,
        topics.MANIPULATION_STATUS, topics.ACTION_PLAN, topics.OBJECT_POSE,
    )
}  # fmt: skip
Record = dict[str, Any]
ASKED = 5.0
"""Words this long [s] before a mission are what it was asked for with."""


def decoded(row: Row) -> m.Message | None:
    """The decoded message of a row, None when it cannot be decoded."""
    topic = topics.BY_KEY.get(row.key)
    if topic is None or row.junk:
        return None
    try:
        message: m.Message = codec.decode(topic, row.payload)
    except codec.DecodeError:
        return None
    return message


def missions(rows: Iterable[Row]) -> list[Record]:
    """One record for each mission, oldest first, with the fields of `brain/missions` and `until`: where it ends [s].

    A mission that was under way when the recording began is told from there on.
    """
    found: dict[str, Record] = {}
    at: Record | None = None
    state, doing = "", ("", "")
    heard: tuple[float, tuple[str, str, str]] | None = None
    for row in rows:
        message = decoded(row) if row.key in TOLD else None
        if isinstance(message, m.BrainState):
            before, at = at, _follow(found, at, message, row.t)
            if at is not None and at is not before and heard is not None and row.t - heard[0] < ASKED:
                # The words that began it came before it had a name.
                at["entries"].append(_entry(max(heard[0], at["started"]), message.state, *heard[1]))
            if at is not None and (message.state, message.step) != doing:
                at["entries"].append(_entry(row.t, message.state, message.step, message.detail, "state"))
            state, doing = message.state, (message.state, message.step)
        elif message is not None and (said := _told(message)) is not None:
            if at is not None:
                at["entries"].append(_entry(row.t, state, *said))
            elif said[2] == "heard":
                heard = row.t, said
        if at is not None:
            at["until"] = row.t
    return list(found.values())


def _follow(found: dict[str, Record], at: Record | None, state: m.BrainState, t: float) -> Record | None:
    """The mission that goes on after this state; its end is noted."""
    last, name, on = state.last, state.mission_id, under_way(state)
    gone_on = on and last is not None and last.id == name
    if last is not None and last.id in found and found[last.id]["outcome"] is None and not gone_on:
        record = found[last.id]
        record |= {"outcome": last.outcome, "reason": last.reason, "ended": t, "command": last.command}
        if last.outcome == "cancelled":
            # It may be gone on with; what lies between is none of it.
            record["entries"].append(_entry(t, state.state, last.outcome, last.reason, "note"))
    if on and name in found:
        found[name] |= {"outcome": None, "reason": "", "ended": 0.0}
    elif not name or name in found:
        # What is said of a mission just after it ended belongs to it.
        return at if at is not None and state.state in ("COMPLETED", "ERROR") else None
    elif last is not None and last.id == name and not on:
        return None
    if name not in found:
        found[name] = {
            "id": name, "command": state.command, "started": state.started or t, "outcome": None, "reason": "",
            "ended": 0.0, "steps": 0, "date": 0.0, "entries": [], "until": t,
        }  # fmt: skip
    found[name]["command"] = state.command or found[name]["command"]
    return found[name]


def _told(message: m.Message) -> tuple[str, str, str] | None:
    """(cause, evidence, kind), None for what is not worth telling."""
    if isinstance(message, m.SpeechGoal):
        verb, _, words = message.goal.partition(" ")
        return (f"said “{words}”", "", "note") if verb == "say" else None
    if isinstance(message, m.VoiceCommand):
        return f"heard “{message.text}”", f"confidence {message.confidence:.2f}", "heard"
    if isinstance(message, m.SpeechResult):
        good = message.text != "ERROR"
        return f"heard “{message.text}”" if good else f"not understood: {message.code}", message.detail, "heard"
    if isinstance(message, m.ActionPlan):
        steps = ", ".join(step.words for step in message.steps)
        return f"plan: {steps}", message.source, "planned"
    if isinstance(message, m.ObjectPose):
        if not message.found:
            return "not found", message.detail, "failed"
        return f"{message.label} seen", f"confidence {message.confidence:.2f}", "saw"
    if isinstance(message, (m.NavigationFeedback, m.ManipulationStatus)):
        who = "base" if isinstance(message, m.NavigationFeedback) else "arm"
        if message.status == "failed":
            return f"{who}: {message.code}", message.detail, "failed"
        if message.status in ("arrived", "done"):
            return f"{who}: {message.status}", message.detail, "did"
    return None


def _entry(t: float, state: str, cause: str, evidence: str, kind: str) -> dict[str, Any]:
    return {"t": t, "state": state, "cause": cause, "evidence": evidence, "kind": kind}
