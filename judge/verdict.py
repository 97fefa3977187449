"""Evidence and claims in, judgement out. Pure."""

from judge.claims import Claim, false_claims
from judge.evidence import Evidence


def untouched(evidence: Evidence) -> bool:
    """The robot hit nothing, and nothing moved that nobody wanted moved."""
    return not evidence.hits and not evidence.disturbed


def objections(evidence: Evidence, claims: list[Claim]) -> list[str]:
    """Everything that speaks against a flawless delivery; empty for one."""
    found = [f"{t.thing}: {t.why}" for t in evidence.things if not t.delivered]
    found += [] if evidence.things else ["nothing was wanted"]
    found += [f"hit: {hit}" for hit in evidence.hits]
    found += [f"disturbed: {name}" for name in evidence.disturbed]
    if number := false_claims(claims):
        found.append(f"{number} false claim{'s' if number > 1 else ''}")
    return found
