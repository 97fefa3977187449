"""A household with what people have told of it since: names of its parts, and where things belong. Pure."""

import msgspec

from common.floor_plan import Place, Receptacle, Room
from common.household import Household
from common.messages import HouseholdEdits, PlaceName, TidyRule
from common.part_names import with_part_names
from common.words import Destination


def edited(household: Household, edits: HouseholdEdits) -> Household:
    """A `household` as its file has it, with names for all parts and all edits: parts keep their order, and what a part
    was called stays an alias.

    Names of parts that the household does not have are left out: another map may have them.
    """
    if not edits.names and not edits.rules:
        return _delivering(with_part_names(household))
    given = {(n.kind, n.part): n.name for n in edits.names if n.part}
    said = {n.name for n in edits.names}
    surfaces = tuple(_renamed(r, given.get(("surface", r.name), ""), said) for r in household.receptacles)
    rooms = tuple(_renamed_room(r, given.get(("room", r.name), ""), said) for r in household.rooms)
    new_rooms = tuple(Room(name=n.name, low=n.low, high=n.high) for n in edits.names if n.kind == "room" and not n.part)
    places = tuple(p for p in household.places if p.name not in said)
    stands = tuple(_place(n) for n in edits.names if n.kind == "place")
    rules = tuple(map(_destination, reversed(edits.rules)))
    words = msgspec.structs.replace(household.words, tidy=(*rules, *household.words.tidy))
    changed = msgspec.structs.replace(
        household, receptacles=surfaces, rooms=(*new_rooms, *rooms), places=(*places, *stands), words=words
    )
    return _delivering(with_part_names(changed))


def _delivering(household: Household) -> Household:
    """The place that things are brought to by its present name."""
    surface = household.receptacle(household.delivery) if household.delivery else None
    if surface is None or surface.name == household.delivery:
        return household
    return msgspec.structs.replace(household, delivery=surface.name)


def _renamed(r: Receptacle, name: str, said: set[str]) -> Receptacle:
    others = tuple(a for a in r.aliases if a not in said)
    if not name:
        return msgspec.structs.replace(r, aliases=others)
    old = () if r.name == name else (r.name,)
    return msgspec.structs.replace(r, name=name, named=True, aliases=(*old, *others))


def _renamed_room(r: Room, name: str, said: set[str]) -> Room:
    others = tuple(a for a in r.aliases if a not in said)
    if not name:
        return msgspec.structs.replace(r, aliases=others)
    old = () if r.name == name else (r.name,)
    return msgspec.structs.replace(r, name=name, named=True, aliases=(*old, *others))


def _place(n: PlaceName) -> Place:
    x, y, theta = n.pose
    return Place(name=n.name, x=x, y=y, theta=theta)


def _destination(rule: TidyRule) -> Destination:
    return Destination(to=tuple(rule.to), kinds=tuple(rule.kinds), colours=tuple(rule.colours), names=tuple(rule.names))
