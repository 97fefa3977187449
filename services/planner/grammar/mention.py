"""What is told before a request, and what "it" and "there" mean by it. Pure."""

import re
from collections.abc import Sequence
from contextlib import suppress

from common.language.normalise import DETERMINERS, Words
from services.planner.grammar.chunks import named
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.reference.pronouns import speak_of
from services.planner.reference.resolve import referents

_PLACED = re.compile(
    r"\b((?:the|my|a|an|our|some|his|her) (?:\w+ ){1,3}?)(?:somewhere )?(?:(?:that|which) (?!(?:is|was)\b).+? )?"
    r"(?:(?:is|are|was|were|lies|stands|(?:should|must|might|may|could|will)(?: still)? be)"
    r"(?: still| lying| standing| probably| likely| supposed to be| usually| normally)* )?"
    r"(?:on|in|at) (.+)$"
)
"""A thing, and where it is said to be."""

_BESIDE = re.compile(
    r"there (?:is|are|was|were|(?:should|must|might|may|could|ought to|has to)(?: still)? be) "
    r"((?:the|my|a|an|our|some) (?:\w+ ){0,2}?\w+)(?: lying| standing| somewhere)* (?:next to|beside|near|by|close to) "
)
"""A thing, and beside what it is said to be."""

_EXPECTED = re.compile(
    r"\b(?:(?:should|must|might|may|could|will|ought to)(?: still| probably)? be|"
    r"(?:is|are) (?:probably|likely|usually))(?: \w+)? (?:on|in|at|by) "
)
"""Where something is believed to be, unless it is said to be brought there."""

_ASKING = frozenset({"bring", "get", "fetch", "grab", "give", "hand", "pass", "pick", "take", "go", "find"})
"""Verbs that ask for a thing."""

_WHEN = re.compile(
    r" (?:earlier(?: on)?|yesterday|before|(?:earlier )?today|just now|"
    r"a (?:moment|minute|while|bit) ago|last (?:night|time)|"
    r"this (?:morning|afternoon|evening)|again|somewhere|i (?:think|believe|guess))$"
)
"""What is said behind a place and is no part of it."""


def expected(words: Words, following: Sequence[str]) -> bool:
    """Do the words tell where a thing is believed to be, which is then asked for?

    "The mug should be on the desk, bring it here" asks for one way, "the mug should be on the desk" for another.
    """
    asked = bool(following) and following[0] in _ASKING and not {"it", "them", "those", "that"}.isdisjoint(following)
    return asked and "there" not in following and _EXPECTED.search(" ".join(words)) is not None


def note(words: Words, builder: PlanBuilder) -> None:
    """What is told before a request: the thing and the place that it names last are what "it" and "there" mean."""
    for at in (
        0,
        *(i + 1 for i, w in enumerate(words) if w in ("see", "know", "have", "need", "want", "is", "remember")),
    ):
        if words[at:] and words[at] in DETERMINERS:
            with suppress(Refusal):
                speak_of(builder, referents(builder, words[at:]))
                return
    if placed := _PLACED.search(_WHEN.sub("", " ".join(words))):  # "my mug is on the desk"
        with suppress(Refusal):
            speak_of(builder, referents(builder, (*placed[1].split(), "on", *placed[2].split())))
            return
    if beside := _BESIDE.match(" ".join(words)):  # "there should be a cloth next to the bottle"
        with suppress(Refusal):
            speak_of(builder, referents(builder, tuple(beside[1].split())))
        return
    things, spots = named(words, builder.vocabulary, unlisted=builder.vocabulary.new_nouns)
    if things and not (words[:1] == ("there",) and _goes_on(things[-1], words, builder)):
        with suppress(Refusal):
            speak_of(builder, referents(builder, tuple(things[-1].split())))
    if spots:
        builder.spot = builder.vocabulary.spot(tuple(spots[-1].split()))[0]


def _goes_on(thing: str, words: Words, builder: PlanBuilder) -> bool:
    """Is a thing's name but the beginning of one that nobody has listed, as `toy` of `toy helicopter`?"""
    behind = " ".join(words).partition(thing)[2].split()[:1]
    return bool(behind) and builder.vocabulary.unlisted((*thing.split()[-1:], *behind)) is not None
