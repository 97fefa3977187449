"""What has changed since the map was made and lasts: boxes that stay, chairs that were moved, doors that are shut.

A cell where something was seen at times far apart, and was never seen through in between, is part of the map from then
on, until a ray passes through it. It is kept on disk, for this map only.
"""

import zlib
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from common.files.stored_file import StoredFile
from common.floor_plan import FloorPlan

Cells = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Rows and columns."""
SAVE_PERIOD = 30.0
"""Least time between two writes [s]; chosen: what changes in that time is seen again."""


class Saved(msgspec.Struct):
    """The file. `plan` is the fingerprint of the map that the cells were added to."""

    plan: str
    cells: list[tuple[int, int]]


class Changes:
    """Changes in a grid of `shape`; `lasting` (rows, columns): where something stands that the map does not have.

    `after` [s]: how far apart two sightings are at least.
    """

    def __init__(self, shape: tuple[int, int], after: float) -> None:
        self._after = after
        self._first = np.full(shape, np.inf)
        self.lasting: NDArray[np.bool_] = np.zeros(shape, bool)

    @property
    def known(self) -> NDArray[np.bool_]:
        """Cells (rows, columns) in which something was seen, and through which no ray has passed since."""
        return (self._first < np.inf) | self.lasting

    def occupied(self, cells: Cells, now: float) -> None:
        """Note that something is seen in these cells."""
        self._first[cells] = np.minimum(self._first[cells], now)
        self.lasting[cells] |= now - self._first[cells] >= self._after

    def passed(self, cells: Cells) -> None:
        """Note that rays have passed through these cells."""
        self._first[cells], self.lasting[cells] = np.inf, False

    def forget_brief(self) -> None:
        """Forget what is not lasting: the pose from which it was seen was wrong."""
        self._first[:] = np.inf


class ChangesFile:
    """Saves the lasting changes of a map in a directory (None: nowhere); `warn` is told why that failed."""

    def __init__(self, directory: Path | None, plan: FloorPlan, warn: Callable[[str], None]) -> None:
        self._plan = fingerprint(plan)
        path = directory / f"map-changes-{self._plan}.json" if directory is not None else None
        self._file = StoredFile(path, Saved, warn)
        self._saved: NDArray[np.bool_] | None = None
        self._next = 0.0

    def load(self, changes: Changes) -> int:
        """Enter the saved changes in `changes`; returns the number of cells."""
        saved = self._file.load()
        rows, columns = changes.lasting.shape
        cells = [(r, c) for r, c in saved.cells if 0 <= r < rows and 0 <= c < columns] if saved is not None else []
        if saved is not None and saved.plan == self._plan and cells:
            changes.lasting[tuple(np.array(cells).T)] = True
        self._saved = changes.lasting.copy()
        return len(cells)

    def save(self, changes: Changes, now: float) -> None:
        """Write the changes, when there are new ones and the last time is long enough ago."""
        if self._saved is None:
            self._saved = np.zeros_like(changes.lasting)
        if now < self._next or (self._saved == changes.lasting).all():
            return
        self._next = now + SAVE_PERIOD
        cells = [(int(r), int(c)) for r, c in zip(*np.nonzero(changes.lasting), strict=True)]
        if self._file.save(Saved(plan=self._plan, cells=cells)):
            self._saved = changes.lasting.copy()


def fingerprint(plan: FloorPlan) -> str:
    """A hash that identifies a map."""
    return f"{zlib.crc32(msgspec.json.encode(_shape(plan))):08x}"


def _shape(plan: FloorPlan) -> list[object]:
    """What makes a map another map: not how things in it are called."""
    boxes = [box.outline for box in plan.standing] + [(r.outline, r.center[2], r.depth) for r in plan.receptacles]
    return [plan.low, plan.high, [wall.footprint for wall in plan.walls], boxes]
