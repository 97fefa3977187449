"""Obstacle layer: what the lidar has seen that the static map does not explain, and how it is forgotten again."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.floor_grid import Cells
from common.geometry import Array, Mask, Point, Pose2
from services.navigation.planning.changes import Changes
from services.navigation.planning.seen_cells import STANDS, STIRS, SeenCells

Disc = tuple[float, float, float]
"""A circle (x, y, radius) [map, m]."""
Discs = Sequence[Disc]
_BEHIND = 0.15
"""How far beyond a cell a ray must reach to clear it [m]: three cells."""


class ObstacleLayer:
    """Cells in which the lidar sees something; `explained` (rows, columns): those that the static map explains.

    `memory` [s]: how long what is out of sight is remembered; `lasting_after` [s]: see `Changes`. `version` grows with
    every change. `doubted`: robot time [s] up to which what was seen last then may be gone, `doubted_at`: where the
    robot was then [map].
    """

    def __init__(self, cells: Cells, memory: float, lasting_after: float = math.inf) -> None:
        self._cells, self.memory = cells, memory
        self._seen = SeenCells(cells.shape, memory)
        self.changes = Changes(cells.shape, lasting_after)
        self.explained: Mask = np.zeros(cells.shape, bool)
        self.version = 0
        self.doubted, self.doubted_at = -math.inf, (math.inf, math.inf)

    # --- what is there
    @property
    def known(self) -> Mask:
        """Cells (rows, columns) where something is."""
        return self._seen.known

    @property
    def things(self) -> Mask:
        """Cells (rows, columns) with something that was no person when it was seen last."""
        return self._seen.things

    def settled(self, now: float) -> Mask:
        """Cells (rows, columns) with something that has stood there for too long to be a person."""
        return self._seen.settled(now)

    @property
    def empty(self) -> bool:
        """True when nothing is known beyond the static map."""
        return self._seen.empty

    def lasting_at(self, points: Array) -> Mask:
        """Which points (n, 2) are where something stands that became a part of the map; to a cell."""
        return self._at(self.changes.lasting, points)

    def stood_at(self, points: Array, now: float) -> Mask:
        """Which points (n, 2) are where something stands that was no person when it came; to a cell."""
        return self._at(self._seen.stood(now), points)

    def _at(self, grid: Mask, points: Array) -> Mask:
        if not grid.any():
            return np.zeros(len(points), bool)
        rows, columns = self._cells.cells(points[:, 0], points[:, 1])
        found: Mask = ndimage.binary_dilation(grid, np.ones((3, 3)))[rows, columns]
        return found

    def seen_in(self, disc: Disc) -> bool:
        """True when something is known within the circle."""
        return bool(len(self._within([disc])[0]))

    def _within(self, discs: Discs) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Rows and columns of the occupied cells within the circles."""
        rows, columns = self._seen.cells()
        if not len(rows) or not discs:
            return rows[:0], columns[:0]
        within = in_discs(*self._cells.middles(rows, columns), discs)
        return rows[within], columns[within]

    # --- what a scan shows
    def see(
        self,
        pose: Pose2,
        angles: Array,
        ranges: Array,
        range_max: float,
        now: float,
        people: Discs = (),
        moving: Discs = (),
    ) -> None:
        """Mark what the static map does not explain, clear what the rays passed through, forget what is old.

        A range of 0 is a ray that the robot's own body holds up: it tells nothing of what is behind. `people`, who have
        walked, and what is `moving` never become a part of the map, however long they stand.
        """
        cells, hit = self._cells, (ranges <= range_max) & (ranges > 0.0)
        directions = angles[hit] + pose[2]
        xs, ys = pose[0] + ranges[hit] * np.cos(directions), pose[1] + ranges[hit] * np.sin(directions)
        columns = ((xs - cells.origin[0]) / cells.resolution).astype(int)
        rows = ((ys - cells.origin[1]) / cells.resolution).astype(int)
        inside = (rows >= 0) & (rows < cells.shape[0]) & (columns >= 0) & (columns < cells.shape[1])
        rows, columns = rows[inside], columns[inside]
        new = ~self.explained[rows, columns]
        before = self._seen.known
        if not new.any() and not before.any() and not self.changes.known.any():
            return
        self._clear(pose, angles, np.minimum(ranges, range_max), now)
        rows, columns = rows[new], columns[new]
        self._seen.mark((rows, columns), now)
        self._seen.mark_people(self._within(moving), STIRS, now)
        self._seen.mark_people(self._within(people), STANDS, now)
        person = in_discs(xs[inside][new], ys[inside][new], [*people, *moving])
        self.changes.occupied((rows[~person], columns[~person]), now)
        if (self._seen.known != before).any():
            self.version += 1

    def _clear(self, pose: Pose2, angles: Array, reach: Array, now: float) -> None:
        rows, columns = np.nonzero(self._seen.known | self.changes.known)
        if not len(rows):
            return
        x, y = (middle - at for middle, at in zip(self._cells.middles(rows, columns), pose, strict=False))
        step = angles[1] - angles[0]
        bearing = np.arctan2(y, x) - pose[2] - angles[0]
        ray = np.round(np.mod(bearing, 2 * math.pi) / step).astype(int) % len(angles)
        passed = reach[ray] > np.hypot(x, y) + _BEHIND
        old = self._seen.outdated((rows, columns), now) & ~self.changes.lasting[rows, columns]
        self.changes.passed((rows[passed], columns[passed]))
        gone = passed | old
        self._seen.drop((rows[gone], columns[gone]))

    # --- what is forgotten, and what is not
    def doubt(self, now: float, age: float, here: Point) -> None:
        """Forget what has been out of sight for `age` seconds or longer, as it may be gone; the robot is `here`."""
        self.doubted, self.doubted_at = now - age, here
        rows, columns = self._seen.cells()
        gone = self._seen.unseen_for((rows, columns), age, now)
        if gone.any():
            self._seen.drop((rows[gone], columns[gone]))
            self.version += 1

    def disown(self, discs: Discs) -> None:
        """Forget what was seen within the circles, as where another robot turns out to be."""
        cells = self._within(discs)
        if len(cells[0]):
            self._seen.drop(cells)
            self.version += 1

    def explain(self, explained: Mask) -> None:
        """Replace the cells (rows, columns) that the static map explains."""
        self.explained = explained
        self._seen.drop(explained)

    def forget(self) -> None:
        """Forget all but the lasting changes: the pose from which it was seen was wrong."""
        self._seen.drop(self._seen.known)
        self.changes.forget_brief()
        self.version += 1
        self.remember(0.0)

    def remember(self, now: float) -> None:
        """Enter the lasting changes as seen at robot time `now` [s]."""
        kept = self.changes.lasting
        if kept.any():
            self._seen.keep(kept, now)
            self.version += 1


def in_discs(xs: Array, ys: Array, discs: Discs) -> Mask:
    """Which points (n,) lie in one of the circles."""
    found = np.zeros(len(xs), bool)
    for x, y, radius in discs:
        found |= np.hypot(xs - x, ys - y) < radius
    return found
