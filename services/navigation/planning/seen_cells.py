"""Grid of what the lidar has seen beyond the static map: when, for how long, and whether it is a person."""

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, Mask
from services.navigation.planning.changes import Cells

_NEW = 3.0
"""Time [s] since the first sight of a cell within which who is around it is what is in it; chosen: longer than it takes
to tell that somebody walks. What was there before them is no part of them."""
SETTLED = 60.0
"""Time [s] for which something has to have stood to be no person whom nobody has seen walk; chosen: few stand in a way
for longer, and waiting costs a robot that has no other way little."""
STANDS, STIRS = 300.0, 3.0
"""Time [s] for which a cell counts as a person when somebody who has walked was there, and when something moved there,
which may have seemed so only; chosen: nobody stands for five minutes without moving a foot, and beside a thing a person
is not told from it."""
_LASTING, _BRIEF = 2.0, 4.0
"""Something seen for longer than the first stands there, anything else is forgotten after the second [s]."""


class SeenCells:
    """Times of sight for each cell of a grid of `shape`; `memory` [s]: how long a standing thing out of sight is kept.

    Who is a person is forgotten as soon as what was seen for a moment only: people walk on.
    """

    def __init__(self, shape: tuple[int, int], memory: float) -> None:
        self._memory = memory
        self._at: Array = np.full(shape, -np.inf)
        self._first: Array = np.full(shape, np.inf)
        self._person_until: Array = np.full(shape, -np.inf)

    @property
    def known(self) -> Mask:
        """Cells (rows, columns) where something is."""
        found: Mask = self._at > -np.inf
        return found

    @property
    def things(self) -> Mask:
        """Cells (rows, columns) with something that was no person when it was seen last."""
        return self.known & (self._person_until < self._at)

    def stood(self, now: float) -> Mask:
        """Cells (rows, columns) with a thing that was there before the people who are around now."""
        return self.things & (self._first < now - _NEW)

    def settled(self, now: float) -> Mask:
        """Cells (rows, columns) with something that has stood there for too long to be a person."""
        return self.things & (self._first < now - SETTLED)

    @property
    def empty(self) -> bool:
        """True when no cell has anything in it."""
        return not self.known.any()

    def cells(self) -> Cells:
        """Rows and columns (n,) of the cells where something is."""
        rows, columns = np.nonzero(self.known)
        return rows, columns

    def mark(self, cells: Cells, now: float) -> None:
        """Note that something is seen in these cells."""
        self._at[cells], self._first[cells] = now, np.minimum(self._first[cells], now)

    def mark_people(self, cells: Cells, seconds: float, now: float) -> None:
        """Take what came into these cells lately for a person, for so many seconds if it stays."""
        until = self._person_until[cells]
        new = (now - self._first[cells] < _NEW) | (until >= now)
        self._person_until[cells] = np.where(new, np.maximum(until, now + seconds), until)

    def keep(self, cells: Cells | Mask, now: float) -> None:
        """Take what is in these cells for something that has always been there and was seen at `now`."""
        self._at[cells], self._first[cells] = np.maximum(self._at[cells], now), -np.inf

    def outdated(self, cells: Cells, now: float) -> NDArray[np.bool_]:
        """Which of the cells (n,) were seen so long ago that they are forgotten."""
        at = self._at[cells]
        stands = (at - self._first[cells] > _LASTING) & (self._person_until[cells] < at)
        found: NDArray[np.bool_] = now - at > np.where(stands, self._memory, min(_BRIEF, self._memory))
        return found

    def unseen_for(self, cells: Cells, age: float, now: float) -> NDArray[np.bool_]:
        """Which of the cells (n,) have been out of sight for `age` seconds."""
        found: NDArray[np.bool_] = now - self._at[cells] > age
        return found

    def drop(self, cells: Cells | Mask) -> None:
        """Empty these cells."""
        self._at[cells], self._first[cells], self._person_until[cells] = -np.inf, np.inf, -np.inf
