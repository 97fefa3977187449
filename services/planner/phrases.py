"""Noun phrases: `all the red mugs on the counter` as data. Words in, a phrase out. Pure."""

from typing import Literal

import msgspec

from services.planner.forms import Words
from services.planner.vocabulary import DETERMINERS, Sense, Vocabulary

Which = Literal[
    "", "left", "right", "nearest", "farthest", "biggest", "smallest", "first", "second", "third", "last", "other"
]
PRONOUNS = frozenset({"it", "that", "this", "him", "her"})
PLURAL_PRONOUNS = frozenset({"them", "those", "these", "both", "all of them", "both of them", "them all", "all of it"})
_WHICH: dict[str, Which] = {
    "left": "left", "leftmost": "left", "right": "right", "rightmost": "right", "nearest": "nearest",
    "closest": "nearest", "next": "nearest", "farthest": "farthest", "furthest": "farthest", "biggest": "biggest",
    "big": "biggest", "large": "biggest", "largest": "biggest", "bigger": "biggest", "tallest": "biggest",
    "smallest": "smallest", "small": "smallest", "little": "smallest", "smaller": "smallest", "first": "first",
    "second": "second", "third": "third", "last": "last", "other": "other", "another": "other",
}  # fmt: skip
_NUMBERS = {"one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "couple": 2}
_RELATIONS: tuple[tuple[str, str], ...] = (
    ("to the left of", "left of"), ("to the right of", "right of"), ("on the left of", "left of"),
    ("on the right of", "right of"), ("left of", "left of"), ("right of", "right of"), ("in front of", "front of"),
    ("on top of", "on"), ("next to", "near"), ("close to", "near"), ("from inside", "on"), ("out of", "on"),
    ("from", "on"), ("inside", "on"), ("behind", "behind"), ("near", "near"), ("beside", "near"), ("by", "near"),
    ("off", "on"), ("on", "on"), ("in", "on"), ("at", "on"),
)  # fmt: skip
_SIDES: dict[str, Which] = {
    "on the left": "left", "from the left": "left", "to the left": "left", "on the left side": "left",
    "on the right": "right", "from the right": "right", "to the right": "right", "on the right side": "right",
    "on your left": "left", "on your right": "right", "to your left": "left", "to your right": "right",
}  # fmt: skip
_TAILS = ("over there", "there", "you see", "you can see", "you found", "you have found", "you are holding", "you hold")
_CLAUSES = ("that is", "that are", "that's", "which is", "which are", "lying", "standing", "that you see")


class Phrase(msgspec.Struct, frozen=True):
    """`count` 0 means all of them; `any_one`: no matter which; `anchor` are the words after a relation."""

    sense: Sense
    noun: str
    singular: str = ""
    count: int = 1
    any_one: bool = False
    plural: bool = False
    colours: tuple[str, ...] = ()
    which: Which = ""
    side: Which = ""
    relation: str = ""
    anchor: Words = ()
    text: str = ""


def read(words: Words, vocabulary: Vocabulary) -> Phrase | str:
    """The phrase, or the noun that nobody knows."""
    words = _without_tail(words)
    if (whole := _head(words, vocabulary)) is not None:
        return whole
    for at in range(1, len(words)):
        head, rest = words[:at], _without_clause(words[at:])
        side = _SIDES.get(" ".join(rest))
        if side and (phrase := _head(head, vocabulary)):
            which = phrase.which if phrase.which in ("first", "second", "third", "last") else side
            return msgspec.structs.replace(phrase, which=which, side=side, text=" ".join(words))
        for spoken, relation in _RELATIONS:
            width = len(spoken.split())
            if " ".join(rest[:width]) == spoken and len(rest) > width and (phrase := _head(head, vocabulary)):
                return msgspec.structs.replace(phrase, relation=relation, anchor=rest[width:], text=" ".join(words))
    return _noun_of(words)


def _noun_of(words: Words) -> str:
    """The thing that was named, as far as one can tell."""
    for at in range(1, len(words)):
        rest = " ".join(words[at:])
        if any(rest.startswith(f"{spoken} ") for spoken, _ in _RELATIONS):
            words = words[:at]
            break
    while words and (words[0] in DETERMINERS or words[0] in ("all", "both", "of")):
        words = words[1:]
    return " ".join(words)


def _without_tail(words: Words) -> Words:
    text = " ".join(words)
    for tail in _TAILS:
        if text.endswith(f" {tail}"):
            return _without_clause_end(tuple(text.removesuffix(f" {tail}").split()))
    return words


def _without_clause_end(words: Words) -> Words:
    text = " ".join(words)
    for clause in (*_CLAUSES, "that", "which"):
        if text.endswith(f" {clause}"):
            return tuple(text.removesuffix(f" {clause}").split())
    return words


def _without_clause(words: Words) -> Words:
    text = " ".join(words)
    for clause in _CLAUSES:
        if text.startswith(f"{clause} "):
            return tuple(text.removeprefix(f"{clause} ").split())
    return words


def _head(words: Words, vocabulary: Vocabulary) -> Phrase | None:
    """A phrase without relations: quantity, determiners, order, size, colours, noun."""
    rest, count, any_one, every, number = words, 1, False, False, False
    colours: list[str] = []
    which: Which = ""
    while rest:
        found = vocabulary.noun(" ".join(rest))
        if found is not None and not (colours and rest[0] in vocabulary.colours):
            sense, singular, plural = found
            whole = every or (plural and not number)
            return Phrase(
                sense=sense,
                noun=" ".join(rest),
                singular=singular,
                count=0 if whole else count,
                any_one=any_one or (number and not whole) or rest[0] in ("something", "anything"),
                plural=plural,
                colours=tuple(colours),
                which=which,
                side="right" if which == "right" else "left",
                text=" ".join(words),
            )
        word, rest = rest[0], rest[1:]
        if word in ("all", "every", "each"):
            every = True
        elif word == "both":
            count, number = 2, True
        elif word in _NUMBERS:
            count, number = _NUMBERS[word], True
        elif word in ("a", "an", "any", "some"):
            any_one = True
        elif word in DETERMINERS or word == "of":
            continue
        elif word in _WHICH:
            which = _WHICH[word]
            any_one = any_one or word == "another"
        elif word in vocabulary.colours:
            colours.append(vocabulary.colours[word])
        elif word in ("and", "or") and colours:
            every, any_one = every or word == "and", any_one or word == "or"
        else:
            return None
    return None
