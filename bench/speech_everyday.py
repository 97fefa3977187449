"""Everyday sentences by voice: does the planner make of what was heard what it makes of the typed sentence?"""

from random import Random
from typing import Literal

from common import config
from common.messages import PlanStep
from services.brain.config import BrainConfig
from services.speech.recognise.recogniser import Recognition
from tests.everyday import lists, planned

Outcome = Literal["same", "asked", "asked wrongly", "not understood", "wrong"]
OUTCOMES: tuple[Outcome, ...] = ("same", "asked", "asked wrongly", "not understood", "wrong")
SURE = config.load("brain", BrainConfig, config.DEFAULT_DIR, {}).confirm_below
"""Confidence from which the brain does not ask."""


def drawn(count: int, seed: int) -> list[str]:
    """That many everyday sentences at random, of those that are said without anything before."""
    every = dict.fromkeys(row.said for rows in lists().values() for row in rows if row.context == "-")
    return Random(seed).sample(list(every), count)


def outcome(said: str, heard: Recognition) -> Outcome:
    """What comes of a sentence that was `said`: its plan at once or after "Did you say ...?", or another one."""
    if heard.verdict not in ("accept", "ask") or not heard.text:
        return "not understood"
    wanted, found = _steps(said), _steps(heard.text)
    if heard.verdict == "ask" or heard.confidence < SURE:
        return "asked" if found == wanted else "asked wrongly"
    if found == wanted:
        return "same"
    return "wrong" if any(step.action != "say" for step in found) else "not understood"


def _steps(text: str) -> list[PlanStep]:
    """What the planner makes of a text in the flat of the sentences, after a yes where it asks; empty for nothing."""
    plan = planned(text)
    plan = planned(plan.asks) if plan.asks else plan
    return [*plan.looks, *plan.steps]
