"""The names that people taught, on disk: whole at any moment, there again after a kill."""

from collections.abc import Callable, Sequence
from pathlib import Path

import msgspec
import numpy as np

from common.files.stored_file import StoredFile
from common.messages import TaughtName, Vec3
from services.perception.naming.appearance import Look
from services.perception.naming.text import Line

FILE = "taught-names.json"
MAX_NAMES = 200
"""Names that are kept. Chosen: more than a household teaches; each is compared with all that is seen."""
MAX_LOOKS = 12
"""Looks kept of an object. Chosen: six sides of it, from near and from far."""
TURNED = 0.5
"""Angle [rad] between two bearings from which they show different sides. Chosen: a box's faces are 1.57 apart."""


class Taught(msgspec.Struct):
    """One name, and what the object looks like: from several sides, in words, and what is printed on it."""

    name: str
    kind: str
    colour: str
    size: Vec3
    looks: list[Look]
    lines: list[tuple[str, float]] = []

    @property
    def message(self) -> TaughtName:
        return TaughtName(name=self.name, kind=self.kind, colour=self.colour, size=self.size, views=len(self.looks))

    @property
    def text(self) -> list[Line]:
        return [Line(*line) for line in self.lines]


class NameMemory:
    """`folder`: where the names are kept; None for this process only. `warn(why)` is told what went wrong."""

    def __init__(self, folder: Path | None, warn: Callable[[str], None]) -> None:
        self._file = StoredFile(folder / FILE if folder is not None else None, list[Taught], warn)
        self._warn = warn
        self.names: dict[str, Taught] = {t.name: t for t in self._file.load() or []}

    def teach(self, taught: Taught) -> bool:
        """Keep a name in place of one that is the same; False when the disk did not take it or there are too many."""
        if taught.name not in self.names and len(self.names) >= MAX_NAMES:
            self._warn(f"there are {MAX_NAMES} names already; forget one first")
            return False
        before = self.names.get(taught.name)
        self.names[taught.name] = taught
        if self._save():
            return True
        if before is None:
            del self.names[taught.name]
        else:
            self.names[taught.name] = before
        return False

    def forget(self, name: str) -> bool:
        """Drop a name; False when it is unknown or the disk did not take it."""
        taught = self.names.pop(name, None)
        if taught is None:
            return False
        if not self._save():
            self.names[name] = taught
            return False
        return True

    def learn(self, name: str, look: Look, lines: Sequence[Line]) -> None:
        """Keep a look at an object that is known to have the name, when it shows another side or is a nearer one."""
        taught = self.names[name]
        looks = with_look(taught.looks, look)
        kept = [(line.text, line.confidence) for line in lines]
        if looks is not taught.looks or (kept and kept != taught.lines):
            taught.looks, taught.lines = looks, kept or taught.lines
            self._save()

    def _save(self) -> bool:
        return self._file.save(list(self.names.values()))


def with_look(looks: list[Look], look: Look) -> list[Look]:
    """The looks with another one: in place of one from the same side when it is nearer, else beside them; the same list
    when it adds nothing."""
    for i, other in enumerate(looks):
        cosine = float(np.clip(np.dot(other.bearing, look.bearing), -1.0, 1.0))
        if np.arccos(cosine) < TURNED:
            if look.distance * 1.2 < other.distance and look.seen >= 0.8 * other.seen:
                return [*looks[:i], look, *looks[i + 1 :]]
            return looks
    return [*looks, look] if len(looks) < MAX_LOOKS else looks
