"""Names of rooms and surfaces: the words that name them, and names for those that nobody has named. Pure."""

import re
from collections import Counter
from collections.abc import Sequence
from typing import TypeVar

import msgspec

from common.floor_plan import FloorPlan, Receptacle, Room
from common.messages import PartKind

ROOMS = frozenset({
    "kitchen", "bedroom", "bathroom", "room", "lounge", "hall", "hallway", "corridor", "office", "study", "nursery",
    "pantry", "garage", "loo", "toilet", "cellar", "attic", "conservatory", "kitchenette", "entrance", "landing",
    "laundry", "workshop", "playroom", "den", "foyer", "porch",
})  # fmt: skip
"""Words that a room's name ends with."""
SURFACES = frozenset({
    "table", "desk", "shelf", "shelves", "counter", "worktop", "bench", "sideboard", "dresser", "cupboard", "cabinet",
    "nightstand", "stand", "bookshelf", "bookcase", "sink", "basin", "bin", "basket", "hamper", "tray", "rack", "top",
    "island", "bar", "commode", "drawers", "windowsill", "sill", "bed", "sofa", "couch", "stool", "chair", "ottoman",
    "workbench", "surface", "trolley", "washstand",
})  # fmt: skip
"""Words that a surface's name ends with."""
FOR_PEOPLE = frozenset({"bed", "sofa", "couch", "chair", "stool", "ottoman", "bench"})
"""Last words of the names of furniture that people lie or sit on."""
PLACES = frozenset({
    "place", "spot", "corner", "door", "doorway", "window", "station", "dock",
})  # fmt: skip
"""Words that the name of somewhere to stand ends with."""
P = TypeVar("P", bound=FloorPlan)


def kind_named(name: str) -> PartKind | None:
    """What a name like `standing desk` or `kids room` names by its last word, None when that is no word for a part."""
    last = name.split()[-1] if name.split() else ""
    for word in (last, last.removesuffix("s")):
        if word in ROOMS:
            return "room"
        if word in SURFACES:
            return "surface"
        if word in PLACES:
            return "place"
    return None


def is_for_people(name: str) -> bool:
    """True when a surface's name says that people lie or sit on it, as `bed 2 in the bedroom`."""
    words = [word for word in name.split(" in ")[0].split() if not word.isdigit()]
    return bool(words) and words[-1] in FOR_PEOPLE


def with_part_names(plan: P) -> P:
    """The plan with names for what has none: `room 2`, `table in the kitchen`. Identifiers stay as aliases."""
    if all(r.named for r in plan.rooms) and all(r.named for r in plan.receptacles):
        return plan
    rooms = tuple(_named_room(room, number) for number, room in enumerate(plan.rooms, 1))
    named = msgspec.structs.replace(plan, rooms=rooms)
    return msgspec.structs.replace(named, receptacles=_named_surfaces(named))


def _named_room(room: Room, number: int) -> Room:
    if room.named:
        return room
    return msgspec.structs.replace(room, name=f"room {number}", aliases=(*room.aliases, room.name))


def _named_surfaces(plan: FloorPlan) -> tuple[Receptacle, ...]:
    taken = {n for r in plan.receptacles if r.named for n in (r.name, *r.aliases)}
    wishes = [_wishes(plan, r) if not r.named else [r.name] for r in plan.receptacles]
    found: list[Receptacle] = []
    for r, wished in zip(plan.receptacles, wishes, strict=True):
        if r.named:
            found.append(r)
            continue
        name = next((w for n, w in enumerate(wished) if _tells_apart(n, w, wishes) and w not in taken), "")
        name = name or _numbered(wished[0], _noun(r), taken)
        taken.add(name)
        aliases = tuple(a for a in (*r.aliases, r.name) if a != name)
        found.append(msgspec.structs.replace(r, name=name, aliases=aliases))
    return tuple(found)


def _wishes(plan: FloorPlan, r: Receptacle) -> list[str]:
    """Candidate names of a receptacle, the shortest first: `sofa` and `low table` are better words than its kind."""
    noun = _noun(r)
    room = plan.room_at(r.center[0], r.center[1])
    where = f" in {room.name}" if room and not room.named else f" in the {room.name}" if room else ""
    return [f"{noun}{where}", *([f"{r.colour} {noun}{where}"] if r.colour else [])]


def _noun(r: Receptacle) -> str:
    """The receptacle's identifier without its number where that is a word for a surface, else its kind."""
    word = re.sub(r"[\s_-]*\d+$", "", r.name).replace("_", " ")
    return word if kind_named(word) == "surface" else r.kind


def _tells_apart(n: int, wish: str, wishes: Sequence[Sequence[str]]) -> bool:
    return Counter(w[n] for w in wishes if len(w) > n)[wish] == 1


def _numbered(wish: str, noun: str, taken: set[str]) -> str:
    """`table 2 in the kitchen` where `table in the kitchen` would be one of several."""
    where = wish.removeprefix(noun)
    return next(name for n in range(1, len(taken) + 2) if (name := f"{noun} {n}{where}") not in taken)
