"""Which of the objects in sight have which taught names. Pure.

A taught name means one particular object. What is as unlike as strangers are gets no name; of several that could be the
one, the best has it if it is clearly the best, and all have it if none is, so that the robot asks which.
"""

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from services.perception.naming.appearance import nearest
from services.perception.naming.memory import Taught
from services.perception.naming.sights import Sight
from services.perception.naming.text import LIKELY, Line, likeness, parts, shown, sure_words
from services.perception.naming.vocabulary import BARE, PACKED

Evidence = Literal["same", "other", "silent"]

SAME, PERHAPS = 0.20, 0.34
"""Differences of appearance up to which an object is the one that was taught, and up to which a person is asked whether
it is. Measured on drawn packages: one in twenty of the taught things is above the first, one in a hundred of their
look-alikes below."""
CLEAR = 0.06
"""How much more alike the best must be than the second for that to be another object; measured likewise."""
READ_SAME, READ_OTHER = -0.06, 0.12
"""What print adds to the difference: words that were read when it was taught, and others in place of them."""
TURNED = 2
"""Sides from which it has to have been read before a person is asked about what shows no print. Chosen: what is on the
front of a box is seen from one."""


class Match(NamedTuple):
    """`names` that the object has, and those that it may have when seen from nearer."""

    names: tuple[str, ...] = ()
    perhaps: tuple[str, ...] = ()


def unlikeness(taught: Taught, sight: Sight) -> float:
    """Difference between what was taught and what is seen: the most alike pair of looks, and the print."""
    looks = min((nearest(look, taught.looks) for look in sight.looks), default=float("inf"))
    return looks + {"same": READ_SAME, "other": READ_OTHER, "silent": 0.0}[evidence(taught, sight)]


def evidence(taught: Taught, sight: Sight) -> Evidence:
    """What print says: `same` where they share words or parts of them, `other` where each shows a word that the other
    has not.

    That a word was not read says nothing: it may be on another side.
    """
    known, read = parts(taught.text), sure_words(sight.lines)
    missing = [w for w in known if not _shared(w, sight.lines)]
    others = [w for w in read if not _shared(w, taught.text)]
    if missing and others:
        return "other"
    return "same" if len(missing) < len(known) else "silent"


def _shared(word: str, lines: Sequence[Line]) -> bool:
    """Whether a word, or a part of it, stands in lines, or a part of it is all that was read there."""
    return any(word in token or token in word for token in parts(lines)) or likeness([word], shown(lines)) >= LIKELY


def proven(taught: Taught, sight: Sight) -> bool:
    """What is printed leaves no doubt that one that looks so is the one that was taught, where print can be read.

    What goes by its looks alone has to have been near enough to show that nothing is printed on it; a pack, of which
    the print was not seen when it was taught, does not.
    """
    if parts(taught.text):
        return evidence(taught, sight) == "same"
    return taught.kind not in PACKED and not sight.named and (taught.kind in BARE or sight.read)


def matches(
    names: Mapping[str, Taught], sights: Mapping[str, Sight], bound: Mapping[str, str], reads: bool = False
) -> dict[str, Match]:
    """For each object in sight, by id, what it is called. `bound`: ids of the objects that were followed since they
    were taught, by name; such a one has its name unless it has come to look otherwise. `reads`: print can be read, and
    decides; else looks do alone."""
    sure: dict[str, list[str]] = {key: [] for key in sights}
    perhaps: dict[str, list[str]] = {key: [] for key in sights}
    for name, taught in names.items():
        unlike = {key: unlikeness(taught, sight) for key, sight in sights.items() if sight.looks}
        followed = bound.get(name)
        if followed in unlike and unlike[followed] <= PERHAPS:
            sure[followed].append(name)
            continue
        same = {key for key, value in unlike.items() if value <= SAME and (not reads or proven(taught, sights[key]))}
        best = min((unlike[key] for key in same), default=float("inf"))
        for key, value in unlike.items():
            if key in same and value <= best + CLEAR:
                sure[key].append(name)
            elif value <= PERHAPS and not same:
                perhaps[key].append(name)
    return {key: Match(tuple(sure[key]), tuple(perhaps[key])) for key in sights}
