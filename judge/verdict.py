"""The verdict on a mission from its evidence and claims. Pure."""

from judge.claims import Claim, false_claims
from judge.evidence import Evidence


def untouched(evidence: Evidence) -> bool:
    """True when the robot hit nothing and moved nothing but what it was asked to move."""
    return not evidence.hits and not evidence.disturbed


def objections(evidence: Evidence, claims: list[Claim]) -> list[str]:
    """Reasons against a flawless delivery, in words; empty for one."""
    found = [f"{t.thing}: {t.why}" for t in evidence.things if not t.delivered]
    found += [] if evidence.things else ["nothing was wanted"]
    found += [f"hit: {hit}" for hit in evidence.hits]
    found += [f"disturbed: {name}" for name in evidence.disturbed]
    if number := false_claims(claims):
        found.append(f"{number} false claim{'s' if number > 1 else ''}")
    return found
