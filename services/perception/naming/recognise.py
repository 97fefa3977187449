"""Which of the objects in sight have which taught names. Pure.

A taught name means one particular object. What is as unlike as strangers are gets no name; of several that could be the
one, the best has it if it is clearly the best, and all have it if none is, so that the robot asks which.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from services.perception.naming.appearance import nearest
from services.perception.naming.memory import Taught
from services.perception.naming.sights import Sight
from services.perception.naming.text import LIKELY, Line, likeness, sure_words

SAME, PERHAPS = 0.20, 0.34
"""Differences of appearance up to which an object is the one that was taught, and up to which a person is asked whether
it is (bench.naming: one in twenty of the taught things is above the first, one in a hundred of their look-alikes
below)."""
CLEAR = 0.06
"""How much more alike the best must be than the second for that to be another object (bench.naming)."""
READ_SAME, READ_OTHER = -0.06, 0.12
"""What print adds to the difference: words that were read when it was taught, and others in place of them."""


class Match(NamedTuple):
    """`names` that the object has, and those that it may have when seen from nearer."""

    names: tuple[str, ...] = ()
    perhaps: tuple[str, ...] = ()


def unlikeness(taught: Taught, sight: Sight) -> float:
    """Difference between what was taught and what is seen: the most alike pair of looks, and the print."""
    looks = min((nearest(look, taught.looks) for look in sight.looks), default=float("inf"))
    return looks + _print_difference(taught.text, sight.lines)


def _print_difference(known: Sequence[Line], seen: Sequence[Line]) -> float:
    """READ_OTHER where each shows a word that the other has not, READ_SAME where they share words, else 0.

    That a word was not read says nothing: it may be on another side.
    """
    taught, read = sure_words(known), sure_words(seen)
    if not taught or not read:
        return 0.0
    missing = [w for w in taught if likeness([w], " ".join(read)) < LIKELY]
    others = [w for w in read if likeness([w], " ".join(taught)) < LIKELY]
    if missing and others:
        return READ_OTHER
    return READ_SAME if len(missing) < len(taught) else 0.0


def matches(names: Mapping[str, Taught], sights: Mapping[str, Sight], bound: Mapping[str, str]) -> dict[str, Match]:
    """For each object in sight, by id, what it is called. `bound`: ids of the objects that were followed since they
    were taught, by name; such a one has its name unless it has come to look otherwise."""
    sure: dict[str, list[str]] = {key: [] for key in sights}
    perhaps: dict[str, list[str]] = {key: [] for key in sights}
    for name, taught in names.items():
        unlike = {key: unlikeness(taught, sight) for key, sight in sights.items() if sight.looks}
        followed = bound.get(name)
        if followed in unlike and unlike[followed] <= PERHAPS:
            sure[followed].append(name)
            continue
        best = min(unlike.values(), default=float("inf"))
        for key, value in unlike.items():
            if value <= SAME and value <= best + CLEAR:
                sure[key].append(name)
            elif value <= PERHAPS and best > SAME:
                perhaps[key].append(name)
    return {key: Match(tuple(sure[key]), tuple(perhaps[key])) for key in sights}
