"""Grounding: the object that words refer to, by colour, kind, size, side, place and other names; or why none. Pure."""

import math
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field

import msgspec

from common.geometry import Pose2, to_frame
from common.household import Household
from common.messages import PossibleObject, WorldObject
from common.naming.likeness import LEAST, PLAIN, likeness, partly
from common.naming.names import ALIKE, match_object, normalise, unnumbered
from common.naming.place_named import is_at, take_place

_SIDE = re.compile(r"^(?:(?P<a>left|right|middle|nearest|closest|near|far|farthest|other) )?(?P<rest>.*?)"
                   r"(?: (?:on|at|in|from)? ?(?P<b>left|right|middle))?$")  # fmt: skip
_SIZE = {"big": -1, "large": -1, "bigger": -1, "biggest": -1, "small": 1, "little": 1, "smaller": 1, "smallest": 1}
MOST = 10
"""Objects of which it is told that they may be meant. Chosen: more than anybody is asked about."""
Match = Callable[[str, Sequence[WorldObject]], list[WorldObject]]


@dataclass(frozen=True)
class Grounding:
    """What a phrase means: one object, or None with the reason and, when several match, their names.

    `perhaps`: objects that may be meant and do not plainly fit the words, the likeliest first.
    """

    found: WorldObject | None
    reason: str = ""
    candidates: list[str] = field(default_factory=list)
    perhaps: list[PossibleObject] = field(default_factory=list)


@dataclass(frozen=True)
class Phrase:
    """A noun with its colours (`thing`), and what singles one of several out: `place`, `size`, `side`, "" for none."""

    thing: str
    place: str = ""
    size: str = ""
    side: str = ""

    @property
    def where(self) -> str:
        return f" on the {self.place}" if self.place else ""


def ground(
    query: str,
    objects: Sequence[WorldObject],
    household: Household,
    base: Pose2,
    synonyms: Mapping[str, str],
    matching: Match | None = None,
    least: float = PLAIN,
) -> Grounding:
    """The object that `query` names among those known; `base` decides what is left, right and near.

    One whose likeness to the words is below `least` may be meant only. `matching` finds the objects that a noun with
    its colours can mean, by default `match_object`.
    """
    match_noun = matching or (lambda noun, known: match_object(noun, known, household))
    phrase = parsed(query, household, synonyms)
    thing = phrase.thing
    if not thing:
        return Grounding(None, "no object was named")
    found = [o for o in match_noun(thing, objects) if not o.held]
    if least and len(found) == 1 and found[0].measured and normalise(found[0].label) == normalise(thing):
        # "Red mug" is the name of one and fits "red mug 2" as well.
        found += [o for o in objects if not o.held and o is not found[0] and unnumbered(o.label) == found[0].label]
    if phrase.place:
        found = [o for o in found if is_at(o, phrase.place, household)]
    if not found:
        held = any(o.held for o in match_noun(thing, objects))
        return Grounding(None, f"the {thing} is in the gripper" if held else f"no {thing} is seen{phrase.where}")
    if len(found) > 1 and phrase.size:
        found = sorted(found, key=lambda o: _SIZE[phrase.size] * o.size[0] * o.size[1] * o.size[2])[:1]
    if len(found) > 1 and phrase.side:
        found = _by_side(found, phrase.side, base)
    if len(found) > 1:
        names = sorted({o.label for o in found})
        if len(names) > 1:
            alike = possible(phrase, found, household)
            return Grounding(None, f"several match: {', '.join(names)}", names, alike)
        found = sorted(found, key=lambda o: -o.confidence)
    if 0.0 < likeness(thing, found[0], household) < least:
        return Grounding(None, f"the {found[0].label} may be the {thing}")
    return Grounding(found[0])


def parsed(query: str, household: Household, synonyms: Mapping[str, str]) -> Phrase:
    """The parts of a phrase; `synonyms`: what is said for what is meant."""
    place, words = take_place(_plain(query, synonyms), household)
    size = next((w for w in words.split() if w in _SIZE), "")
    words = " ".join(w for w in words.split() if w not in _SIZE)
    match = _SIDE.match(words)
    assert match is not None
    side = match["a"] or match["b"] or ""
    return Phrase(match["rest"] if side and match["rest"] else words, place, size, side)


def possible(phrase: Phrase, objects: Sequence[WorldObject], household: Household) -> list[PossibleObject]:
    """The objects that a phrase may mean by their looks, the likeliest first."""
    rated = [
        (likeness(phrase.thing, o, household) or partly(phrase.thing, o, household), o)
        for o in objects
        if not o.held and (not phrase.place or is_at(o, phrase.place, household))
    ]
    rated.sort(key=lambda row: (-row[0], row[1].label))
    return [
        PossibleObject(id=o.id, label=o.label, likeness=round(fit, 3), position=o.position, on=o.on)
        for fit, o in rated[:MOST]
        if fit >= LEAST
    ]


def _plain(query: str, synonyms: Mapping[str, str]) -> str:
    words = normalise(query)
    for said, meant in synonyms.items():
        words = re.sub(rf"\b{re.escape(normalise(said))}\b", meant, words)
    return words


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
    return msgspec.structs.replace(o, kinds=[], colours=[], kind_shares={}, colour_shares={})


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
