"""The sides of a surface before which the robot can stand, computed from the floor that it can reach. Pure."""

import math
from collections.abc import Callable
from typing import TypeVar

import msgspec
import numpy as np
from scipy import ndimage

from common.approach import BIN_RIM, EDGE_DISTANCE, FOOTPRINT, LATERAL, ROOM
from common.floor_grid import Cells, static_distances
from common.floor_plan import FloorPlan, Vec2
from common.geometry import SIDES, Array, Mask, Rectangle

P = TypeVar("P", bound=FloorPlan)
CELL = 0.05
"""Side [m] of the cells: a navigation's."""
INSET, BESIDE = 0.10, 0.10
"""Distance [m] from the ends of a side within which nothing need be reached, and steps between the spots before it."""
BACK = (0.02, 0.08)
"""Steps back [m] from the least distance to an edge at which it may be reached: the cell at the edge is not free."""


def reached(distance: Array, resolution: float, start: tuple[int, int] | None = None) -> Mask:
    """Cells at which the robot can be, from each cell's `distance` [m] to the nearest obstacle: those of the piece of
    floor nearest to the cell `start`, without it of the largest. The way there may be as narrow as the robot."""
    passed = distance >= FOOTPRINT - resolution / 2
    labels, count = ndimage.label(passed, np.ones((3, 3)))
    if not count:
        return passed
    if start is None:
        piece = 1 + int(np.argmax(np.bincount(labels.ravel())[1:]))
    else:
        rows, columns = np.nonzero(passed)
        nearest = int(np.argmin(np.hypot(rows - start[0], columns - start[1])))
        piece = int(labels[rows[nearest], columns[nearest]])
    found: Mask = (labels == piece) & (distance >= ROOM)
    return found


def free_sides(outline: Rectangle, free: Callable[[Array], Mask], rim: float = 0.0) -> tuple[Vec2, ...]:
    """Sides (unit steps in the outline's frame) before which the robot can stand, where points (n, 2) [map] are `free`.

    Where it can do so before none it may reach round a corner, as far aside as approach poses are.
    """
    found: list[Vec2] = []
    for beyond in (0.0, max(LATERAL)):
        for ax, ay in () if found else SIDES:
            half = outline.length / 2 if ax else outline.width / 2
            width = outline.width if ax else outline.length
            far = max(width / 2 - INSET, 0.0) + beyond
            aside = np.linspace(-far, far, 2 * math.ceil(far / BESIDE) + 1)
            offs = [half + rim + EDGE_DISTANCE + back for back in BACK]
            spots = np.array([outline.to_map(ax * off - ay * s, ay * off + ax * s) for off in offs for s in aside])
            if free(spots).any():
                found.append((ax, ay))
    return tuple(found)


def floor_from_home(plan: FloorPlan) -> tuple[Cells, Mask]:
    """A grid over the plan, and which of its cells the base reaches from home."""
    cells = Cells(plan, CELL)
    return cells, reached(static_distances(cells, plan), CELL, cells.cell(plan.home.x, plan.home.y))


def with_sides(plan: P) -> P:
    """The plan; surfaces without `approach` get the sides that are free of walls and furniture."""
    if all(r.approach for r in plan.receptacles):
        return plan
    cells, floor = floor_from_home(plan)

    def free(spots: Array) -> Mask:
        found: Mask = floor[cells.cells(spots[:, 0], spots[:, 1])]
        return found

    sided = tuple(
        r
        if r.approach
        else msgspec.structs.replace(r, approach=free_sides(r.outline, free, BIN_RIM if r.depth else 0.0))
        for r in plan.receptacles
    )
    return msgspec.structs.replace(plan, receptacles=sided)
