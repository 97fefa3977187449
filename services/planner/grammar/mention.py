"""What is told before a request, and what "it" and "there" mean by it. Pure."""

import re
from contextlib import suppress

from common.language.normalise import DETERMINERS, Words
from services.planner.grammar.chunks import named
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.reference.resolve import referents

_PLACED = re.compile(
    r"\b((?:the|my|a|our) (?:\w+ ){1,3}?)(?:(?:that|which) (?!(?:is|was)\b).+? )?"
    r"(?:(?:is|are|was|were|lies|stands)(?: still| lying| standing)* )?"
    r"(?:on|in|at) (.+)$"
)
"""A thing, and where it is said to be."""

_WHEN = re.compile(
    r" (?:earlier(?: on)?|yesterday|before|(?:earlier )?today|just now|"
    r"a (?:moment|minute|while|bit) ago|last (?:night|time)|"
    r"this (?:morning|afternoon|evening)|again|somewhere|i (?:think|believe|guess))$"
)
"""What is said behind a place and is no part of it."""


def note(words: Words, builder: PlanBuilder) -> None:
    """What is told before a request: the thing and the place that it names last are what "it" and "there" mean."""
    for at in (
        0,
        *(i + 1 for i, w in enumerate(words) if w in ("see", "know", "have", "need", "want", "is", "remember")),
    ):
        if words[at:] and words[at] in DETERMINERS:
            with suppress(Refusal):
                builder.last = [m.object for m in referents(builder, words[at:])]
                return
    if placed := _PLACED.search(_WHEN.sub("", " ".join(words))):  # "my mug is on the desk"
        with suppress(Refusal):
            builder.last = [m.object for m in referents(builder, (*placed[1].split(), "on", *placed[2].split()))]
            return
    things, spots = named(words, builder.vocabulary)
    if things:
        with suppress(Refusal):
            builder.last = [m.object for m in referents(builder, tuple(things[-1].split()))]
    if spots:
        builder.spot = builder.vocabulary.spot(tuple(spots[-1].split()))[0]
