"""Is a text, as a recogniser writes it down without any grammar, something that the planner would understand? Pure."""

from collections.abc import Container, Iterator

from common.language.breaks import is_statement
from common.language.discourse import commands
from common.language.meaning import VERBS, WORDS, readings
from common.language.normalise import Words, infinitive
from common.language.quantities import NUMBERS, UNITS
from common.language.simplify import simplified
from common.language.word_order import reworded
from common.language.wording import Action

_UNBOUND: frozenset[Action] = frozenset({"say", "teach", "name_place", "forget"})
"""What may be of words that nobody knows."""
_NOTHING_TO_DO: frozenset[Action] = frozenset({"refuse", "mention", "remark", "thanks", "fetch_named", "named_at"})
"""What is no command, or no more than a name."""
_WORDS_THAT_TURN = (
    "who what when why how if unless not never don't didn't won't can't shouldn't wouldn't no said says told asked"
    " would should he she they but except instead"
)
_TURNING = frozenset(_WORDS_THAT_TURN.split())
"""Words that make a question, a report or a prohibition of an order."""
_SMALL = frozenset(WORDS) | NUMBERS.keys() | {form for unit in UNITS for form in (unit, f"{unit}s")}


def is_understood(text: str, names: Container[str]) -> bool:
    """Is every part of the text a command, a question or a reply whose things and places are of known `names`?

    `names` are single words: of things, places and colours.
    """
    if not (clauses := commands(text)):
        return False
    *before, last = clauses
    return _is_wording(tuple(last.split()), names) and all(
        is_statement(clause) or _is_wording(tuple(clause.split()), names) for clause in before
    )


def turns(text: str, part: str) -> bool:
    """Are the words of `part` among those of the text, in order, with others that make something else of them?"""
    said, left = text.split(), part.split()
    rest = iter(said)
    return all(word in rest for word in left) and bool(_TURNING.intersection(said).difference(left))


def _is_wording(words: Words, names: Container[str]) -> bool:
    words = words[1:] if words[:1] == ("otherwise",) else words
    for variant in _variants(words):
        for wording, slots in readings(variant, "command", "reply", "name"):
            if wording.action in _NOTHING_TO_DO:
                continue
            said = [word for slot in slots.values() for word in slot]
            if wording.action in _UNBOUND or all(word in names or word in _SMALL or word.isdigit() for word in said):
                return True
    return False


def _variants(words: Words) -> Iterator[Words]:
    """The clause as it stands, simplified, and in other orders of words."""
    for variant in (words, simplified(words), *reworded(words, verbs_only=True)):
        if variant:
            yield (infinitive(variant[0], VERBS), *variant[1:])
