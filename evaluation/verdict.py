"""From what was seen to the row of the report: outcome by physics, cause by stage, false claims. Pure."""

import re

import msgspec

from evaluation.case import Case, Observed, Outcome, Result
from evaluation.evidence import Evidence, spl

STAGES = {
    "IDLE": "start", "WAITING": "speech", "LISTENING": "speech", "CONFIRMING": "speech", "UNDERSTANDING": "speech",
    "PLANNING": "planning", "GROUNDING": "perception", "NAVIGATING": "navigation", "RETURNING": "navigation",
    "GRABBING": "grasp", "RELEASING": "release", "COMPLETED": "evidence",
}  # fmt: skip
_WHY = re.compile(r"\(([A-Z]+): ([A-Z_]+)")
STOOD_STILL = 0.3
MET = {"delivered": ("delivered",), "nothing": ("declined",), "stopped": ("stopped",), "shown": ("shown",)}


def judge(case: Case, seen: Observed, wall_seconds: float) -> Result:
    """The verdict on one case."""
    outcome = _outcome(case, seen)
    delivered = outcome == "delivered" or (outcome == "shown" and bool(case.wants))
    allowed: tuple[str, ...] = MET[case.expect] + (("reported",) if case.honest else ())
    share = round(spl(delivered, seen.shortest, seen.evidence.driven), 3)
    met = outcome in allowed
    details: dict[str, object] = {
        "name": case.name, "fault": case.fault, "expected": case.expect, "met": met, "claimed": seen.claimed,
        "reason": seen.reason, **msgspec.to_builtins(seen.evidence), "shortest": seen.shortest, "spl": share,
        "sim_seconds": seen.robot_seconds, "wall_seconds": round(wall_seconds, 1), "states": seen.states,
        "said": seen.said, "effects": msgspec.to_builtins(seen.shown), "wrong": seen.wrong,
        "struck": seen.struck, "recovery": seen.recovery,
    }  # fmt: skip
    return Result(
        seed=case.seed, command=case.command, outcome=outcome, evidence=details,
        cause="" if met else cause(case, seen, outcome), name=case.name, delivered=delivered, met=met, spl=share,
        sim_seconds=seen.robot_seconds, wall_seconds=wall_seconds,
    )  # fmt: skip


def faultless(evidence: Evidence) -> bool:
    """Everything wanted is where it belongs, and nothing else was touched that should not be."""
    things = evidence.things
    return bool(things) and all(t.delivered for t in things) and not evidence.hits and not evidence.disturbed


def _outcome(case: Case, seen: Observed) -> Outcome:
    evidence = seen.evidence
    there = bool(evidence.things) and all(t.delivered for t in evidence.things)
    untouched = not evidence.moved and not evidence.disturbed
    shown = case.expect == "shown" and all(s.shown for s in seen.shown) and (there or not case.wants)
    if seen.crash:
        return "crashed"
    if seen.claimed == "delivered" and not (there if case.expect == "delivered" else shown):
        return "false_success"
    if not seen.ended:
        return "timeout"
    if case.expect == "nothing":
        return "declined" if untouched and evidence.driven < STOOD_STILL else "failed"
    if case.expect == "stopped":
        return "stopped" if seen.stopped and evidence.standing and not evidence.hits else "failed"
    if case.expect == "shown" and shown and not evidence.hits and not evidence.disturbed and not seen.wrong:
        return "shown"
    if case.expect == "delivered" and faultless(evidence):
        return "delivered"
    return "reported" if seen.claimed in ("failed", "cancelled") else "failed"


def cause(case: Case, seen: Observed, outcome: Outcome) -> str:
    """The stage that failed and, where the robot gave one, its code."""
    if outcome == "crashed":
        return f"crash: {seen.crash}"
    if outcome == "timeout":
        return f"timeout: {STAGES.get(seen.stage, 'start')}"
    found = _WHY.search(seen.reason)
    if outcome == "reported" or (found and seen.claimed == "failed"):
        stage = found[1] if found else seen.stage
        return f"{STAGES.get(stage, stage.lower() or 'start')}{': ' + found[2] if found else ''}"
    evidence = seen.evidence
    undelivered = next((t for t in evidence.things if not t.delivered), None)
    if case.expect in ("delivered", "shown") and undelivered is None and (evidence.hits or evidence.disturbed):
        return "contact" if evidence.hits else "disturbed"
    if missing := next((s for s in seen.shown if not s.shown), None):
        return f"effect: {missing.why}"
    if seen.wrong:
        return f"wrong thing: {', '.join(seen.wrong)}"
    if undelivered is not None and seen.claimed == "delivered":
        return f"evidence: {undelivered.why.partition(';')[0]}"
    return f"{STAGES.get(seen.stage, 'start')}: {case.expect} was expected"
