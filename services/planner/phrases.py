"""Noun phrases: `all the red mugs on the counter` as data. Words in, a phrase out. Pure."""

from typing import Literal

import msgspec

from common.language.normalise import DETERMINERS, Words
from common.language.noun_phrase import (
    NUMBERS,
    RELATIONS,
    SIDES,
    WHICH,
    Relation,
    Which,
    related,
    without_clause,
    without_tail,
)
from services.planner.vocabulary import Sense, Vocabulary


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
    relation: Relation | Literal[""] = ""
    anchor: Words = ()
    text: str = ""


def read(words: Words, vocabulary: Vocabulary) -> Phrase | str:
    """The phrase, or the noun that nobody knows."""
    words = without_tail(words)
    if (whole := _head(words, vocabulary)) is not None:
        return whole
    for at in range(1, len(words)):
        side = SIDES.get(" ".join(without_clause(words[at:])))
        if side and (phrase := _head(words[:at], vocabulary)):
            which = phrase.which if phrase.which in ("first", "second", "third", "last") else side
            return msgspec.structs.replace(phrase, which=which, side=side, text=" ".join(words))
    for head, relation, anchor in related(words):
        if phrase := _head(head, vocabulary):
            return msgspec.structs.replace(phrase, relation=relation, anchor=anchor, text=" ".join(words))
    return _noun_of(words)


def _noun_of(words: Words) -> str:
    """The thing that was named, as far as one can tell."""
    for at in range(1, len(words)):
        rest = " ".join(words[at:])
        if any(rest.startswith(f"{spoken} ") for spoken, _ in RELATIONS):
            words = words[:at]
            break
    while words and (words[0] in DETERMINERS or words[0] in ("all", "both", "of")):
        words = words[1:]
    return " ".join(words)


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
        elif word in NUMBERS:
            count, number = NUMBERS[word], True
        elif word in ("a", "an", "any", "some"):
            any_one = True
        elif word in DETERMINERS or word == "of":
            continue
        elif word in WHICH:
            which = WHICH[word]
            any_one = any_one or word == "another"
        elif word in vocabulary.colours:
            colours.append(vocabulary.colours[word])
        elif word in ("and", "or") and colours:
            every, any_one = every or word == "and", any_one or word == "or"
        else:
            return None
    return None
