"""Whether a plan does something else than what a sentence most likely asks for. Pure."""

from collections.abc import Sequence

from common.language.normalise import Words
from common.messages import PlanStep
from services.planner.semantic.forms import FORMS, NONE, OTHER, Deed
from services.planner.semantic.ranker import Ranked

UNLIKELY = 0.03
"""Least share of the probability of all requests that the plan's own deed must have (chosen on lists left out:
of 296 plans that were right none has less; of 4 wrong ones 1 has)."""


def contradicted(words: Words, steps: Sequence[PlanStep], ranked: Sequence[Ranked]) -> bool:
    """Does the sentence ask for something, and hardly for what the steps do?

    `ranked`: what the whole sentence may mean. Where it names nothing of what the steps handle ("look again"), that
    cannot be told.
    """
    deeds, objects = _deeds(steps), {word for step in steps for word in step.object.split()}
    if not deeds or (objects and objects.isdisjoint(words)):
        return False
    shares: dict[str, float] = {}
    for candidate, p in ranked:
        deed = FORMS[candidate.form].deed if candidate.form in FORMS else candidate.form
        shares[deed] = shares.get(deed, 0.0) + p
    return shares[OTHER] + sum(shares.get(deed, 0.0) for deed in deeds) < UNLIKELY * (1.0 - shares[NONE])


def _deeds(steps: Sequence[PlanStep]) -> set[Deed]:
    """What could be asked for by one who gets these steps; none for words alone."""
    actions = {step.action for step in steps}
    if any(step.hand_alone for step in steps):
        return {"fingers", "put"}
    if actions & {"place", "release"}:
        return {"put", "bring"} if "return" in actions else {"put", "fingers"}
    if "grasp" in actions:
        return {"take", "bring", "put"}
    return {"go"} if actions & {"find", "navigate", "return"} else set()
