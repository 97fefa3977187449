"""Noun phrases: `all the red mugs on the counter` as data. Words in, a phrase out. Pure."""

from itertools import pairwise
from typing import Literal

import msgspec

from common.language.lexicon import COMMANDING
from common.language.normalise import DETERMINERS, Words, without_determiners
from common.language.noun_phrase import (
    CURSES,
    NUMBERS,
    SIDES,
    UNSEEN,
    WHICH,
    Relation,
    Which,
    related,
    relations_at,
    with_contents,
    without_clause,
    without_exceptions,
    without_measure,
    without_tail,
)
from services.planner.grammar.senses import Sense
from services.planner.grammar.vocabulary import Vocabulary


class Phrase(msgspec.Struct, frozen=True):
    """`count` 0 means all of them, `among` of how many one is singled out; `any_one`: no matter which.

    `anchor` are the words after a relation, `but` phrases for what is left out.
    """

    sense: Sense
    noun: str
    singular: str = ""
    count: int = 1
    among: int = 0
    any_one: bool = False
    plural: bool = False
    colours: tuple[str, ...] = ()
    which: Which = ""
    side: Which = ""
    relation: Relation | Literal[""] = ""
    anchor: Words = ()
    but: tuple[Words, ...] = ()
    text: str = ""


def read(words: Words, vocabulary: Vocabulary) -> Phrase | str:
    """The phrase, or the noun that nobody knows."""
    # A long enumeration is cut in many ways, whose parts come again and again.
    key = vocabulary.new_nouns, words
    if key not in vocabulary.phrases:
        rest, but = without_exceptions(without_tail(words))
        if but and rest[0] in ("everything", "anything", "all"):
            rest = (*rest, *_where(but[-1], rest))
        phrase = _read(rest, vocabulary)
        if isinstance(phrase, str):
            of = _read(with_contents(rest), vocabulary)
            phrase = of if isinstance(of, Phrase) and not of.sense.new else phrase
        whole = msgspec.structs.replace(phrase, but=but) if but and isinstance(phrase, Phrase) else phrase
        vocabulary.phrases[key] = whole
    known: Phrase | str = vocabulary.phrases[key]
    return known


def _where(left_out: Words, rest: Words) -> Words:
    """`on the desk` of `everything but the mug on the desk`, which says where all of it is."""
    if any(True for _ in related(rest)):
        return ()
    for head, _, _ in related(left_out):
        return left_out[len(head) :]
    return ()


def _read(words: Words, vocabulary: Vocabulary) -> Phrase | str:
    if (whole := _unrelated(words, vocabulary)) is not None:
        return whole
    if (of_place := _of_place(words, vocabulary)) is not None:
        return of_place
    for head, relation, anchor in related(words):
        if relation == "on" and anchor[:1] == ("the",) and anchor[1:2] in (("left",), ("right",)):
            continue  # "the second mug from the left on the desk"
        if any(one == "and" and other in COMMANDING for one, other in pairwise(anchor)):
            continue  # "the duck from the counter and bring it here": the next command
        if phrase := _unrelated(head, vocabulary):
            return msgspec.structs.replace(phrase, relation=relation, anchor=anchor, text=" ".join(words))
    return _noun_of(words)


def _of_place(words: Words, vocabulary: Vocabulary) -> Phrase | None:
    """`the dresser can` as the can on the dresser, where a known noun follows the name of a place."""
    begin = len(words) - len(without_determiners(words))
    for at in range(begin + 1, len(words)):
        spots, noun = vocabulary.spot(words[begin:at]), vocabulary.noun(" ".join(words[at:]))
        if spots and not spots[0].home and noun is not None and not noun[0].every:
            phrase = _head((*words[:begin], *words[at:]), vocabulary)
            if phrase is not None and not vocabulary.spot(words[begin:]):
                return msgspec.structs.replace(phrase, relation="on", anchor=words[begin:at], text=" ".join(words))
    return None


def _unrelated(words: Words, vocabulary: Vocabulary) -> Phrase | None:
    """A phrase without a relation to something else: `the second mug from the left`, `the mug that is red`."""
    if (whole := _head(words, vocabulary)) is not None:
        return whole
    for at in range(1, len(words)):
        side = SIDES.get(" ".join(without_clause(words[at:])))
        if side and (phrase := _head(words[:at], vocabulary)):
            which = phrase.which if phrase.which in ("first", "second", "third", "last") else side
            return msgspec.structs.replace(phrase, which=which, side=side, text=" ".join(words))
    return _with_colours(words, vocabulary)


def _with_colours(words: Words, vocabulary: Vocabulary) -> Phrase | None:
    """`something yellow`, `the mug that is red`."""
    for at in range(1, len(words)):
        if (predicate := _coloured(words[at:], vocabulary)) and (phrase := _head(words[:at], vocabulary)):
            return msgspec.structs.replace(phrase, colours=(*phrase.colours, *predicate), text=" ".join(words))
    return None


def _coloured(words: Words, vocabulary: Vocabulary) -> tuple[str, ...]:
    """Colours that follow what they belong to: `(anything) blue`, `(the mug) that is red`."""
    rest = without_clause(words)
    colours = tuple(vocabulary.colours[w] for w in rest if w in vocabulary.colours)
    return colours if colours and all(w in vocabulary.colours or w in ("and", "or", "in") for w in rest) else ()


def _noun_of(words: Words) -> str:
    """The thing that was named, as far as one can tell."""
    words = next((words[:at] for at in range(1, len(words)) if any(True for _ in relations_at(words[at:]))), words)
    while words and (words[0] in DETERMINERS or words[0] in ("all", "both", "of")):
        words = words[1:]
    return " ".join(words)


def _head(words: Words, vocabulary: Vocabulary) -> Phrase | None:
    """A phrase without relations: quantity, determiners, order, size, colours, noun."""
    return _known_head(words, vocabulary) or _new_head(words, vocabulary)


def _new_head(words: Words, vocabulary: Vocabulary) -> Phrase | None:
    """The name of a thing that nobody has listed or seen, with a determiner or without."""
    rest = without_measure(words)
    any_one = rest[:1] in (("a",), ("an",), ("some",), ("any",), ("one",))
    determined = False
    while len(rest) > 1 and (rest[0] in DETERMINERS or rest[0] in NUMBERS or rest[0] in CURSES):
        if rest[0] in ("the", "my") and rest[1] in ("a", "an", "the"):
            return None  # a word misheard: "the a pull"
        rest, determined = rest[1:], determined or rest[0] not in CURSES
    first = next((i for i, w in enumerate(rest[:-1]) if w not in vocabulary.colours), len(rest) - 1)
    colours, noun = tuple(vocabulary.colours[w] for w in rest[:first]), rest[first:]
    sense = vocabulary.new_noun(noun, determined)
    if sense is None:
        return None
    return Phrase(sense=sense, noun=" ".join(noun), any_one=any_one, colours=colours, text=" ".join(words))


def _known_head(words: Words, vocabulary: Vocabulary) -> Phrase | None:
    rest, count, any_one, every, number = without_measure(words), 1, False, False, False
    among = 0
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
                among=among,
                any_one=any_one or (number and not whole) or rest[0] in ("something", "anything"),
                plural=plural,
                colours=tuple(colours),
                which=which,
                side="right" if which == "right" else "left",
                text=" ".join(words),
            )
        word, rest = rest[0], rest[1:]
        if word in ("left", "right") and rest[:1] == ("of",):  # a relation
            return None
        if word in ("all", "every", "each"):
            every = True
        elif word == "both":
            count, number = 2, True
        elif word in NUMBERS and which:
            among, number = NUMBERS[word], True  # "the taller of the two mugs"
        elif word in NUMBERS:
            count, number = count if number else NUMBERS[word], True  # "two of the three mugs"
        elif word in ("a", "an", "any", "some", "either", "whichever"):
            any_one = True
        elif word in DETERMINERS or word in UNSEEN or word == "of":
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
