"""Segmentation of the floor into rooms, at walls, doors and other openings. Pure.

Source: Bormann et al., "Room segmentation: survey, implementation, and analysis", ICRA 2016 (distance transform).
"""

import cmath
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.files.map_file import FREE, OCCUPIED
from common.floor_plan import Room, Wall
from common.geometry import Rectangle
from services.mapping.bins import BIN_SIDE
from services.mapping.grid import RESOLUTION, Grid

DOOR = 0.42
"""Half of the width [m] up to which a passage is a door where no two jambs tell, in a corner: corridors are wider."""
WIDEST = 5.0
"""Gap [m] up to which two pieces of wall in one line have an opening between them: a wide arch, an open plan."""
IN_LINE, END = 0.12, 0.08
"""How far the pieces of one wall lie out of line, and from its end what belongs to it [m]: half a wall's thickness, and
the error of an end."""
CORNER = BIN_SIDE[1]
"""Length [m] from which a wall across the end of another makes a corner with it: more than the largest bin has, whose
sides are faces like a wall's where the robot does not fit beside it."""
CORRIDOR = 1.75
"""Gap [m] up to which what opens between two corners is the mouth of a corridor, and wider a bay of the room: corridors
in homes are 1.0 to 1.6 m wide."""
HIGH = 0.95
"""Height [m] from which on what stands there may be a wall behind furniture, of which the lidar sees nothing: above
tables, counters and the backs of sofas."""
LEAST_AREA = 2.5
"""Floor [m2] of a room, at least, with that under its furniture: a bed may hide most of a bedroom."""


def find_rooms(grid: Grid, states: NDArray[np.uint8], walls: Sequence[Wall]) -> list[Room]:
    """Rectangles along the walls around the rooms, the one with the robot's home first; they may overlap a little."""
    middles = grid.points((np.arange(max(grid.shape)), np.arange(max(grid.shape))))
    xs, ys = middles[: grid.shape[1], 0], middles[: grid.shape[0], 1]
    tall = grid.covered & (grid.highest > HIGH)
    for area in (*(wall.footprint.grown(RESOLUTION / 2) for wall in walls), *openings(walls)):
        tall |= area.signed_distances(xs[None, :], ys[:, None]) < 0.0
    distance = ndimage.distance_transform_edt(~tall) * RESOLUTION
    floor = (states == FREE) | ((states == OCCUPIED) & ~tall)
    labels, count = ndimage.label(floor & (distance > DOOR))
    if not count:
        return []
    sizes = np.bincount(labels.ravel(), minlength=count + 1) * RESOLUTION**2
    seeds = np.where(sizes[labels] > 0.15, labels, 0)
    # Every other cell of the floor belongs to the room whose middle is nearest.
    _, (rows, columns) = ndimage.distance_transform_edt(seeds == 0, return_indices=True)
    grown = np.where(floor, seeds[rows, columns], 0)
    boxes: list[tuple[float, Rectangle]] = []
    along = Rectangle(0.0, 0.0, 0.0, 0.0, _direction(walls))
    for n in np.unique(grown[grown > 0]):
        rows, columns = np.nonzero(grown == n)
        if len(rows) * RESOLUTION**2 < LEAST_AREA:
            continue
        points = grid.points((rows, columns))
        own = np.stack(along.to_local(points[:, 0], points[:, 1]))
        low, high = np.quantile(own, 0.01, axis=1) - RESOLUTION, np.quantile(own, 0.99, axis=1) + RESOLUTION
        x, y = along.to_map(*((low + high) / 2).tolist())
        length, width = (high - low).tolist()
        boxes.append((float(np.hypot(points[:, 0], points[:, 1]).min()), Rectangle(x, y, length, width, along.yaw)))
    return [_room(f"room {i}", box) for i, (_, box) in enumerate(sorted(boxes), 1)]


def openings(walls: Sequence[Wall]) -> list[Rectangle]:
    """Doors, wider gaps in a wall and mouths of corridors: strips from the end of one piece to the next in its line.

    Ends are free, or both are corners behind which the sides of a corridor begin.
    """
    outlines = [wall.outline for wall in walls]
    found = []
    # Two pieces may begin at the same opening, and run away from it.
    for own in (*outlines, *(one._replace(yaw=one.yaw + math.pi) for one in outlines)):
        gap = min((g for other in outlines if (g := _gap(own, other)) > 0.0), default=WIDEST)
        start, middle, end = (own.to_map(own.length / 2 + share * gap, 0.0) for share in (0.0, 0.5, 1.0))
        if gap >= WIDEST:
            continue
        corners = [_across(point, own, outlines) for point in (start, end)]
        mouth = corners[0] == corners[1] and len(corners[0]) == 1 and gap < CORRIDOR
        if mouth or not any(_is_corner(point, own, outlines) for point in (start, end)):
            found.append(Rectangle(*middle, gap + 2 * END, 2 * RESOLUTION, own.yaw))
    return found


def _gap(own: Rectangle, other: Rectangle) -> float:
    """How far [m] ahead of a wall's end another one begins in its line; negative for what is in no line with it."""
    ends = [own.to_local(*other.to_map(side * other.length / 2, 0.0)) for side in (-1, 1)]
    return min(u for u, _ in ends) - own.length / 2 if max(abs(v) for _, v in ends) < IN_LINE else -1.0


def _is_corner(end: tuple[float, float], own: Rectangle, walls: Sequence[Rectangle]) -> bool:
    """True where a wall across runs past the end of one, which is then a corner and no jamb."""
    return any(wall.length > CORNER and _meets(end, wall, own) for wall in walls)


def _meets(end: tuple[float, float], wall: Rectangle, own: Rectangle) -> bool:
    """True for a wall across that goes through, or begins at, the end of one."""
    return abs(math.sin(wall.yaw - own.yaw)) > 0.5 and wall.contains(*end, wall.width / 2 + END)


def _across(end: tuple[float, float], own: Rectangle, walls: Sequence[Rectangle]) -> set[int]:
    """To which sides of a wall, 1 left and -1 right of it, others go from its end, however short they are."""
    sides = set()
    for wall in walls:
        if _meets(end, wall, own):
            reach = [own.to_local(*wall.to_map(way * wall.length / 2, 0.0))[1] for way in (-1, 1)]
            sides |= {side for side in (-1, 1) if max(side * v for v in reach) > own.width / 2 + END}
    return sides


def _direction(walls: Sequence[Wall]) -> float:
    """The angle in (-45, 45] degrees [rad] by which walls at right angles to each other are turned."""
    return cmath.phase(sum(cmath.rect(w.outline.length, 4 * w.outline.yaw) for w in walls)) / 4


def _room(name: str, box: Rectangle) -> Room:
    low, high = ((round(box.x + side * box.length / 2, 2), round(box.y + side * box.width / 2, 2)) for side in (-1, 1))
    return Room(name=name, low=low, high=high, yaw=round(box.yaw, 4) + 0.0, named=False)
