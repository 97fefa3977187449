"""Floor plan of a mapped home: walls, furniture, surfaces and bins with the sides they are reached from. Pure."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.files.map_file import FREE
from common.floor_plan import Box, Place, Receptacle, ReceptacleKind, Vec2, Wall
from common.free_sides import free_sides, reached
from common.furniture_parts import BIN_WALL, LEG, LEG_INSET
from common.geometry import Array, Rectangle
from common.household import Household
from services.mapping.bins import RIM_BAND, RING, find_bins
from services.mapping.grid import RESOLUTION, Cells, Grid
from services.mapping.rooms import find_rooms
from services.mapping.surfaces import Surface, find_surfaces, fit_rectangle
from services.mapping.walls import find_walls

SOLID = 0.35
"""Share of a surface's free sides at which the lidar meets a body below it, from which on it stands on no legs."""
AT_LEGS = LEG_INSET + LEG + 1.5 * RESOLUTION
"""Piece [m] at both ends of a side in which the lidar meets the legs of a table, as cells of the grid tell it."""
BED_SIDE, BED_HIGHEST, SOFA_HIGHEST, LOW_TABLE = 1.1, 0.70, 0.50, 0.52
"""Measures [m] that tell beds, sofas and low tables from tables. Source: DIN EN 1725, DIN 68890 and catalogues."""
CABINET = 0.65
"""Length [m] up to which what has a body is no shelf and no counter: bedside tables, stands and the like. Chosen."""
ASIDE = 3.0
"""How much farther a surface beside or behind the robot's home counts, when one is chosen to bring things to [-]."""
SEATS = ("bed", "sofa")
"""What surfaces are called that people sit and lie on."""
WHOLE = 0.5
"""Share of its rectangle that a piece of furniture fills at least, else it is cut."""
ROBOT = 1.45
"""Height [m] of furniture of which no camera saw the top."""
MARGIN = 0.15
"""Floor plan beyond what is known [m]."""


class EndPoints(NamedTuple):
    """Lidar end points (n, 2) [map] of all keyframes, and the sensor's position (n, 2) [map] for each."""

    points: Array
    eyes: Array


def floor_plan(
    name: str,
    lidar: EndPoints,
    grid: Grid,
    states: NDArray[np.uint8],
    level: Array,
    low: Array,
    unseen: Sequence[Wall] = (),
) -> Household:
    """The household of a mapped home; `level` and `low` (n, 3) [map] are points of level surfaces and of low things.

    `unseen`: walls that only held the robot up.
    """
    bins = find_bins(grid, low)
    surfaces = [s for s in without_nested(find_surfaces(level)) if not is_rim(s, bins)]
    receptacles = _named(surfaces, bins, grid, reachable(states))
    taken = [r.outline.grown(0.06) for r in receptacles]
    walls = [*find_walls(lidar.points, lidar.eyes, taken), *unseen]
    furniture = _furniture(grid, walls, taken)
    rows, columns = np.nonzero(states == FREE)
    cells = grid.points((rows, columns)) if len(rows) else np.zeros((1, 2))
    ends = np.array([p for w in walls for p in (w.start, w.end)] or cells)
    first, last = np.minimum(cells.min(axis=0), ends.min(axis=0)), np.maximum(cells.max(axis=0), ends.max(axis=0))
    home = Place(name="home", x=0.0, y=0.0, theta=0.0, aliases=("start", "the dock", "dock", "base"))
    return Household(
        name=name, low=_rounded(first - MARGIN), high=_rounded(last + MARGIN), home=home, walls=tuple(walls),
        furniture=tuple(furniture), rooms=tuple(find_rooms(grid, states, walls)), receptacles=tuple(receptacles),
        delivery=delivery_place(receptacles),
    )  # fmt: skip


def _rounded(point: Array) -> Vec2:
    return round(float(point[0]), 3), round(float(point[1]), 3)


def without_nested(surfaces: list[Surface]) -> list[Surface]:
    """The surfaces, largest first, without those over or under a larger one: tops of boxes on it, and what is in its
    body or between its legs, where no arm gets to."""
    kept: list[Surface] = []
    for s in surfaces:
        on = any(o.outline.contains(s.outline.x, s.outline.y, 0.03) and s.height - o.height < 0.5 for o in kept)
        if not on:
            kept.append(s)
    return kept


def is_rim(s: Surface, bins: list[tuple[Rectangle, float]]) -> bool:
    """True for the rim of an open bin, which is level as well."""
    return any(o.contains(s.outline.x, s.outline.y, RING) and abs(s.height - rim) < RIM_BAND for o, rim in bins)


def reachable(states: NDArray[np.uint8]) -> Cells:
    """Mask of the cells at which the robot can be, by FREE, OCCUPIED or UNKNOWN for each cell."""
    return reached(ndimage.distance_transform_edt(states == FREE) * RESOLUTION - RESOLUTION / 2, RESOLUTION)


def kind_of_surface(s: Surface, grid: Grid, sides: tuple[Vec2, ...]) -> tuple[str, ReceptacleKind]:
    """The name of a surface by its measures, and the kind it is built as: on legs or with a body."""
    met = []
    for ax, ay in sides:
        # A cell's width inside the edge, where no wall behind it is met.
        side = s.outline.width if ax else s.outline.length
        along = np.linspace(-0.5, 0.5, 12) * max(side - 2 * AT_LEGS, 0.0)
        off = (s.outline.length if ax else s.outline.width) / 2 - 0.02
        spots = np.array([s.outline.to_map(ax * off - ay * a, ay * off + ax * a) for a in along])
        met.append(grid.at(spots, ndimage.binary_dilation(grid.walls)))
    if float(np.mean(met)) < SOLID:
        return ("low table" if s.height < LOW_TABLE else "table"), "table"
    if s.outline.width >= BED_SIDE and s.height <= BED_HIGHEST:
        return "bed", "counter"
    if s.outline.length >= 1.2 and s.outline.width >= 0.5 and s.height <= SOFA_HIGHEST:
        return "sofa", "counter"
    kind: ReceptacleKind = "shelf" if s.outline.width <= 0.45 else "counter"
    return ("cabinet" if s.outline.length <= CABINET else kind), kind


def _named(
    surfaces: list[Surface], bins: list[tuple[Rectangle, float]], grid: Grid, reached: Cells
) -> list[Receptacle]:
    """The receptacles that the robot can reach, numbered where several have one name."""
    found: list[Receptacle] = []
    counts: dict[str, int] = {}

    def add(
        name: str, kind: ReceptacleKind, outline: Rectangle, z: float, depth: float, sides: tuple[Vec2, ...]
    ) -> None:
        counts[name] = counts.get(name, 0) + 1
        own = name if counts[name] == 1 else f"{name} {counts[name]}"
        found.append(
            Receptacle(
                name=own, kind=kind, center=(round(outline.x, 3), round(outline.y, 3), round(z, 3)),
                size=(round(outline.length, 3), round(outline.width, 3)), yaw=round(outline.yaw, 4),
                depth=round(depth, 3), approach=sides, spawn=not depth, named=False,
            )
        )  # fmt: skip

    for s in surfaces:
        if sides := free_sides(s.outline, lambda spots: grid.at(spots, reached)):
            add(*kind_of_surface(s, grid, sides), s.outline, s.height, 0.0, sides)
    for outline, rim in bins:
        if sides := free_sides(outline, lambda spots: grid.at(spots, reached), BIN_WALL):
            add("bin", "bin", outline, 0.02, rim, sides)
    return found


def _furniture(grid: Grid, walls: list[Wall], taken: list[Rectangle]) -> list[Box]:
    """Boxes around the occupied cells that neither walls nor receptacles explain."""
    cells = grid.walls | (grid.covered & (grid.highest > 0.12))
    rows, columns = np.nonzero(cells)
    if not len(rows):
        return []
    points = grid.points((rows, columns))
    free = np.ones(len(points), bool)
    for r in [*taken, *(w.footprint.grown(0.08) for w in walls)]:
        free &= r.signed_distances(points[:, 0], points[:, 1]) > 0.02
    left = np.zeros(grid.shape, bool)
    left[rows[free], columns[free]] = True
    labels, count = ndimage.label(ndimage.binary_closing(left, np.ones((3, 3))) | left, np.ones((3, 3)))
    found: list[Box] = []
    for n in range(1, count + 1):
        rows, columns = np.nonzero((labels == n) & left)
        if len(rows) < 2:
            continue
        for part in compact_parts(grid.points((rows, columns))):
            found.append(_box(f"furniture {len(found) + 1}", part, grid))
    return found


def compact_parts(points: Array) -> list[Array]:
    """The middles of cells (n, 2) cut into parts that fill their bounding rectangles, as at a corner of furniture."""
    outline = fit_rectangle(points).grown(RESOLUTION / 2)
    if len(points) * RESOLUTION**2 >= WHOLE * outline.length * outline.width or outline.length < 3 * RESOLUTION:
        return [points]
    along, _ = outline.to_local(points[:, 0], points[:, 1])
    near = along < 0.0
    if near.all() or not near.any():
        return [points]
    return [*compact_parts(points[near]), *compact_parts(points[~near])]


def _box(name: str, cells: Array, grid: Grid) -> Box:
    """The box around the middles of cells (n, 2), as high as what the camera saw of them."""
    outline = fit_rectangle(cells).grown(RESOLUTION / 2)
    rows, columns = grid.cells(cells)
    lidar = bool(grid.walls[rows, columns].any())
    high = float(grid.highest[rows, columns].max())
    low = 0.0 if lidar else float(min(grid.lowest[rows, columns].min(), high - 0.02))
    high = high if high > max(low, 0.25 * lidar) else ROBOT
    return Box(
        name=name, yaw=round(outline.yaw, 4),
        center=(round(outline.x, 3), round(outline.y, 3), round((low + high) / 2, 3)),
        size=(round(outline.length, 3), round(outline.width, 3), round(high - low, 3)),
    )  # fmt: skip


def delivery_place(receptacles: list[Receptacle]) -> str:
    """The surface that things are brought to: the one before the home pose, else the nearest; seats as a last resort.

    "" where no surface was found.
    """
    flat = [r for r in receptacles if not r.depth]
    flat = [r for r in flat if not r.name.startswith(SEATS)] or flat

    def off(r: Receptacle) -> float:
        return math.hypot(r.center[0], r.center[1]) * (1.0 if r.center[0] > abs(r.center[1]) else ASIDE)

    return min(flat, key=off).name if flat else ""
