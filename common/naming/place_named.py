"""Splitting of a phrase into a thing and the place that it ends with: `the gnome from the sofa`. Pure."""

import re
from collections.abc import Sequence

from common.household import Household
from common.messages import PossibleObject, WorldObject
from common.naming.names import normalise

_PLACE = re.compile(
    r"^(?P<thing>.+?)(?: (?:which|s|is|are|lies|lying|stands|standing|sits|sitting))*"
    r" (?:on top|on|in|inside|from|at|by|near|next)(?: of)? (?P<place>.+)$"
)
FLOOR = "floor"
"""The place of what stands on nothing else; behind the name of a room, of what does so there."""


def take_place(words: str, household: Household) -> tuple[str, str]:
    """The receptacle, room or piece of furniture that a phrase ends with, "" for none, and the phrase without it."""
    match = _PLACE.match(words)
    if match is None:
        return "", words
    wanted, thing = match["place"], match["thing"]
    if wanted == FLOOR:
        return FLOOR, thing
    if FLOOR in wanted.split():
        # "The bedroom floor", "the floor in the bedroom".
        where = " ".join(w for w in wanted.split() if w not in (FLOOR, "in"))
        room = _named(where, [(r.name, r.aliases) for r in household.rooms])
        return (f"{room} {FLOOR}", thing) if room else ("", words)
    place = place_named(wanted, household) or place_named(wanted.partition(" in ")[0], household)
    return (place, thing) if place else ("", words)


def place_named(words: str, household: Household) -> str:
    """The name of the receptacle, room or piece of furniture that the words stand for; "" for none."""
    rooms = [(r.name, r.aliases) for r in household.rooms]
    seats = [(f.name, (_seat(f.name), *_aliases(_seat(f.name), household))) for f in household.furniture]
    return _named(words, [(r.name, r.aliases) for r in household.receptacles] + rooms + seats)


def is_at(o: WorldObject | PossibleObject, place: str, household: Household) -> bool:
    """Whether an object is at a place as `take_place` names it: a receptacle, a room, the floor, or that of a room."""
    if o.on == place or (place == FLOOR and not o.on):
        return True
    room = household.room_at(o.position[0], o.position[1])
    return room is not None and (room.name == place or (f"{room.name} {FLOOR}" == place and not o.on))


def _seat(furniture: str) -> str:
    """The name of the furniture whose seat this is: `sofa` for `sofa seat`."""
    return furniture.removesuffix(" seat")


def _aliases(name: str, household: Household) -> Sequence[str]:
    """Other names of the place before furniture of that name."""
    return next((p.aliases for p in household.places if p.name == name), ())


def _named(wanted: str, names: Sequence[tuple[str, Sequence[str]]]) -> str:
    """The first of several names that words are, or are another name for; "" for none."""
    return next((name for name, aliases in names if wanted in map(normalise, (name, *aliases))), "")
