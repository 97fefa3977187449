"""Spatial relations and superlatives: which of several objects is left, nearest, biggest, next to something. Pure."""

import cmath
import math
from collections.abc import Sequence

from common.language.normalise import enumeration
from services.planner.grammar.phrases import Phrase
from services.planner.grammar.senses import Spot
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.world import BelievedObject

NEAR = 1.5
"""Farthest an object is "near" a place [m] (chosen: a step and an arm's length)."""
BESIDE = 0.6
"""Farthest an object is "next to" another [m] (chosen: both within one reach)."""


def superlative(builder: PlanBuilder, phrase: Phrase, seen: Sequence[BelievedObject]) -> BelievedObject:
    if phrase.which in ("biggest", "smallest"):
        by_size = sorted(seen, key=lambda t: math.prod(t.size))
        if math.isclose(math.prod(by_size[0].size), math.prod(by_size[-1].size), rel_tol=0.05) and len(seen) > 1:
            raise Refusal(f"they are all of the same size: {enumeration([f'the {t.label}' for t in by_size])}")
        return by_size[-1 if phrase.which == "biggest" else 0]
    if phrase.which in ("tallest", "shortest"):
        by_height = sorted(seen, key=lambda t: t.size[2])
        if math.isclose(by_height[0].size[2], by_height[-1].size[2], rel_tol=0.05) and len(seen) > 1:
            raise Refusal(f"they are all of the same height: {enumeration([f'the {t.label}' for t in by_height])}")
        return by_height[-1 if phrase.which == "tallest" else 0]
    if phrase.which in ("nearest", "farthest"):
        by_distance = sorted(seen, key=builder.world.distance)
        return by_distance[0 if phrase.which == "nearest" else -1]
    with_place = [t for t in seen if t.position]
    sign = 1 if phrase.side == "right" else -1
    placed = sorted(with_place, key=lambda t: sign * _bearing(builder, t, with_place))
    if not placed:
        raise Refusal(f"I have not seen which {phrase.noun} that is")
    if phrase.which == "middle":
        if len(placed) % 2 == 0:
            raise Refusal(f"there is none in the middle of {enumeration([f'the {t.label}' for t in placed])}")
        return placed[len(placed) // 2]
    index = {"left": 0, "first": 0, "second": 1, "third": 2, "right": 0, "last": -1}[phrase.which]
    if index >= len(placed):
        raise Refusal(f"I see only {len(placed)} of them")
    return placed[index]


def _bearing(builder: PlanBuilder, item: BelievedObject, group: Sequence[BelievedObject]) -> float:
    """Angle to the left of the middle of a group, as the robot would see it from where it stands [rad]."""
    x, y, _ = builder.world.pose
    rays = [complex(t.position[0] - x, t.position[1] - y) for t in (item, *group) if t.position]
    middle = sum(ray / max(abs(ray), 1e-9) for ray in rays[1:])
    return cmath.phase(rays[0] / middle) if abs(middle) > 1e-9 else cmath.phase(rays[0])


def holds(builder: PlanBuilder, relation: str, item: BelievedObject, anchor: BelievedObject) -> bool:
    if relation in ("left of", "right of"):
        turn = _bearing(builder, item, (item, anchor)) - _bearing(builder, anchor, (item, anchor))
        return (turn > 0) == (relation == "left of")
    if relation in ("behind", "front of"):
        farther = builder.world.distance(item) > builder.world.distance(anchor)
        return farther == (relation == "behind")
    return between(item, anchor) < BESIDE if relation == "near" else item.on == anchor.label


def is_near(builder: PlanBuilder, item: BelievedObject, place: Spot) -> bool:
    """On a surface or a step away from it, or from a standing place; in a room."""
    if place.room:
        return builder.world.room_of(item) == place.name
    where = builder.vocabulary.position(place)
    if item.on == place.name or where is None or item.position is None:
        return item.on == place.name
    return math.dist(where, item.position[:2]) < NEAR


def between(a: BelievedObject, b: BelievedObject) -> float:
    """Distance of two things [m]; infinite where nobody knows where one of them is, as after it was put somewhere."""
    return math.dist(a.position, b.position) if a.position and b.position else math.inf


def is_between(item: BelievedObject, one: BelievedObject, other: BelievedObject) -> bool:
    """On the way from one thing to the other, on the surface of one of them, and not far beside it."""
    if item.position is None or item.on not in (one.on, other.on):
        return False
    assert one.position is not None and other.position is not None
    way = complex(other.position[0] - one.position[0], other.position[1] - one.position[1])
    to = complex(item.position[0] - one.position[0], item.position[1] - one.position[1])
    along = to * way.conjugate() / max(abs(way), 1e-9) ** 2
    return 0.0 < along.real < 1.0 and abs(along.imag) * abs(way) < BESIDE / 2


def away(builder: PlanBuilder, place: Spot) -> float:
    x, y, _ = builder.world.pose
    where = builder.vocabulary.position(place)
    return math.dist(where, (x, y)) if where else 0.0


def spoken(relation: str) -> str:
    return {"front of": "in front of", "near": "near", "behind": "behind", "on": "on"}.get(relation, f"{relation}")
