"""The plain command nearest to words that fit no construction, by its verb and the known things it names. Pure.

It is asked about first ("Do you mean: put the mug on the desk?") and never carried out unasked. Words that forbid,
report, suppose, tell of the past or ask get no guess.
"""

import re

from common.language.lexicon import BRING, DISCARD, FETCH, GO, MOVE, PUT, SEEK, THROW, TIDY
from common.language.normalise import Words, infinitive
from services.planner.grammar.named import named
from services.planner.grammar.vocabulary import Vocabulary

_NO_REQUEST = re.compile(
    r"\b(?:not|never|no|nobody|none|without|instead|if|unless|would|said|says|told|asked|yesterday|tomorrow|"
    r"already|ever|did|"
    r"had|was|were|went|last|always|used|why|how|who|when|myself|himself|herself|story|suppose|imagine|like)\b"
    r"|^(?:he|she|they|it|what|where|which|is|are|do|does|has|have|i "
    r"(?:am|have|will|should|could|might|must)|we are)\b"
)
_TO = frozenset({"to", "into", "onto", "towards"})
_FORMS: tuple[tuple[str, str, bool], ...] = (
    (f"{THROW} | {DISCARD}", "throw away {thing}", False),
    (PUT, "put {thing} in {spot}", False),
    (MOVE, "put {thing} in {spot}", True),
    (TIDY, "tidy up {spot}", False),
    (f"{BRING} | {FETCH} | want | need | have | love | wish", "bring me {thing}", False),
    (SEEK, "find {thing}", False),
    (f"go | {GO}", "go to {spot}", True),
)
"""Verbs, the command that they come to if what it needs is named, and whether the place has to follow a "to"."""


_ON_A_SIDE = re.compile(
    rf"^((?:{'|'.join(option.split()[0] for option in PUT.split(' | '))}) .+) "
    r"(?:in front of|behind|(?:on |to )?(?:the )?(?:left|right)(?: side)? of) (.+)$"
)
"""Where to put something, more exactly than the robot can."""


def nearest(words: Words, vocabulary: Vocabulary) -> str:
    """A command to ask about, "" when nothing suggests one."""
    if _NO_REQUEST.search(" ".join(words)):
        return ""
    if beside := _ON_A_SIDE.match(" ".join(words)):
        return f"{beside[1]} next to {beside[2]}"
    things, spots = named(words, vocabulary)
    if len(things) > 1 or len(spots) > 1 or not (things or spots):
        return ""
    before = (
        re.search(
            rf"(\w+) (?:(?:the|my|our|your) "
            rf")?{re.escape(spots[0].removeprefix('the '))}\b",
            " ".join(words),
        )
        if spots
        else None
    )
    towards = before is not None and before[1] in _TO
    for verbs, form, to in _FORMS:
        if (to and not towards) or not any(_says(option.split(), words) for option in verbs.split(" | ")):
            continue
        if ("{thing}" in form) == bool(things) and ("{spot}" in form) <= bool(spots):
            return form.format(thing=(things or [""])[0], spot=(spots or [""])[0])
    return ""


def _says(verb: list[str], words: Words) -> bool:
    """Is a verb among the words, in any form and with all of its particles: `got rid of` and not `got`?"""
    heads = {verb[0]}
    return any(infinitive(w, heads) in heads and set(verb[1:]) <= set(words[at + 1 :]) for at, w in enumerate(words))
