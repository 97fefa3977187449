"""How far a robot has to drive, on the map that it drives by. Pure."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from common import messages as m
from common.approach import ROOM
from common.cells import unpacked

REACH = 0.9
"""How near the base's centre has to come to a thing [m]; chosen: the arm's reach."""
START = 0.4
"""How far from the robot its way may begin [m]; chosen: beside a table it stands in cells that count as too narrow."""
STRAIGHT, DIAGONAL = ((0, 1), (1, 0)), ((1, 1), (1, -1))
"""Steps (rows, columns) from a cell to half of its neighbours [cells]; the others lead there by the same ones."""


def free_cells(costmap: m.Costmap) -> NDArray[np.bool_]:
    """Cells (height, width) where the base's centre may be.

    Raises:
        ValueError: the map is not as large as it says.
    """
    return (unpacked(costmap) * (costmap.far / 255.0) >= ROOM).astype(np.bool_)


def path_length(costmap: m.Costmap, start: tuple[float, float], end: tuple[float, float]) -> float | None:
    """Length [m] of the shortest way from `start` to where the arm reaches `end` (x, y) [map]; None where none leads.

    Raises:
        ValueError: as `free_cells`.
    """
    free = free_cells(costmap)
    number = np.full(free.shape, -1)
    number[free] = np.arange(free.sum())
    rows, columns = np.nonzero(free)
    x = costmap.x + (columns + 0.5) * costmap.resolution
    y = costmap.y + (rows + 0.5) * costmap.resolution
    from_start, to_end = np.hypot(x - start[0], y - start[1]), np.hypot(x - end[0], y - end[1])
    near = np.nonzero(to_end <= REACH)[0]
    if not len(from_start) or from_start.min() > START or not len(near):
        return None
    links = [_links(number, step) for step in (*STRAIGHT, *DIAGONAL)]
    one, other = (np.concatenate([pair[i] for pair in links]) for i in (0, 1))
    steps = [np.full(len(a), math.hypot(*step)) for (a, _), step in zip(links, (*STRAIGHT, *DIAGONAL), strict=True)]
    graph = coo_matrix((np.concatenate(steps) * costmap.resolution, (one, other)), shape=(len(rows), len(rows)))
    first = int(from_start.argmin())
    ways = dijkstra(graph.tocsr(), directed=False, indices=first)
    shortest = float(ways[near].min())
    return shortest + float(from_start[first]) if math.isfinite(shortest) else None


def _links(number: NDArray[np.int_], step: tuple[int, int]) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """Numbers of the free cells that are one step apart."""
    down, right = step
    height, width = number.shape
    here = number[: height - down, max(0, -right) : width - max(0, right)]
    there = number[down:, max(0, right) : width - max(0, -right)]
    both = (here >= 0) & (there >= 0)
    return here[both], there[both]
