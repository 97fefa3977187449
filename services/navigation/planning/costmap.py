"""Costmap: the floor plan's static map, what the lidar sees beyond it, and the clearance from both."""

import math
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common import messages as m
from common.cells import unpacked
from common.floor_grid import Cells, static_distances
from common.floor_plan import FloorPlan
from common.geometry import Array, Pose2
from services.navigation.planning.changes import Changes
from services.navigation.planning.changes import Mask as Grid
from services.navigation.planning.seen_cells import STANDS, STIRS, SeenCells

Discs = Sequence[tuple[float, float, float]]
"""Circles (x, y, radius) [map, m]."""
_EXPLAINED = 0.12
"""Distance from the static map within which it explains a lidar point [m]: two cells and the lidar's noise."""
_REACH = 0.8
"""Distance from something seen up to which clearance counts it [m]: beyond `navigation.inflation`."""
_BEHIND = 0.15
"""How far beyond a cell a ray must reach to clear it [m]: three cells."""
_FAR = 1.0
"""Clearance [m] beyond which viewers see no difference."""


class Costmap(Cells):
    """What stands where; `static_distance` [m] is from each cell to the nearest obstacle of the static map.

    `memory` [s]: how long what is out of sight is remembered; `lasting_after` [s]: see `Changes`. `doubted`: robot time
    [s] up to which what was seen last then may be gone.
    """

    def __init__(
        self, floor_plan: FloorPlan, resolution: float, memory: float, lasting_after: float = math.inf
    ) -> None:
        super().__init__(floor_plan, resolution)
        self.memory = memory
        self.static_distance = static_distances(self, floor_plan)
        self.static: Grid = self.static_distance <= 0
        self._seen = SeenCells(self.shape, memory)
        self.changes = Changes(self.shape, lasting_after)
        self._distance: Array | None = self.static_distance
        self._discs: dict[str, list[tuple[float, float, float]]] = {}
        self.version = 0
        self.people_pass = False
        self.doubted = -math.inf
        reach = math.ceil(_REACH / resolution)
        offsets = np.arange(-reach, reach + 1) * resolution
        self._disc: Array = np.hypot(offsets, offsets[:, None])
        self._disc_reach = reach

    def replace(self, grid: m.MapGrid) -> None:
        """Another static map: what is occupied or unknown in `grid`, whose cells have this map's resolution.

        Raises:
            ValueError: another resolution, or cells that do not have the grid's size.
        """
        if abs(grid.resolution - self.resolution) > 1e-9:
            raise ValueError(f"cells of {grid.resolution} m, not {self.resolution} m")
        cells = unpacked(grid)
        row, column = (
            round((v - o) / self.resolution) for v, o in ((grid.y, self.origin[1]), (grid.x, self.origin[0]))
        )
        top, left = max(0, row), max(0, column)
        part = cells[top - row :, left - column :] != 0
        part = part[: self.shape[0] - top, : self.shape[1] - left]
        inside = slice(top, top + part.shape[0]), slice(left, left + part.shape[1])
        # All around it is unknown. To the middles of taken cells: a wall is somewhere in those that it touches.
        around = ndimage.distance_transform_edt(~np.pad(part, 1, constant_values=True))[1:-1, 1:-1]
        self.static_distance = np.zeros(self.shape)
        self.static_distance[inside] = around * self.resolution
        self.static = self.static_distance <= 0
        self._seen.drop(self.static_distance <= _EXPLAINED)
        self._distance = None
        self.version += 1

    def explains(self, points: Array, limit: float) -> Grid:
        """Which points (n, 2) lie within `limit` [m] of the static map."""
        found: Grid = self.static_distance[self.cells(points[:, 0], points[:, 1])] <= limit
        return found

    @property
    def distance(self) -> Array:
        """To the nearest obstacle, static or seen [m]; made when asked for."""
        if self._distance is None:
            self._distance = self._distances(self._seen.things if self.people_pass else self._seen.known)
        return self._distance

    def let_people_pass(self, passing: bool) -> None:
        """Whether paths lead through people, who walk on, or round them; the lidar's brake is for all of them."""
        if passing != self.people_pass:
            self.people_pass = passing
            self._distance = None
            self.version += 1

    def distance_but_for_people(self) -> Array:
        """The same as if nobody stood anywhere."""
        return self._distances(self._seen.things)

    def distance_to_things(self, now: float) -> Array:
        """The same without what may be somebody whom nobody has seen walk."""
        return self._distances(self._seen.settled(now))

    def _distances(self, seen: Grid) -> Array:
        """To the nearest of the static map, the circles placed and the cells `seen` [m], by a disc around each cell."""
        grid = self.static_distance.copy()
        if discs := [disc for of in self._discs.values() for disc in of]:
            gx, gy = np.moveaxis(self.centres(), 2, 0)
            for x, y, radius in discs:
                np.minimum(grid, np.maximum(np.hypot(gx - x, gy - y) - radius, 0.0), out=grid)
        n, disc = self._disc_reach, self._disc
        for row, column in zip(*(axis.tolist() for axis in np.nonzero(seen)), strict=True):
            top, left = max(0, row - n), max(0, column - n)
            part = grid[top : row + n + 1, left : column + n + 1]
            shift, aside = top - (row - n), left - (column - n)
            np.minimum(part, disc[shift : shift + part.shape[0], aside : aside + part.shape[1]], out=part)
        return grid

    def disown(self, discs: Discs) -> None:
        """Forget what was seen in circles: it was a robot."""
        cells = self._within(discs)
        if len(cells[0]):
            self._seen.drop(cells)
            self._distance = None
            self.version += 1

    def _within(self, discs: Discs) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Rows and columns of the cells in circles in which something was seen."""
        rows, columns = self._seen.cells()
        if not len(rows) or not discs:
            return rows[:0], columns[:0]
        inside = _inside(*self.middles(rows, columns), discs)
        return rows[inside], columns[inside]

    def place(self, discs: Discs, of: str) -> None:
        """Circles that are occupied besides, until other ones `of` this are told."""
        old = self._discs.get(of, [])
        if len(discs) == len(old) and all(math.dist(a, b) < self.resolution for a, b in zip(discs, old, strict=True)):
            return
        self._discs[of] = list(discs)
        self._distance = None
        self.version += 1

    def confine(self, distance: Array) -> None:
        """Take `distance` [m] to the nearest obstacle of every cell in place of the floor plan's."""
        self.static_distance = distance
        self.static = distance <= 0
        self.forget()

    def forget(self) -> None:
        """Forget all that was seen of late: it was not where it seemed to be."""
        self._seen.drop(self._seen.known)
        self.changes.forget_brief()
        self._distance = None if self._discs else self.static_distance
        self.version += 1
        self.remember(0.0)

    def remember(self, now: float) -> None:
        """Take the lasting changes for seen at robot time `now` [s]."""
        kept = self.changes.lasting
        if kept.any():
            self._seen.keep(kept, now)
            self._distance = None
            self.version += 1

    def picture(self, now: float) -> m.Costmap:
        """The clearance of every cell, for viewers."""
        cells = np.minimum(self.distance * (255 / _FAR), 255).astype(np.uint8)
        height, width = self.shape
        return m.Costmap(
            t=now, x=self.origin[0], y=self.origin[1], resolution=self.resolution, width=width, height=height,
            far=_FAR, cells=zlib.compress(cells.tobytes(), 1),
        )  # fmt: skip

    def clearance(self, x: float, y: float) -> float:
        """Distance [m] from a point to the nearest obstacle."""
        return float(self.distance[self.cell(x, y)])

    def line_clearance(self, a: tuple[float, float], b: tuple[float, float], distance: Array | None = None) -> float:
        """The least clearance on the straight line between two points, or of that `distance` [m] of each cell."""
        count = max(2, math.ceil(math.hypot(b[0] - a[0], b[1] - a[1]) / self.resolution) + 1)
        share = np.arange(count) / (count - 1)
        xs, ys = a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share
        return float((self.distance if distance is None else distance)[self.cells(xs, ys)].min())

    # --- lidar
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
        hit = (ranges <= range_max) & (ranges > 0.0)
        directions = angles[hit] + pose[2]
        xs, ys = pose[0] + ranges[hit] * np.cos(directions), pose[1] + ranges[hit] * np.sin(directions)
        columns = ((xs - self.origin[0]) / self.resolution).astype(int)
        rows = ((ys - self.origin[1]) / self.resolution).astype(int)
        inside = (rows >= 0) & (rows < self.shape[0]) & (columns >= 0) & (columns < self.shape[1])
        rows, columns = rows[inside], columns[inside]
        new = self.static_distance[rows, columns] > _EXPLAINED
        before = self._seen.known
        if not new.any() and not before.any() and not self.changes.known.any():
            return
        self._clear(pose, angles, np.minimum(ranges, range_max), now)
        rows, columns = rows[new], columns[new]
        self._seen.mark((rows, columns), now)
        self._seen.mark_people(self._within(moving), STIRS, now)
        self._seen.mark_people(self._within(people), STANDS, now)
        person = _inside(xs[inside][new], ys[inside][new], [*people, *moving])
        self.changes.occupied((rows[~person], columns[~person]), now)
        after = self._seen.known
        if (after != before).any():
            self._distance = None if after.any() or self._discs else self.static_distance
            self.version += 1

    def _clear(self, pose: Pose2, angles: Array, reach: Array, now: float) -> None:
        rows, columns = np.nonzero(self._seen.known | self.changes.known)
        if not len(rows):
            return
        x, y = (middle - at for middle, at in zip(self.middles(rows, columns), pose, strict=False))
        step = angles[1] - angles[0]
        bearing = np.arctan2(y, x) - pose[2] - angles[0]
        ray = np.round(np.mod(bearing, 2 * math.pi) / step).astype(int) % len(angles)
        passed = reach[ray] > np.hypot(x, y) + _BEHIND
        old = self._seen.outdated((rows, columns), now) & ~self.changes.lasting[rows, columns]
        self.changes.passed((rows[passed], columns[passed]))
        gone = passed | old
        self._seen.drop((rows[gone], columns[gone]))

    def doubt(self, now: float, age: float) -> None:
        """Forget what has been out of sight for `age` seconds: it may be gone."""
        self.doubted = now - age
        rows, columns = self._seen.cells()
        gone = self._seen.unseen_for((rows, columns), age, now)
        if gone.any():
            self._seen.drop((rows[gone], columns[gone]))
            self._distance = None
            self.version += 1

    def seen_in(self, disc: tuple[float, float, float]) -> bool:
        """Something was seen in a circle that the static map does not put there."""
        return bool(len(self._within([disc])[0]))

    def seen_within(self, points: Array, radius: float) -> Grid:
        """Which points (n, 2) have something within `radius` that the static map does not put there."""
        cells = self.cells(points[:, 0], points[:, 1])
        near = self.distance[cells]
        found: Grid = (near < radius) & (near < self.static_distance[cells])
        return found

    def lasting_at(self, points: Array) -> Grid:
        """Which points (n, 2) are where something stands that became a part of the map; to a cell."""
        if not self.changes.lasting.any():
            return np.zeros(len(points), bool)
        rows, columns = self.cells(points[:, 0], points[:, 1])
        found: Grid = ndimage.binary_dilation(self.changes.lasting, np.ones((3, 3)))[rows, columns]
        return found

    def stood_at(self, points: Array, now: float) -> Grid:
        """Which points (n, 2) are where something stands that was no person when it came; to a cell."""
        rows, columns = self.cells(points[:, 0], points[:, 1])
        found: Grid = ndimage.binary_dilation(self._seen.stood(now), np.ones((3, 3)))[rows, columns]
        return found

    @property
    def sees_unmapped(self) -> bool:
        """True while something is there that the static map does not have."""
        return not self._seen.empty


def _inside(xs: Array, ys: Array, discs: Discs) -> Grid:
    """Which points (n,) lie in one of the circles."""
    found = np.zeros(len(xs), bool)
    for x, y, radius in discs:
        found |= np.hypot(xs - x, ys - y) < radius
    return found
