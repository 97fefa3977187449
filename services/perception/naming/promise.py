"""How much a nearer look at an object may tell of whether it is the one that was asked for by its print. Pure."""

from collections.abc import Sequence

from common.household import Household
from common.messages import WorldObject
from common.naming.likeness import LEAST, LIKELY, describes, looks_like, other_goods
from services.perception.naming.sights import ROUGHLY, Sight
from services.perception.naming.text import LIKELY as HALF_READ
from services.perception.naming.text import SURE, likeness, traces
from services.perception.naming.vocabulary import COLOURS, PACKED, unlike_said

LITTLE = 0.04
"""Promise up to which nobody looks. Chosen: what has other words on it, unless all that was said fits its looks."""
PROMISING = LIKELY
"""Promise from which an object is looked at before the search goes on. Chosen: as likely as one is asked about."""
RARELY, ELSEWHERE, OTHERWISE, NAMED = 0.25, 0.6, 0.5, 0.05
"""What is left of the promise of what is of another kind, or shows a side with no print at all, when no word tells of
looks, of what was read on this side in vain, of what has not the colour that was said or that is usual, and of what has
other words on it. Chosen: a mug has print in one of four, a pack with a blank side on another in no more, a box shows
the word on another side in one of two; the last is a misread word in twenty."""


def promise(query: str, words: Sequence[str], o: WorldObject, sight: Sight | None, household: Household) -> float:
    """How likely the `words` of a query that may be print are on an object that was looked at as `sight` says, 0 to 1.

    0 for what is of none of the kinds that the query's words tell of, and for what was read from all sides in vain.
    """
    said = query.split()
    beside = {*said, *COLOURS}
    score, part = likeness(words, o.text, beside), traces(words, o.text)
    other = unlike(o, said, said)
    if score >= HALF_READ:
        return OTHERWISE * score if other else score
    packed = looks_like(query, o, household, packed=True)
    if packed < LEAST and not other:
        return 0.0
    # A pack may have any colour, and "green" may be what is printed on it.
    found = max(OTHERWISE * packed, looks_like(query, o, household), OTHERWISE * LIKELY if other else 0.0)
    blank = sight is not None and sight.legible >= ROUGHLY and not sight.lines
    if not describes(query, household) and (o.kind not in PACKED or blank):
        found *= RARELY
    if other:
        found *= OTHERWISE
    if sight is None or not (sight.read or sight.told):
        return found
    if sight.exhausted:
        return 0.0
    # A part of a word goes on around the side; other words say what else it is.
    others = other_goods(query, o.text, household)
    return max(found * ELSEWHERE, part) if part >= HALF_READ else found * (NAMED if others else ELSEWHERE)


def worth_a_look(promised: float) -> bool:
    """Whether a nearer look is worth its way when nothing else is left."""
    return promised > LITTLE


def unlike(o: WorldObject, said: Sequence[str], others: Sequence[str]) -> bool:
    """Whether a colour or a fruit among `others` of the words `said` is neither the object's nor printed on it."""
    return unlike_said(o, others, lambda word: likeness([word], o.text, {*said, *COLOURS}) >= SURE)
