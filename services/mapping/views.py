"""The next best view: the base pose that shows most unknown floor for the length of the way to it. Pure.

Frontiers are unknown cells beside floor that the robot can reach; what stands above the floor counts as well until it
was seen from near. A pose is chosen by what it shows against the way to it.
Source: Yamauchi, "A frontier-based approach for autonomous exploration", 1997; Gonzalez-Banos and Latombe, "Navigation
strategies for exploring indoor environments", 2002.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import csgraph

from common.approach import FOOTPRINT
from common.files.map_file import FREE, OCCUPIED, UNKNOWN
from common.floor_plan import Vec2
from common.geometry import Array, Pose2
from common.grid_graph import graph_of
from services.mapping.grid import RESOLUTION, Cells, Grid, Index

CLEARANCE = FOOTPRINT + RESOLUTION / 2
"""Distance [m] from the edge of what is not free that a pose has: the footprint and half of a cell; a way has a cell
less, as navigation plans it by the middles of cells."""
HEADINGS = 12
"""Directions that are tried at each position [count]: a third of the camera's width apart."""
SPACING = 6
"""Side of the squares of which one position each is tried [cells]: 0.3 m."""
HALF_VIEW = math.radians(33)
"""Half of the camera's width [rad], less its rim."""
FRONTIER_RANGE, SURFACE_RANGE = (0.5, 2.7), (0.55, 1.7)
"""Nearest and farthest that floor and a surface are seen from well [m]: the camera's lower rim, and its noise."""
LEAST_FRONTIER = 5
"""Cells of a frontier below which it is a gap between pixels [count]: a quarter of a metre."""
GAP, POCKET = 3, 40
"""Width of an opening [cells] below which it is a gap between pixels, and size of what is unknown [cells] below which
nobody can go there: 0.15 m, and a third of what the robot covers."""
NO_WALL = 5.0
"""Distance from what is occupied [cells] from which on no wall parts a cell from the floor beside it: half of the gap
that two rays of the lidar leave on a wall that they graze."""
FLOOR_TRIES, TOP_TRIES = 5, 3
"""Pictures without result, two of a view, after which floor and what stands above it are given up [count]."""
NEARER = 0.75
"""What each picture without result leaves of the distance from which floor is looked at again [-]: what is not seen
through a door from along its wall is seen from before it."""
BARRED = 0.25
"""Radius [m] around a position that could not be reached in which no other is tried. Chosen: a footprint's."""
MOST = 500
"""Cells that gains are counted by, at most [count]; chosen: the choice stays below 0.3 s."""
NEIGHBOURS = 1
"""Rows and columns of the longest step of a way [cells]: 8 directions."""
HOME_COST = 1.0
"""Way that every view costs beside the drive [m]: stopping, turning and looking."""


class View(NamedTuple):
    """A base pose and its `gain`, the number of cells worth seeing that it shows."""

    pose: Pose2
    gain: float


class Survey(NamedTuple):
    """Reachable `frontiers` left, known floor `area` [m2], and the next `view`, None when nothing is left."""

    frontiers: int
    area: float
    view: View | None


def survey(grid: Grid, states: NDArray[np.uint8], here: Pose2, barred: Sequence[Vec2]) -> Survey:
    """Find what is left to be seen and the next best view; `barred` are positions that could not be reached."""
    free = states == FREE
    distance = ndimage.distance_transform_edt(free) * RESOLUTION - RESOLUTION / 2
    passable = distance >= CLEARANCE - RESOLUTION
    cost = _costs(grid, passable, here)
    reached = np.isfinite(cost)
    area = float(free.sum()) * RESOLUTION**2
    wanted, places = interesting(grid, states, ndimage.binary_dilation(reached, iterations=12))
    if not wanted.any():
        return Survey(0, area, None)
    stand = _roomiest(np.where(reached & (distance >= CLEARANCE), distance, 0.0))
    spots, costs = grid.points(stand), cost[stand]
    for x, y in barred:
        far = np.hypot(spots[:, 0] - x, spots[:, 1] - y) > BARRED
        spots, costs = spots[far], costs[far]
    if not len(spots):
        return Survey(places, area, None)
    return Survey(places, area, _best(grid, states, wanted, spots, costs, here))


def _roomiest(room: Array) -> Index:
    """Of each square of SPACING cells the one with the most room: a narrow corridor may lie between any fixed ones."""
    rows, columns = np.nonzero(room)
    order = np.argsort(-room[rows, columns], kind="stable")
    rows, columns = rows[order], columns[order]
    _, first = np.unique((rows // SPACING) * room.shape[1] + columns // SPACING, return_index=True)
    return rows[first], columns[first]


def interesting(grid: Grid, states: NDArray[np.uint8], near: Cells) -> tuple[Cells, int]:
    """Cells that a view should show, frontiers and things not yet seen from near, and the places that they form."""
    free = states == FREE
    # Into gaps and pockets the robot does not fit; where no ray of the lidar has passed, a wall that is near may be in
    # between. Far from the lidar there are cells between its rays.
    open_floor = (grid.passed > 0) | (ndimage.distance_transform_edt(states != OCCUPIED) > NO_WALL)
    labels, count = ndimage.label(ndimage.binary_opening(states == UNKNOWN, np.ones((GAP, GAP))))
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    sizes[0] = 0
    frontier = (sizes >= POCKET)[labels] & open_floor & ndimage.binary_dilation(free & near)
    # A strip along a wall is the wall.
    broad = ndimage.binary_opening(grid.covered & ~grid.walls, np.ones((3, 3)))
    surface = broad & ~grid.near & ndimage.binary_dilation(near, iterations=14)
    found = np.zeros(grid.shape, bool)
    places = 0
    for cells, tries in ((frontier, FLOOR_TRIES), (surface, TOP_TRIES)):
        cells &= grid.looked < tries
        labels, count = ndimage.label(cells, np.ones((3, 3)))
        sizes = np.bincount(labels.ravel(), minlength=count + 1)
        large = sizes >= LEAST_FRONTIER
        large[0] = False
        found |= large[labels]
        places += int(large.sum())
    return found, places


def shown(grid: Grid, pose: Pose2, reach: tuple[float, float], blocked: Cells) -> Cells:
    """Mask of cells in the camera's view from `pose` between two distances [m], with no `blocked` cell before them."""
    rows, columns = np.nonzero(_disc(grid, pose, reach[1]))
    cells = grid.points((rows, columns))
    seen = _sees(grid, np.array([pose[:2]]), cells, reach, blocked)[0]
    bearing = np.arctan2(cells[:, 1] - pose[1], cells[:, 0] - pose[0]) - pose[2]
    seen &= np.abs(np.mod(bearing + math.pi, 2 * math.pi) - math.pi) < HALF_VIEW
    found = np.zeros(grid.shape, bool)
    found[rows[seen], columns[seen]] = True
    return found


def _disc(grid: Grid, pose: Pose2, radius: float) -> Cells:
    ys = grid.origin[1] + (np.arange(grid.shape[0]) + 0.5) * RESOLUTION - pose[1]
    xs = grid.origin[0] + (np.arange(grid.shape[1]) + 0.5) * RESOLUTION - pose[0]
    found: Cells = xs[None, :] ** 2 + ys[:, None] ** 2 <= radius**2
    return found


def _best(grid: Grid, states: NDArray[np.uint8], wanted: Cells, spots: Array, costs: Array, here: Pose2) -> View | None:
    """The position and heading with the most cells in view for the way there."""
    rows, columns = np.nonzero(wanted)
    chosen = np.linspace(0, len(rows) - 1, min(MOST, len(rows))).astype(int)
    share = len(rows) / len(chosen)
    rows, columns = rows[chosen], columns[chosen]
    cells = grid.points((rows, columns))
    surface = states[rows, columns] == OCCUPIED
    # Positions from which something may be in view: the others show nothing.
    least = np.hypot(spots[:, None, 0] - cells[None, :, 0], spots[:, None, 1] - cells[None, :, 1]).min(axis=1)
    spots, costs = spots[least < FRONTIER_RANGE[1]], costs[least < FRONTIER_RANGE[1]]
    if len(spots) > MOST:
        order = np.argsort(costs)[:MOST]
        spots, costs = spots[order], costs[order]
    if not len(spots):
        return None
    seen = np.zeros((len(spots), len(cells)), bool)
    near, far = FRONTIER_RANGE
    again = near + (far - near) * NEARER ** grid.looked[rows, columns][~surface]
    seen[:, ~surface] = _sees(grid, spots, cells[~surface], (near, again), grid.walls)
    seen[:, surface] = _sees(grid, spots, cells[surface], SURFACE_RANGE, grid.tall)
    bearing = np.arctan2(cells[None, :, 1] - spots[:, None, 1], cells[None, :, 0] - spots[:, None, 0])
    best: View | None = None
    best_score = 0.0
    for k in range(HEADINGS):
        heading = 2 * math.pi * k / HEADINGS
        off = np.abs(np.mod(bearing - heading + math.pi, 2 * math.pi) - math.pi)
        gains = (seen & (off < HALF_VIEW)).sum(axis=1) * share
        turn = abs(math.remainder(heading - here[2], 2 * math.pi))
        # What a place shows beyond some 60 cells is seen on the way as well.
        scores = np.minimum(gains, 60.0) / (HOME_COST + costs + 0.15 * turn)
        n = int(np.argmax(scores))
        if gains[n] >= 2.0 and scores[n] > best_score:
            best_score = float(scores[n])
            best = View((float(spots[n, 0]), float(spots[n, 1]), heading), float(gains[n]))
    return best


def _sees(grid: Grid, spots: Array, cells: Array, reach: tuple[float, Array | float], blocked: Cells) -> Cells:
    """Which cells (n, 2) are seen from which spots (k, 2), past what is `blocked`: (k, n).

    `reach`: between which distances; the farthest may be of each cell (n,).
    """
    dx, dy = cells[None, :, 0] - spots[:, None, 0], cells[None, :, 1] - spots[:, None, 1]
    distance = np.hypot(dx, dy)
    found: Cells = (distance >= reach[0]) & (distance <= reach[1])
    k, n = np.nonzero(found)
    clear = np.ones(len(k), bool)
    # Up to two cells before the end: what is looked at may be the wall itself.
    for share in np.linspace(0.08, 0.94, 18):
        x, y = spots[k, 0] + dx[k, n] * share, spots[k, 1] + dy[k, n] * share
        column = np.clip(((x - grid.origin[0]) / RESOLUTION).astype(np.intp), 0, grid.shape[1] - 1)
        row = np.clip(((y - grid.origin[1]) / RESOLUTION).astype(np.intp), 0, grid.shape[0] - 1)
        clear &= ~blocked[row, column] | (distance[k, n] * (1.0 - share) < 2 * RESOLUTION)
    found[k, n] = clear
    return found


def _costs(grid: Grid, free: Cells, here: Pose2) -> Array:
    """Way [m] from here to every cell over free ones; inf where there is none."""
    rows, columns = np.nonzero(free)
    if not len(rows):
        return np.full(grid.shape, np.inf)
    cells = grid.points((rows, columns))
    start = int(np.argmin(np.hypot(cells[:, 0] - here[0], cells[:, 1] - here[1])))
    graph = graph_of(free, RESOLUTION, NEIGHBOURS)
    cost = csgraph.dijkstra(graph, directed=False, indices=rows[start] * grid.shape[1] + columns[start])
    return np.asarray(cost).reshape(grid.shape)
