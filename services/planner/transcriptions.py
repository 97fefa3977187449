"""Which of several transcriptions of one utterance was most likely said, by what would be done for each. Pure."""

import math
from collections.abc import Callable, Collection, Sequence
from functools import cache

from common.messages import SENSELESS, ActionPlan, PlanStep, Transcription

PLANNED, UNLISTED, ANSWERED, GUESSED, REFUSED, NOTHING = 0.0, 1.5, 1.5, 2.0, 3.0, 4.0
"""How much rarer than a command that is understood, of things that are known, is said to the robot what names others,
what is only answered (people ask for five things to one question), what is only guessed, what it cannot do, and what it
does not understand: a natural logarithm."""
MARGIN = 1.0
"""Natural logarithm of how much likelier what was heard first has to be than anything else that could be done for it
not to be asked about."""
LEAST = 1e-3
"""Score of a transcription that has none."""

Planner = Callable[[str], ActionPlan]


def chosen(heard: str, alternatives: Sequence[Transcription], plan: Planner, known: Collection[str]) -> ActionPlan:
    """The plan for what was `heard` first; without steps, and what to ask about, where another one may be meant.

    `known`: labels of things that the household has or that were seen. Another transcription counts only where a plan
    can be made for it, and it is never acted on: it is a suggestion. What was heard first sounds as likely as any
    other, for whoever listened chose it, and is a suggestion itself where it is hardly likelier.
    A plan takes up to a second for a long sentence: none is made that cannot change the outcome, and none twice.
    """
    plan = cache(plan)
    first = plan(heard)
    scores = [one.score for one in alternatives]
    worth = math.log(max(1.0 - sum(scores), *scores, LEAST)) - cost(first, known)
    text, best = "", worth - MARGIN
    for one in sorted(alternatives, key=lambda one: -one.score):
        likely = math.log(max(one.score, LEAST))
        if likely <= best:
            break  # even a plan for known things would be worth no more
        other = plan(one.text)
        value = likely - cost(other, known)
        if value > best and (steps := _done(other, plan)) and steps != _done(first, plan):
            text, best = (one.text, value) if value > worth else (heard, worth)
    if not text:
        return first
    return ActionPlan(request_id=first.request_id, steps=[], source=first.source, detail=DOUBTFUL, suggestion=text)


DOUBTFUL = "I am not sure what I heard"
"""The reason for a plan without steps that asks which transcription is meant."""


def cost(found: ActionPlan, known: Collection[str]) -> float:
    """How much less likely a transcription is for what its plan is, a negative log-probability."""
    if all(step.action == "say" for step in found.steps) and found.steps:
        return ANSWERED
    if found.steps:
        unlisted = any(step.object and step.object not in known for step in found.steps)
        return UNLISTED if unlisted else PLANNED
    if found.suggestion:
        return GUESSED
    return NOTHING if found.detail.startswith(SENSELESS) else REFUSED


def _done(found: ActionPlan, plan: Planner) -> list[PlanStep]:
    """What is done in the end: the steps of a plan, or of what it suggests after a yes."""
    return plan(found.suggestion).steps if found.suggestion else found.steps
