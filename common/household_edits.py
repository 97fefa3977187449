"""A household with the edits that people have told: names of its parts, and where things belong. Pure."""

import math
from typing import TypeVar

import msgspec

from common.floor_plan import Place, Receptacle, Room
from common.household import Household
from common.messages import HouseholdEdits, PartKind, PlaceName, TidyRule, Vec3
from common.naming.part_names import with_part_names
from common.naming.words import Destination

Part = TypeVar("Part", Receptacle, Room)
MOVED = 0.6
"""Distance [m] of its middle from where it was up to which a surface is the same; chosen: half a small table."""


def edited(household: Household, edits: HouseholdEdits) -> Household:
    """A `household` as its file has it, with names for all parts and all edits: parts keep their order, and what a part
    was called stays an alias.

    Names of parts that the household does not have are left out: another map may have them.
    """
    if not edits.names and not edits.rules:
        return _delivering(with_part_names(household))
    surface_names = {r.name: n.name for n in edits.names if (r := _surface_of(n.kind, n.part, n.at, household))}
    room_names = {room.name: n.name for n in edits.names if (room := _room_of(n, household))}
    said = {n.name for n in edits.names}
    surfaces = tuple(_renamed(r, surface_names.get(r.name, ""), said) for r in household.receptacles)
    rooms = tuple(_renamed(r, room_names.get(r.name, ""), said) for r in household.rooms)
    new_rooms = tuple(Room(name=n.name, low=n.low, high=n.high) for n in edits.names if n.kind == "room" and not n.part)
    places = tuple(p for p in household.places if p.name not in said)
    stands = tuple(_place(n) for n in edits.names if n.kind == "place")
    rules = tuple(_destination(rule, household) for rule in reversed(edits.rules))
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


def _surface_of(kind: PartKind, part: str, at: Vec3 | None, household: Household) -> Receptacle | None:
    """The surface that was called `part` when its middle was `at`: by its name while it is there, else by its place."""
    if kind != "surface" or not part:
        return None
    named = household.receptacle(part)
    if at is None or (named is not None and math.dist(named.center, at) < MOVED):
        return named
    nearest = min(household.receptacles, key=lambda r: math.dist(r.center, at), default=None)
    return nearest if nearest is not None and math.dist(nearest.center, at) < MOVED else None


def _room_of(n: PlaceName, household: Household) -> Room | None:
    """The room that was called `n.part` when its middle was `n.at`."""
    if n.kind != "room" or not n.part:
        return None
    if n.at is not None:
        return household.room_at(n.at[0], n.at[1])
    return next((r for r in household.rooms if r.name == n.part), None)


def _renamed(part: Part, name: str, said: set[str]) -> Part:
    aliases: tuple[str, ...] = tuple(a for a in part.aliases if a not in said)
    if not name:
        return msgspec.structs.replace(part, aliases=aliases)
    if part.name != name:
        aliases = (part.name, *aliases)
    return msgspec.structs.replace(part, name=name, named=True, aliases=aliases)


def _place(n: PlaceName) -> Place:
    x, y, theta = n.pose
    return Place(name=n.name, x=x, y=y, theta=theta)


def _destination(rule: TidyRule, household: Household) -> Destination:
    first = _surface_of("surface", rule.to[0], rule.at, household) if rule.to else None
    to = (first.name, *rule.to[1:]) if first is not None else tuple(rule.to)
    return Destination(to=to, kinds=tuple(rule.kinds), colours=tuple(rule.colours), names=tuple(rule.names))
