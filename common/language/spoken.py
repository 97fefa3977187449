"""Is a text, as a recogniser writes it down without any grammar, something that the planner would understand? Pure."""

import re
from collections.abc import Container, Iterator
from typing import Literal

from common.kinds import KINDS
from common.language.apposition import NO_NOUN
from common.language.breaks import is_statement
from common.language.contractions import expand
from common.language.discourse import commands
from common.language.meaning import VERBS, WORDS, readings
from common.language.mood import forbids, is_told
from common.language.normalise import DETERMINERS, Words, infinitive
from common.language.pattern import Slots
from common.language.quantities import NUMBERS, UNITS
from common.language.refusals import REFUSALS
from common.language.simplify import simplified
from common.language.verb_classes import classes
from common.language.word_order import reworded
from common.language.wording import COURTESIES, Action
from common.naming.names import ALIKE

Understanding = Literal["", "unlisted", "listed"]
GRADES: tuple[Understanding, ...] = ("", "unlisted", "listed")
LONGEST = 3
"""Most words of an unlisted noun (chosen: `portable record player`)."""
_UNBOUND: frozenset[Action] = frozenset({"say", "teach", "name_place", "forget"})
"""What may be of words that nobody knows."""
_NOTHING_TO_DO: frozenset[Action] = frozenset({"refuse", "mention", "remark", *COURTESIES, "fetch_named", "named_at"})
"""What is no command, or no more than a name."""
_WORDS_THAT_TURN = (
    "who what when why how if unless not never don't didn't won't can't shouldn't wouldn't no said says told asked"
    " would should he she they but except instead"
)
_TURNING = frozenset(_WORDS_THAT_TURN.split())
"""Words that make a question, a report or a prohibition of an order."""
_IS = frozenset({"is", "are", "was", "were", "has", "have", "had"})
_POINTS = re.compile(r"\b(?:it|them|one|ones)\b")
"""Words that may stand for a thing of which something was told before."""
_NAMELESS = DETERMINERS | {"me", "us"} | (ALIKE.keys() - KINDS.keys())
"""Words that name no thing without another one: after `get me the red` the noun was not heard."""
BETWEEN = frozenset(WORDS) | NUMBERS.keys() | {form for unit in UNITS for form in (unit, f"{unit}s")}
"""Words of what can be said that are no names."""


def understood(text: str, names: Container[str]) -> Understanding:
    """Is every part of the text a command, a question or a reply?

    `names` are single words: of things, places and colours. What is "listed" has no others. What is "unlisted" is said
    or taught in any words, or of one thing that nobody has listed: a determiner and a noun of at most `LONGEST` words;
    or told in such words before "it" is asked for.
    """
    if not (clauses := commands(text)):
        return ""
    *before, _ = clauses
    told = [clause for clause in before if is_statement(clause)]
    grades = [_grade(tuple(clause.split()), names) for clause in clauses if clause not in told]
    if _POINTS.search(text) and not all(_is_known(word, names) for clause in told for word in clause.split()):
        grades.append("unlisted")
    return min(grades, key=GRADES.index)


def turns(text: str, part: str) -> bool:
    """Are the words of `part` among those of the text, in order, with others that make something else of them?"""
    said, left = text.split(), part.split()
    rest = iter(said)
    return all(word in rest for word in left) and bool(_TURNING.intersection(said).difference(left))


def perhaps(text: str, names: Container[str]) -> bool:
    """May the text ask for something in words of its own? It names a thing or a place and forbids and tells nothing."""
    plain = expand(text)
    words = tuple(plain.replace(",", " ").split())
    named = any(word in names and word not in _NAMELESS | NO_NOUN | {"of"} for word in words)
    if any(wording in REFUSALS and not wording.lost for wording, _ in readings(words, "command")):
        return False
    asks = any(classes(word) & {"wish", "seek"} for word in words) or (words[0] in DETERMINERS and not _IS & set(words))
    told = is_told(words) or (is_statement(plain) and not asks)
    return named and len(words) > 1 and not (told or forbids(plain))


def _grade(words: Words, names: Container[str]) -> Understanding:
    """The best that any reading of a clause is understood."""
    words = words[1:] if words[0] == "otherwise" and len(words) > 1 else words
    found: set[Understanding] = {""}
    for variant in _variants(words):
        for wording, slots in readings(variant, "command", "reply", "name"):
            if wording.action not in _NOTHING_TO_DO:
                found.add(_grade_of_slots(wording.action, slots, names))
    return max(found, key=GRADES.index)


def _grade_of_slots(action: Action, slots: Slots, names: Container[str]) -> Understanding:
    if action in _UNBOUND:
        return "unlisted"
    if "thing" in slots and _NAMELESS.issuperset(slots["thing"]):
        return ""
    unlisted = [name for name, said in slots.items() if not all(_is_known(word, names) for word in said)]
    if not unlisted:
        return "listed"
    return "unlisted" if unlisted == ["thing"] and _is_noun(slots["thing"], names) else ""


def _is_known(word: str, names: Container[str]) -> bool:
    return word in names or word in BETWEEN or word.isdigit()


def _is_noun(words: Words, names: Container[str]) -> bool:
    """A determiner, a noun with unknown words, and then only what is known: `the oat milk from the desk`."""
    unknown = [k for k, word in enumerate(words) if not _is_known(word, names)]
    between = words[1 : unknown[-1] + 1]
    return words[0] in DETERMINERS and 0 < len(between) <= LONGEST and not NO_NOUN.intersection(between)


def _variants(words: Words) -> Iterator[Words]:
    """The clause as it stands, simplified, and in other orders of words."""
    for variant in (words, simplified(words), *reworded(words, verbs_only=True)):
        if variant:
            yield (infinitive(variant[0], VERBS), *variant[1:])
