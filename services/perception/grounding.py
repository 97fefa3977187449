"""Grounding: the object that words refer to, by colour, kind, size, side, place and other names; or why none. Pure."""

import math
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field

import msgspec

from common.geometry import Pose2, to_frame
from common.household import Household
from common.messages import WorldObject
from common.naming import ALIKE, match_object, normalise

_SIDE = re.compile(r"^(?:(?P<a>left|right|middle|nearest|closest|near|far|farthest|other) )?(?P<rest>.*?)"
                   r"(?: (?:on|at|in|from)? ?(?P<b>left|right|middle))?$")  # fmt: skip
_PLACE = re.compile(r"^(?P<thing>.+?) (?:on top|on|in|inside|from|at|by|near|next)(?: of)? (?P<place>.+)$")
_SIZE = {"big": -1, "large": -1, "bigger": -1, "biggest": -1, "small": 1, "little": 1, "smaller": 1, "smallest": 1}

Match = Callable[[str, Sequence[WorldObject]], list[WorldObject]]


@dataclass(frozen=True)
class Grounding:
    """What a phrase means: one object, or None with the reason and, when several match, their names."""

    found: WorldObject | None
    reason: str = ""
    candidates: list[str] = field(default_factory=list)


def ground(
    query: str,
    objects: Sequence[WorldObject],
    household: Household,
    base: Pose2,
    synonyms: Mapping[str, str],
    matching: Match | None = None,
) -> Grounding:
    """The object that `query` names among those known; `base` decides what is left, right and near.

    `matching` finds the objects that a noun with its colours can mean, by default `match_object`.
    """
    match_noun = matching or (lambda noun, known: match_object(noun, known, household))
    words = _plain(query, synonyms)
    if not words:
        return Grounding(None, "no object was named")
    place, words = _take_place(words, household)
    size = next((w for w in words.split() if w in _SIZE), "")
    words = " ".join(w for w in words.split() if w not in _SIZE)
    match = _SIDE.match(words)
    assert match is not None
    side = match["a"] or match["b"] or ""
    thing = match["rest"] if side and match["rest"] else words
    found = [o for o in match_noun(thing, objects) if not o.held]
    if place:
        found = [o for o in found if _is_at(o, place, household)]
    where = f" on the {place}" if place else ""
    if not found:
        held = any(o.held for o in match_noun(thing, objects))
        return Grounding(None, f"the {thing} is in the gripper" if held else f"no {thing} is seen{where}")
    if len(found) > 1 and size:
        found = sorted(found, key=lambda o: _SIZE[size] * o.size[0] * o.size[1] * o.size[2])[:1]
    if len(found) > 1 and side:
        found = _by_side(found, side, base)
    if len(found) > 1:
        names = sorted({o.label for o in found})
        if len(names) > 1:
            return Grounding(None, f"several match: {', '.join(names)}", names)
        found = sorted(found, key=lambda o: -o.confidence)
    return Grounding(found[0])


def _plain(query: str, synonyms: Mapping[str, str]) -> str:
    words = normalise(query)
    for said, meant in synonyms.items():
        words = re.sub(rf"\b{re.escape(normalise(said))}\b", meant, words)
    return words


def _take_place(words: str, household: Household) -> tuple[str, str]:
    """The receptacle or room that a phrase ends with, and the phrase without it."""
    match = _PLACE.match(words)
    if match is None:
        return "", words
    wanted = match["place"]
    names = [(r.name, r.aliases) for r in household.receptacles] + [(r.name, r.aliases) for r in household.rooms]
    for name, aliases in names:
        if wanted in map(normalise, (name, *aliases)):
            return name, match["thing"]
    return "", words


def _is_at(o: WorldObject, place: str, household: Household) -> bool:
    if o.on == place:
        return True
    room = household.room_at(o.position[0], o.position[1])
    return room is not None and room.name == place


def _by_side(found: Sequence[WorldObject], side: str, base: Pose2) -> list[WorldObject]:
    def left(o: WorldObject) -> float:
        return to_frame(base, (o.position[0], o.position[1]))[1]

    def far(o: WorldObject) -> float:
        x, y = to_frame(base, (o.position[0], o.position[1]))
        return x * x + y * y

    keys: dict[str, tuple[Callable[[WorldObject], float], bool]] = {
        "left": (left, True), "right": (left, False), "nearest": (far, False), "closest": (far, False),
        "near": (far, False), "far": (far, True), "farthest": (far, True),
    }  # fmt: skip
    if side == "middle":
        ordered = sorted(found, key=left)
        return [ordered[len(ordered) // 2]]
    if side not in keys:
        return list(found)
    key, reverse = keys[side]
    return [sorted(found, key=key, reverse=reverse)[0]]


def as_called(o: WorldObject) -> WorldObject:
    """An object that can be meant by its label alone: what else it may be is in doubt until it is seen better."""
    return msgspec.structs.replace(o, kinds=[], colours=[])


def may_be_meant(
    query: str, objects: Sequence[WorldObject], doubtful: Collection[str], household: Household, base: Pose2
) -> list[str]:
    """Labels of those objects, by their ids `doubtful`, that `query` may mean when they are seen better, nearest first.

    A colour that is named must be among theirs, or near it; shape and kind are what is in doubt.
    """
    words = set(normalise(query).split())
    shades = {household.words.colour(w) or w for w in words} & set(ALIKE)
    held = [o for o in objects if o.id in doubtful and not o.held]
    fit = [o for o in held if all(s in {*o.colours, *ALIKE.get(o.colour, ())} for s in shades)]
    return [o.label for o in sorted(fit, key=lambda o: math.dist(o.position[:2], base[:2]))]
