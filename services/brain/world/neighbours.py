"""What stood around the hand at work, and which of it lies or has fallen off since, by what perception saw. Pure."""

import math
from collections.abc import Iterable, Mapping

import msgspec

from common.geometry import Pose2
from common.messages import Vec3, WorldObject
from services.brain.world.placement import TIPPED, lies

AROUND = 1.5
"""Distance [m] from the base's middle up to which the arm may come by: its reach and its place on the base."""
FRESH = 60.0
"""Age [s] up to which a sighting tells how something stands now. Chosen: it was seen as the robot drove up to it."""
SHIFTED = 0.03
"""Least way [m] of the middle of what goes over, more than the error of two sightings: what is only told to lie by
another look at it has not moved. What is measured badly, as from afar, has to have moved by more than its measures are
off as well."""
SUNK = 0.003
"""How much lower [m] the middle of what fell over is at least: half of what a short mug is higher than wide. Chosen: a
flat toy that another look measures as lying is as high as before."""
LOWER = 0.10
"""How much lower [m] something lies that has fallen off its surface. Chosen: a step of furniture."""


class Stood(msgspec.Struct, frozen=True):
    """A thing that stood when the hand began to work near it: where its middle was [m, map], and on what."""

    label: str
    position: Vec3
    on: str
    seen_at: float


def standing(objects: Iterable[WorldObject], base: Pose2, now: float) -> dict[str, Stood]:
    """The things that stand within reach of the base by sightings of late; keys are ids, or labels of what has none."""
    found = {}
    for o in objects:
        near = math.dist(base[:2], o.position[:2]) <= AROUND and now - o.seen_at <= FRESH
        if near and not o.held and o.tilt <= TIPPED:
            found[o.id or o.label] = Stood(o.label, o.position, o.on, o.seen_at)
    return found


def knocked_over(stood: Mapping[str, Stood], objects: Iterable[WorldObject], handled: Iterable[str]) -> list[str]:
    """What fell over or off its surface, in clauses for people: things that stood and were seen to lie since.

    `handled`: ids and labels of the things that the robot was to move, which are judged elsewhere.
    """
    ours, found = set(handled), []
    for o in objects:
        was = stood.get(o.id or o.label)
        if was is None or o.held or o.seen_at <= was.seen_at or {o.id or o.label, o.label, was.label} & ours:
            continue
        if was.position[2] - o.position[2] > LOWER and o.on != was.on:
            found.append(f"the {o.label} fell off the {was.on}" if was.on else f"the {o.label} fell down")
        elif (
            lies(o.tilt)
            and was.position[2] - o.position[2] > SUNK
            and math.dist(o.position, was.position) > SHIFTED + o.spread
        ):
            found.append(f"the {o.label} fell over")
    return found
