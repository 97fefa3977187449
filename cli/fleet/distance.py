"""How far a robot has to drive, on the map that it drives by. Pure."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from common import messages as m
from common.approach import ROOM
from common.cells import unpacked
from common.grid_graph import graph_of

REACH = 0.9
"""How near the base's centre has to come to a thing [m]; chosen: the arm's reach."""
START = 0.4
"""How far from the robot its way may begin [m]; chosen: beside a table it stands in cells that count as too narrow."""
NEIGHBOURS = 1
"""Rows and columns of the longest step of a way [cells]: 8 directions."""


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
    rows, columns = np.nonzero(free)
    x = costmap.x + (columns + 0.5) * costmap.resolution
    y = costmap.y + (rows + 0.5) * costmap.resolution
    from_start, to_end = np.hypot(x - start[0], y - start[1]), np.hypot(x - end[0], y - end[1])
    near = to_end <= REACH
    if not len(from_start) or from_start.min() > START or not near.any():
        return None
    cells = rows * costmap.width + columns
    first = int(from_start.argmin())
    ways = dijkstra(graph_of(free, costmap.resolution, NEIGHBOURS), directed=False, indices=cells[first])
    shortest = float(ways[cells[near]].min())
    return shortest + float(from_start[first]) if math.isfinite(shortest) else None
