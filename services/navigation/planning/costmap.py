"""Costmap: the floor plan's static map, what the lidar sees beyond it, and the clearance from both."""

import math
import zlib

import numpy as np
from scipy import ndimage

from common import messages as m
from common.cells import unpacked
from common.floor_grid import Cells, static_distances
from common.floor_plan import FloorPlan
from common.geometry import Array, Mask
from services.navigation.planning.obstacle_layer import Discs, ObstacleLayer

_EXPLAINED = 0.12
"""Distance from the static map within which it explains a lidar point [m]: two cells and the lidar's noise."""
_REACH = 0.8
"""Distance from something seen up to which clearance counts it [m]: beyond `navigation.inflation`."""
_FAR = 1.0
"""Clearance [m] beyond which viewers see no difference."""


class Costmap(Cells):
    """Obstacles on the floor: `static_distance` [m] is from each cell to the nearest one of the static map, `obstacles`
    what was seen besides. `memory`, `lasting_after` [s]: see `ObstacleLayer`."""

    def __init__(
        self, floor_plan: FloorPlan, resolution: float, memory: float, lasting_after: float = math.inf
    ) -> None:
        super().__init__(floor_plan, resolution)
        self.obstacles = ObstacleLayer(Cells(floor_plan, resolution), memory, lasting_after)
        self._discs: dict[str, Discs] = {}
        self._version = 0
        self._distance: tuple[int, Array] | None = None
        self.people_pass = False
        self._fix(static_distances(self, floor_plan))
        reach = math.ceil(_REACH / resolution)
        offsets = np.arange(-reach, reach + 1) * resolution
        self._disc: Array = np.hypot(offsets, offsets[:, None])
        self._disc_reach = reach

    @property
    def version(self) -> int:
        """A number that grows with every change."""
        return self._version + self.obstacles.version

    # --- the static map
    def _fix(self, distance: Array) -> None:
        self.static_distance = distance
        self.obstacles.explain(distance <= _EXPLAINED)

    def replace(self, grid: m.MapGrid) -> None:
        """Replace the static map by the occupied and unknown cells of `grid`, whose resolution is this map's.

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
        distance = np.zeros(self.shape)
        distance[inside] = around * self.resolution
        self._fix(distance)
        self._version += 1

    def confine(self, distance: Array) -> None:
        """Take `distance` [m] to the nearest obstacle of every cell in place of the floor plan's."""
        self._fix(distance)
        self.obstacles.forget()

    def explains(self, points: Array, limit: float) -> Mask:
        """Which points (n, 2) lie within `limit` [m] of the static map."""
        found: Mask = self.static_distance[self.cells(points[:, 0], points[:, 1])] <= limit
        return found

    # --- all that stands there
    def place(self, discs: Discs, of: str) -> None:
        """Mark circles as occupied, in place of those that were given for the same source `of` before."""
        old = self._discs.get(of, [])
        if len(discs) == len(old) and all(math.dist(a, b) < self.resolution for a, b in zip(discs, old, strict=True)):
            return
        self._discs[of] = list(discs)
        self._version += 1

    def let_people_pass(self, passing: bool) -> None:
        """Choose whether paths lead through people, who walk on, or round them; the lidar's brake is for them all."""
        if passing != self.people_pass:
            self.people_pass = passing
            self._version += 1

    @property
    def distance(self) -> Array:
        """Distance (rows, columns) [m] to the nearest obstacle, static or seen; computed when it is asked for."""
        if self._distance is None or self._distance[0] != self.version:
            seen = self.obstacles.things if self.people_pass else self.obstacles.known
            self._distance = self.version, self._distances(seen)
        return self._distance[1]

    def distance_to_things(self, now: float = math.inf) -> Array:
        """Distance [m] of each cell as if nobody stood anywhere.

        By `now` [s] also without who may not have been seen to walk yet.
        """
        return self._distances(self.obstacles.settled(now))

    def _distances(self, seen: Mask) -> Array:
        """To the nearest of the static map, the circles placed and the cells `seen` [m], by a disc around each cell."""
        discs = [disc for of in self._discs.values() for disc in of]
        if not discs and not seen.any():
            return self.static_distance
        grid = self.static_distance.copy()
        if discs:
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

    def clearance(self, x: float, y: float) -> float:
        """Distance [m] from a point to the nearest obstacle."""
        return float(self.distance[self.cell(x, y)])

    def line_clearance(self, a: tuple[float, float], b: tuple[float, float], distance: Array | None = None) -> float:
        """The least clearance on the straight line between two points, or of that `distance` [m] of each cell."""
        count = max(2, math.ceil(math.hypot(b[0] - a[0], b[1] - a[1]) / self.resolution) + 1)
        share = np.arange(count) / (count - 1)
        xs, ys = a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share
        return float((self.distance if distance is None else distance)[self.cells(xs, ys)].min())

    def seen_within(self, points: Array, radius: float) -> Mask:
        """Which points (n, 2) have something within `radius` that the static map does not put there."""
        cells = self.cells(points[:, 0], points[:, 1])
        near = self.distance[cells]
        found: Mask = (near < radius) & (near < self.static_distance[cells])
        return found

    def picture(self, now: float) -> m.Costmap:
        """The clearance of every cell, for viewers."""
        cells = np.minimum(self.distance * (255 / _FAR), 255).astype(np.uint8)
        height, width = self.shape
        return m.Costmap(
            t=now, x=self.origin[0], y=self.origin[1], resolution=self.resolution, width=width, height=height,
            far=_FAR, cells=zlib.compress(cells.tobytes(), 1),
        )  # fmt: skip
