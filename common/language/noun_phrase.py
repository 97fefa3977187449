"""Words around a noun: numbers, order and size, relations to other things, clauses that add nothing. Pure."""

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import Literal

from common.language.normalise import DETERMINERS, REMEMBERED, Words

Which = Literal[
    "", "left", "right", "nearest", "farthest", "biggest", "smallest", "tallest", "shortest", "first", "second",
    "third", "last", "middle", "other",
]  # fmt: skip
PRONOUNS = frozenset({"it", "that", "this", "him", "her", "this one", "that one", "this thing", "that thing"})
PLURAL_PRONOUNS = frozenset(
    {
        "them", "those", "these", "both", "all of them", "both of them",
        "the pair of them", "the two of them", "the both of them", "the lot of them",
        "them both", "those two", "these two", "both of those", "them all", "all of it",
    }
)  # fmt: skip
WHICH: dict[str, Which] = {
    "left": "left", "leftmost": "left", "right": "right", "rightmost": "right", "nearest": "nearest",
    "closest": "nearest", "next": "nearest", "farthest": "farthest", "furthest": "farthest", "biggest": "biggest",
    "big": "biggest", "large": "biggest", "largest": "biggest", "bigger": "biggest", "huge": "biggest",
    "larger": "biggest", "massive": "biggest", "enormous": "biggest", "gigantic": "biggest",
    "tall": "tallest", "tallest": "tallest", "taller": "tallest", "high": "tallest",
    "short": "shortest", "shortest": "shortest", "shorter": "shortest", "tiny": "smallest", "teeny": "smallest",
    "smallest": "smallest", "small": "smallest", "littler": "smallest",
    "littlest": "smallest", "little": "smallest", "smaller": "smallest", "first": "first",
    "second": "second", "third": "third", "last": "last", "middle": "middle", "other": "other",
    "different": "other", "another": "other",
}  # fmt: skip
"""Words that single one out of several."""
NUMBERS = {"one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "couple": 2}
Relation = Literal["left of", "right of", "front of", "behind", "near", "between", "on"]
RELATIONS: tuple[tuple[str, Relation], ...] = (
    ("to the left of", "left of"), ("to the right of", "right of"), ("on the left of", "left of"),
    ("on the right of", "right of"), ("left of", "left of"), ("right of", "right of"), ("in front of", "front of"),
    ("on top of", "on"), ("next to", "near"), ("closest to", "near"), ("nearest to", "near"), ("nearest", "near"),
    ("on the left side of", "left of"), ("on the right side of", "right of"), ("from the left side of", "left of"),
    ("from the right side of", "right of"), ("at the left end of", "left of"), ("at the right end of", "right of"),
    ("between", "between"), ("in between", "between"), ("close to", "near"), ("from inside", "on"), ("out of", "on"),
    ("from beside", "near"), ("from next to", "near"), ("from near", "near"), ("from by", "near"), ("from "
     "behind", "behind"),
    ("from between", "between"), ("from in front of", "front of"),
    ("from", "on"), ("inside", "on"), ("behind", "behind"), ("near", "near"), ("beside", "near"), ("by", "near"),
    ("off", "on"), ("on", "on"), ("in", "on"), ("at", "on"),
)  # fmt: skip
"""Words between an object and what it is related to, longer ones first."""
_RELATED = {
    first: [(words, relation) for spoken, relation in RELATIONS if (words := tuple(spoken.split()))[0] == first]
    for first in {spoken.split()[0] for spoken, _ in RELATIONS}
}
"""The same by their first words."""
SIDES: dict[str, Which] = {
    "on the left": "left", "from the left": "left", "to the left": "left", "on the left side": "left",
    "on the right": "right", "from the right": "right", "to the right": "right", "on the right side": "right",
    "at the left end": "left", "on the left end": "left", "at the right end": "right", "on the right end": "right",
    "in the middle": "middle",
    "on your left": "left", "on your right": "right", "to your left": "left", "to your right": "right",
}  # fmt: skip
_BUT = (
    "and not", "but not in", "not in", "but not on", "not on", "not at", "but not",
    "but no", "except for", "except", "apart from", "other than",
    "besides", "excluding", "without", "but", "not",
)  # fmt: skip
"""Words before what is left out."""
_EXCEPT = tuple(tuple(spoken.split()) for spoken in _BUT)
_UNSEEN = (
    "dirty clean empty full used old new nice fresh cold hot warm favourite favorite normal regular ordinary own "
    "lovely pretty good whole remaining same usual more certain single stupid silly dumb "
    "crappy lousy ugly beautiful gorgeous cute dear precious special "
    "beloved horrible awful terrible nasty disgusting filthy grubby messy dusty sticky wet damp ancient spare "
    "extra leftover missing lost forgotten important useless useful handy tasty yummy delicious juicy ripe rotten "
    "healthy cool chilled lukewarm cheap expensive fancy trusty actual real exact particular specific entire "
    "annoying boring amazing awesome fantastic brilliant wonderful great perfect best bad heavy fragile poor "
    "famous funny weird strange proper correct"
)
_CURSES = "damn damned darn darned bloody blasted flipping freaking wretched ruddy bleeding goddamn"
CURSES = frozenset(_CURSES.split())
"""What only tells how somebody feels about a thing, so that it is no part of any name."""
UNSEEN = CURSES.union(_UNSEEN.split())
"""Qualities that nobody can see or that tell nothing apart."""
_MEASURES = frozenset(
    {"piece", "pieces", "bit", "couple", "lot", "one", "some", "any", "all", "both", "each", "kind", "either"}
)
"""Words before "of" that say how much of it."""
_TAILS = (
    "over there", "there", "of mine", "of ours", "of yours", "you see", "you can see", "you found", "you have found",
    "you are holding", "you hold",
    "you can find", "you have got", "we have", "we own", "i have", "we have got", "you have", "you know",
    "you like", "you want", "you fancy", "you please", "no matter which", "anywhere", "someplace", "of something",
    "of any kind", "of some kind", "of some sort", "somewhere", "around here", "in the house",
    "in the flat", "in the apartment", "in the whole house", "at home", "in the building",
)  # fmt: skip
_CLAUSES = (
    "that is lying", "that is standing", "that is sitting", "which is lying", "which is standing", "that stands",
    "that finds itself", "which finds itself", "that lives", "which lives", "that stood", "which stood", "which "
    "stands", "that lay", "that sat", "that lies", "that are lying",
    "that are standing", "you left", "i left", "i put", "that i left", "that i put", "sitting", "that sits",
    "that was", "that were", "which was", "that is", "that are", "that's", "which is", "what is", "that you can find",
    "which you can find", "you can find", "that you will find", "kept", "located", "which are", "lying", "standing",
    "that you see", "you see", "you can see", "you saw", "i see", "i saw", "we have",
)  # fmt: skip


SMALL = tuple(
    frozenset(phrase.split())
    for phrase in (
        *(r for r, _ in RELATIONS),
        *SIDES,
        *_BUT,
        *_CLAUSES,
        *_TAILS,
        *NUMBERS,
        *PRONOUNS,
        *PLURAL_PRONOUNS,
        "and or then please all every each",
    )
)
"""Words between nouns."""


def without_tail(words: Words) -> Words:
    """Words without `(that you see) over there` at their end."""
    text = " ".join(words)
    for tail in _TAILS:
        if text.endswith(f" {tail}"):
            head = text.removesuffix(f" {tail}")
            for clause in (*_CLAUSES, "that", "which"):
                if head.endswith(f" {clause}"):
                    return tuple(head.removesuffix(f" {clause}").split())
            return tuple(head.split())
    return words


@lru_cache(REMEMBERED)
def without_clause(words: Words) -> Words:
    """Words without `that is` at their beginning."""
    text = " ".join(words)
    if words[:1] == ("left",) and words[1:2] in (("on",), ("in",), ("at",)):
        return words[1:]
    for clause in _CLAUSES:
        if text.startswith(f"{clause} "):
            return tuple(text.removeprefix(f"{clause} ").split())
    return words


def without_exceptions(words: Words) -> tuple[Words, tuple[Words, ...]]:
    """Words before `except the red one and the can`, and each of the phrases that follow it."""
    for at in range(1, len(words)):
        rest = without_clause(words[at:])
        for spoken in _EXCEPT:
            if rest[: len(spoken)] == spoken and len(rest) > len(spoken):
                return words[:at], _listed(rest[len(spoken) :])
    return words, ()


def _listed(words: Words) -> tuple[Words, ...]:
    """Phrases joined by and, or and nor."""
    found: list[Words] = []
    start = 0
    for at, word in enumerate((*words, "and")):
        if word in ("and", "or", "nor"):
            found += [words[start:at]] if at > start else []
            start = at + 1
    return tuple(found)


def without_measure(words: Words) -> Words:
    """`a piece of fruit` as `one fruit`, `one of the mugs` as `one mugs`; other words stay."""
    for at, word in enumerate(words[:-1]):
        if word == "of" and at and words[at - 1] in _MEASURES:
            before = words[at - 1]
            if before in ("piece", "bit", "kind", "one", "some", "any", "either"):
                return ("one", *(w for w in words[at + 1 :] if w not in ("the", "my", "our", "your", "those", "these")))
            return (*words[: at - 1], before, *words[at + 1 :]) if before != "lot" else words[at + 1 :]
    return words


_WITH = re.compile(
    r"^(?P<container>.+?)(?: (?:that|which) (?:is|has))? "
    r"(?:with|containing|full of|filled with|of|labell?ed|marked|(?:that )?(?:says|saying|reads|reading)(?: on it)?) "
    rf"(?:(?:{'|'.join(sorted(DETERMINERS))}) )*(?P<contents>.+?)"
    r"(?:(?: written| printed)? (?:in|inside|on) it| inside| in there)?$"
)


def with_contents(words: Words) -> Words:
    """`the box with my vitamins in it` as `the box of vitamins`; other words stay."""
    return tuple(_WITH.sub(r"\g<container> of \g<contents>", " ".join(words)).split())


def related(words: Words) -> Iterator[tuple[Words, Relation, Words]]:
    """Every (object, relation, anchor) reading of a phrase like `the mug that is on the table`."""
    for at in range(1, len(words)):
        rest = without_clause(words[at:])
        for relation, width in relations_at(rest):
            yield words[:at], relation, rest[width:]


def relations_at(words: Words) -> Iterator[tuple[Relation, int]]:
    """The relations with whose words the words begin and go on, and how many these are."""
    for spoken, relation in _RELATED.get(words[0], ()):
        if words[: len(spoken)] == spoken and len(words) > len(spoken):
            yield relation, len(spoken)
