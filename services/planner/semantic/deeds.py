"""Whether a plan does something else than what a sentence most likely asks for. Pure."""

from collections.abc import Sequence
from typing import Literal

from common.language.normalise import Words
from common.messages import PlanStep
from services.planner.grammar.chunks import POINTING
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.forms import NONE, OTHER
from services.planner.semantic.ranker import rank

Deed = Literal["bring", "put", "take", "go", "fingers"]
UNLIKELY = 0.03
"""Least share of the probability of all requests that the plan's own deed must have (chosen on lists left out:
of 296 plans that were right none has less; of 4 wrong ones 1 has)."""
LIKELY = 0.5
"""Least probability of the requests about what is known that speak against a thing that nobody knows (chosen)."""
_FORMS: dict[Deed, tuple[str, ...]] = {
    "bring": ("bring", "bring_from", "drink", "eat"),
    "put": (
        "put", "put_from", "near", "away", "tidy", "tidy_up", "discard", "discard_from", "put_back", "down", "rule",
    ),
    "take": ("take",),
    "go": (
        "go", "wait_at", "back", "wait", "find", "find_on", "look", "look_at", "where", "contents", "exists", "on",
        "number", "number_on", "see",
    ),
    "fingers": ("open", "close"),
}  # fmt: skip
"""The forms that ask for each deed; a look answers questions, too."""


def contradicted(words: Words, steps: Sequence[PlanStep], vocabulary: Vocabulary) -> bool:
    """Does the sentence ask for something, and hardly for what the steps do, or rather without a thing nobody knows?

    Where it names nothing of what the steps handle ("look again"), that cannot be told.
    """
    deeds, objects = _deeds(steps), {word for step in steps for word in step.object.split()}
    if not deeds or (objects and objects.isdisjoint(words)):
        return False
    ranked = rank(words, vocabulary)
    strange = any(not _is_known(step.object, vocabulary) for step in steps if step.object)
    # "bring it" beside "I need the stapler" asks for the stapler itself
    others = (p for candidate, p in ranked if candidate.kind == "act" and not _points(candidate.text))
    if strange and sum(others) > LIKELY:
        return True
    shares: dict[str, float] = {}
    for candidate, p in ranked:
        shares[candidate.form] = shares.get(candidate.form, 0.0) + p
    alike = shares[OTHER] + sum(shares.get(form, 0.0) for deed in deeds for form in _FORMS[deed])
    return alike < UNLIKELY * (1.0 - shares[NONE])


def _points(text: str) -> bool:
    """Does a command handle what a pronoun stands for?"""
    return not set(POINTING).isdisjoint(text.split())


def _is_known(label: str, vocabulary: Vocabulary) -> bool:
    """Is a word of the name known, so that the thing may be one of a known kind?"""
    return any(vocabulary.noun(word) is not None for word in label.split())


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
