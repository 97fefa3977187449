"""Names people use for objects and places, matched to the household's."""

import difflib
import re
from collections.abc import Iterable
from functools import lru_cache

from common.household import Household
from common.kinds import KINDS, kind_of
from common.messages import WorldObject
from common.thing import Thing

_FILLER = {"the", "a", "an", "my", "that", "this", "some", "please", "to", "of"}

ANYTHING = {"thing", "things", "object", "objects", "item", "something", "anything", "stuff", "one", "ones"}
"""Words for any object."""
UNFIT = (9, 9)
"""Worse than any fit of words to an object."""
ALIKE = {
    "red": ("pink", "orange", "brown"), "orange": ("red", "yellow", "brown"), "yellow": ("orange", "green", "white"),
    "green": ("yellow", "blue"), "blue": ("green", "purple", "black"), "purple": ("blue", "pink"),
    "pink": ("red", "purple"), "brown": ("orange", "red", "black"), "black": ("grey", "blue", "brown"),
    "grey": ("black", "white"), "white": ("grey", "yellow"),
}  # fmt: skip
"""Words that a colour may turn out to have from nearer and in better light."""


REMEMBERED = 4096
"""Phrases whose words are remembered [count]; chosen: more than a household has names."""
_OF = re.compile(rf"\b({'|'.join(KINDS)}) of (?:(?:the|a|an|my|some) )?(\w+)\b")
"""A kind before what it is of: it is the last word otherwise."""


@lru_cache(REMEMBERED)
def normalise(text: str) -> str:
    """Lower case, no punctuation, no articles, the word for the kind last: a ball of wool is a "wool ball"."""
    words = _OF.sub(r"\2 \1", re.sub(r"[^a-z0-9 ]+", " ", text.lower())).split()
    return " ".join(w for w in words if w not in _FILLER)


def unnumbered(label: str) -> str:
    """The words of a label, without the number that tells it from others of the same: "red mug 2" is a red mug."""
    return re.sub(r" \d+$", "", label)


def match_object(query: str, objects: Iterable[WorldObject], household: Household) -> list[WorldObject]:
    """The known objects that a phrase can mean: by taught name, by name or alias, else by colour and kind, else by
    kind; where none is called so, those that may be so called by their looks, the nearest to it."""
    wanted = normalise(query)
    known = list(objects)
    if taught := [o for o in known if wanted in o.names]:
        return taught
    spec = listed(wanted, household)
    names = {wanted, normalise(spec.name)} if spec else {wanted}
    exact = [o for o in known if normalise(o.label) in names]
    if exact:
        return exact
    words = own_words(wanted, household)
    if not words:
        return []
    fits = [(_fit(words, o), o) for o in known if o.kind]
    best = min((fit for fit, _ in fits), default=UNFIT)
    return [o for fit, o in fits if fit == best] if best < UNFIT else []


def listed(wanted: str, household: Household) -> Thing | None:
    """The thing of the household with a normalised name or alias."""
    return next((o for o in household.things if wanted in map(normalise, (o.name, *o.aliases))), None)


def own_words(wanted: str, household: Household) -> set[str]:
    """The words of a normalised phrase, kinds and colours by the robot's own words for them; not those for anything."""
    told = household.words
    return {w if w in KINDS else told.kind(w) or told.colour(w) or w for w in wanted.split()} - ANYTHING


def _fit(words: set[str], o: WorldObject) -> tuple[int, int]:
    """How well words can mean an object, the less the better: `UNFIT` if they cannot.

    First whether they are its label's words; then whether kind and colours are among those that it has by its looks.
    Among equals counts the place of the kind.
    """
    label = {o.kind, o.colour, *normalise(o.label).split()}
    if words <= label:
        return 0, 0
    kinds = words & set(KINDS)
    # "The orange can": what may be a colour is one beside another kind.
    if len(kinds) > 1:
        kinds -= set(ALIKE)
    shades, likely = words - kinds, o.kinds or [o.kind]
    if not kinds <= {*likely, o.kind} or any(is_ball(kind) != is_ball(likely[0]) for kind in kinds):
        return UNFIT
    place = min((n for n, kind in enumerate(likely) if kind in kinds), default=0)
    return (1, place) if shades <= {*o.colours, *label} else UNFIT


def is_ball(kind: str) -> bool:
    """True for round kinds, balls and fruit, which are taken for each other and for nothing that stands on a foot."""
    return kind_of(kind).shape == "sphere"


def near_names(query: str, names: Iterable[str]) -> list[str]:
    """Names that look like the query, for error messages."""
    return difflib.get_close_matches(normalise(query), list(names), n=3, cutoff=0.5)
