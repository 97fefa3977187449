"""The known things and places that any words name, whether or not the words are understood. Pure."""

import re
from contextlib import suppress

from common.language.normalise import DETERMINERS, Words
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import NO_NOUN
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.reference.resolve import referents

MOST_WORDS = 6
"""Words of the longest phrase for a thing or a place (chosen)."""


_PLACED = re.compile(
    r"\b((?:the|my|a|our) (?:\w+ ){1,3}?)(?:(?:is|are|was|were|lies|stands)(?: still| lying| standing)* )?"
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


def named(words: Words, vocabulary: Vocabulary) -> tuple[list[str], list[str]]:
    """Phrases for known things and for places among the words, the longest at each spot."""
    things: list[str] = []
    spots: list[str] = []
    at = 0
    while at < len(words):
        for end in range(min(len(words), at + MOST_WORDS), at, -1):
            span = words[at:end]
            if span[0] in NO_NOUN - DETERMINERS:
                break
            bare = tuple(w for w in span if w not in DETERMINERS)
            if bare and (places := vocabulary.spot(bare)) and not places[0].home:
                spots.append(f"the {' '.join(bare)}")
            elif bare and isinstance(phrase := read(span, vocabulary), Phrase) and _plain(phrase):
                things.append(" ".join(span) if span[0] in DETERMINERS else f"the {' '.join(span)}")
            else:
                continue
            at = end - 1
            break
        at += 1
    return things, spots


def _plain(phrase: Phrase) -> bool:
    """Does it name a kind or a thing, without what that stands next to?"""
    return not phrase.sense.every and not phrase.relation
