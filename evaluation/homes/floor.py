"""The free floor of a home that is being furnished, and where the robot can get on it. Pure."""

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.approach import EDGE_DISTANCE, ROOM
from common.floor_plan import FloorPlan, Room, Vec2, Wall
from common.geometry import Mask, Rectangle

CELL = 0.05
"""Side of a cell [m], that of navigation's grid."""
PASSAGE = ROOM + 0.05
"""Clearance [m] of the base's centre on a way that counts as free: navigation's and one cell."""
SIDES = ((0, -1), (1, 0), (-1, 0), (0, 1))
"""Unit steps (x, y) from an area's middle to before each of its sides."""


class Floor:
    """A grid between the corners `low` and `high` [m] whose cells are taken by walls and furniture or kept free."""

    def __init__(self, low: Vec2, high: Vec2, walls: Iterable[Wall]) -> None:
        rows, columns = math.ceil((high[1] - low[1]) / CELL), math.ceil((high[0] - low[0]) / CELL)
        y, x = np.mgrid[:rows, :columns]
        self._low = low
        self._x, self._y = low[0] + (x + 0.5) * CELL, low[1] + (y + 0.5) * CELL
        self._taken: Mask = np.zeros((rows, columns), bool)
        self._kept: Mask = self._taken.copy()
        for wall in walls:
            self._taken |= self._inside(wall.footprint)

    @classmethod
    def of(cls, home: FloorPlan) -> "Floor":
        """The floor of a home with what stands there."""
        floor = cls(home.low, home.high, home.walls)
        for outline in home.footprints:
            floor.take(outline)
        return floor

    def _inside(self, area: Rectangle) -> Mask:
        u, v = area.to_local(self._x, self._y)
        found: Mask = (np.abs(u) <= area.length / 2) & (np.abs(v) <= area.width / 2)
        return found

    def keep(self, area: Rectangle) -> None:
        """Keep this area free of furniture."""
        self._kept |= self._inside(area)

    def fits(self, area: Rectangle, room: Room, margin: float) -> bool:
        """True when the area lies in the room and is free, as is `margin` [m] around it but for walls at its back."""
        if not all(room.low[k] < c[k] < room.high[k] for c in area.corners for k in (0, 1)):
            return False
        wide = area._replace(length=area.length + 2 * margin)
        return not bool(((self._taken | self._kept) & self._inside(wide)).any())

    def take(self, area: Rectangle) -> None:
        """Mark the area as occupied."""
        self._taken |= self._inside(area)

    def copy(self) -> "Floor":
        """A copy of the floor, to try something on."""
        other = object.__new__(Floor)
        other.__dict__ = self.__dict__ | {"_taken": self._taken.copy(), "_kept": self._kept.copy()}
        return other

    def reached(self, start: Vec2) -> Mask:
        """Mask of the cells that the base's centre can reach from `start`."""
        labels, _ = ndimage.label(self.clearance() >= PASSAGE)
        mine = labels[self.cell(start)]
        return np.asarray(labels == mine) if mine else np.zeros_like(self._taken)

    def clearance(self) -> NDArray[np.float64]:
        """Distance [m] of each cell to what is taken or outside."""
        return np.asarray(ndimage.distance_transform_edt(np.pad(~self._taken, 1))[1:-1, 1:-1] * CELL)

    def cell(self, point: Vec2) -> tuple[int, int]:
        """Row and column of a point, clipped to the grid."""
        rows, columns = self._taken.shape
        return (
            int(np.clip((point[1] - self._low[1]) / CELL, 0, rows - 1)),
            int(np.clip((point[0] - self._low[0]) / CELL, 0, columns - 1)),
        )

    def roomiest(self, room: Room, within: Mask) -> Vec2 | None:
        """The point of a room farthest from everything, among the cells `within`; None when there is none."""
        inside = within & (self._x > room.low[0]) & (self._x < room.high[0])
        inside &= (self._y > room.low[1]) & (self._y < room.high[1])
        if not inside.any():
            return None
        where = np.unravel_index(int(np.argmax(np.where(inside, self.clearance(), -1.0))), inside.shape)
        return float(self._x[where]), float(self._y[where])

    def beyond(self, distance: float) -> Mask:
        """Mask of the cells farther than `distance` [m] from the robot's start."""
        found: Mask = np.hypot(self._x, self._y) > distance
        return found

    def somewhere(self, rng: np.random.Generator, within: Mask) -> Vec2:
        """A random point of the cells `within`."""
        rows, columns = np.nonzero(within)
        n = int(rng.integers(len(rows)))
        return float(self._x[rows[n], columns[n]]), float(self._y[rows[n], columns[n]])

    def approaches(self, area: Rectangle, within: Mask) -> list[Vec2]:
        """Directions in the area's own frame from whose edge the base reaches it from cells `within`."""
        found = []
        for i, j in SIDES:
            off = (area.length if i else area.width) / 2 + EDGE_DISTANCE + CELL
            along = (area.width if i else area.length) / 2
            # At the middle of the edge and half-way to its ends.
            shifts = (0.0, 0.5 * along, -0.5 * along)
            points = [area.to_map(i * off + abs(j) * s, j * off + abs(i) * s) for s in shifts]
            if all(within[self.cell(p)] for p in points):
                found.append((float(i), float(j)))
        return found
