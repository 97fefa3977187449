"""Names people use for objects and places, matched to the household's."""

import difflib
import re
from collections.abc import Iterable

from common.household import Household
from common.kinds import KINDS
from common.messages import WorldObject

_FILLER = {"the", "a", "an", "my", "that", "this", "some", "please", "to", "of"}

_ANYTHING = {"thing", "things", "object", "objects", "item", "something", "anything", "stuff"}
UNFIT = (9, 9)
"""Worse than any fit of words to an object."""
ALIKE = {
    "red": ("pink", "orange", "brown"), "orange": ("red", "yellow", "brown"), "yellow": ("orange", "green", "white"),
    "green": ("yellow", "blue"), "blue": ("green", "purple", "black"), "purple": ("blue", "pink"),
    "pink": ("red", "purple"), "brown": ("orange", "red", "black"), "black": ("grey", "blue", "brown"),
    "grey": ("black", "white"), "white": ("grey", "yellow"),
}  # fmt: skip
"""Words that somebody else may use for a measured colour at the limit."""


def normalise(text: str) -> str:
    """Lower case, no punctuation, no articles."""
    words = re.sub(r"[^a-z0-9 ]+", " ", text.lower()).split()
    return " ".join(w for w in words if w not in _FILLER)


def match_object(query: str, objects: Iterable[WorldObject], household: Household) -> list[WorldObject]:
    """The known objects that a phrase can mean: by taught name, by name or alias, else by colour and kind, else by
    kind; where none is called so, those that may be so called by their looks, the nearest to it."""
    wanted = normalise(query)
    known = list(objects)
    if taught := [o for o in known if wanted in o.names]:
        return taught
    spec = next(
        (o for o in household.things if wanted == normalise(o.name) or wanted in map(normalise, o.aliases)), None
    )
    names = {wanted, normalise(spec.name)} if spec else {wanted}
    exact = [o for o in known if normalise(o.label) in names]
    if exact:
        return exact
    told = household.words
    words = {w if w in KINDS else told.kind(w) or told.colour(w) or w for w in wanted.split()} - _ANYTHING
    if not words:
        return []
    fits = [(_fit(words, o), o) for o in known if o.kind]
    best = min((fit for fit, _ in fits), default=UNFIT)
    return [o for fit, o in fits if fit == best] if best < UNFIT else []


def _fit(words: set[str], o: WorldObject) -> tuple[int, int]:
    """How well words, none of which another object is better at, can mean an object: the less the better.

    First whether they are its label's words, then those of what it may be by its looks, then of colours that are near
    its own; among equals, the place among its likely kinds of the one that is meant.
    """
    own = {o.kind, o.colour, *normalise(o.label).split()}
    looks = own | set(o.kinds) | set(o.colours)
    near = looks | {word for shade in o.colours[:2] for word in ALIKE.get(shade, ())}
    tier = next((n for n, known in enumerate((own, looks, near)) if words <= known), None)
    if tier is None:
        return UNFIT
    return tier, min((n for n, kind in enumerate(o.kinds) if kind in words), default=0)


def near_names(query: str, names: Iterable[str]) -> list[str]:
    """Names that look like the query, for error messages."""
    return difflib.get_close_matches(normalise(query), list(names), n=3, cutoff=0.5)
