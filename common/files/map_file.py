"""The files of a mapped home. The map is in the format of ROS's map_server: a grey picture `map.pgm` and `map.yaml`,
which says where it lies.

Source: nav2_map_server, modes `trinary` and `scale`; origin is the pose of the lower left corner of the picture.
"""

from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from common.files.atomic_file import replace
from common.files.plan_file import to_toml
from common.floor_plan import FloorPlan

MAP, SURFACES, HOUSEHOLD, PICTURE = "map", "surfaces.json", "household.toml", "map.png"
"""Files of a directory that holds a map; the first without its suffix."""
FREE, OCCUPIED, UNKNOWN = 0, 1, 2
"""What a cell of the grid is."""
GREY = {FREE: 254, OCCUPIED: 0, UNKNOWN: 205}
"""Of a state, as map_saver writes it."""
OCCUPIED_ABOVE, FREE_BELOW = 0.65, 0.196
"""Darkness [0..1] from which a cell is occupied, and up to which it is free: those of map_saver, with which the grey of
an unknown cell, 0.19608, is just not free."""


COLOURS = {FREE: (255, 255, 255), OCCUPIED: (40, 40, 40), UNKNOWN: (190, 190, 190)}
ROOM, SURFACE, TOP = (150, 70, 20), (20, 70, 160), (215, 228, 245)
"""Colours (red, green, blue, 0 to 255) of outlines and names in the picture for people."""
PIXELS = 4
"""Of a cell in the picture for people."""


class MapError(ValueError):
    """A map that cannot be used; names the file and what is wrong with it."""


class GridMap(NamedTuple):
    """`cells` (rows, columns) of FREE, OCCUPIED or UNKNOWN, row 0 in the south, each `resolution` [m] wide, from the
    corner (x, y) `origin` [map] on."""

    cells: NDArray[np.uint8]
    resolution: float
    origin: tuple[float, float]


def write_map(directory: Path, grid: GridMap, name: str = "map") -> Path:
    """Write the grid as `NAME.pgm` and `NAME.yaml` into the directory; returns the second file's path.

    Raises:
        MapError: they cannot be written.
    """
    grey = np.zeros(256, np.uint8)
    for state, level in GREY.items():
        grey[state] = level
    rows, columns = grid.cells.shape
    picture = grey[grid.cells[::-1]]
    _replace(directory / f"{name}.pgm", b"P5\n%d %d\n255\n" % (columns, rows) + picture.tobytes())
    x, y = grid.origin
    text = (
        f"image: {name}.pgm\nmode: trinary\nresolution: {grid.resolution:g}\norigin: [{x:.6g}, {y:.6g}, 0.0]\n"
        f"negate: 0\noccupied_thresh: {OCCUPIED_ABOVE}\nfree_thresh: {FREE_BELOW}\n"
    )
    path = directory / f"{name}.yaml"
    _replace(path, text.encode())
    return path


def write_home(directory: Path, grid: GridMap, household: FloorPlan) -> None:
    """Write all files of a home: map, surfaces, household, and a picture for people.

    Raises:
        MapError, OSError: they cannot be written.
    """
    write_map(directory, grid, MAP)
    surfaces = msgspec.json.format(msgspec.json.encode(surface_rows(household)), indent=1)
    _replace(directory / SURFACES, surfaces)
    _replace(directory / HOUSEHOLD, to_toml(household).encode())
    named_picture(grid, household).save(directory / PICTURE)


def _replace(path: Path, data: bytes) -> None:
    if why := replace(path, data):
        raise MapError(f"{path}: {why}")


def picture(cells: NDArray[np.uint8]) -> Image.Image:
    """The map for people, north up."""
    palette = np.array([COLOURS[n] for n in range(3)], np.uint8)
    drawn = palette[cells[::-1]]
    return Image.fromarray(np.repeat(np.repeat(drawn, PIXELS, axis=0), PIXELS, axis=1))


def named_picture(grid: GridMap, plan: FloorPlan) -> Image.Image:
    """The map for people with the outlines and names of rooms, surfaces and bins."""
    shown = picture(grid.cells)
    draw = ImageDraw.Draw(shown)

    def pixel(x: float, y: float) -> tuple[float, float]:
        scale = PIXELS / grid.resolution
        return (x - grid.origin[0]) * scale, shown.height - (y - grid.origin[1]) * scale

    def write(x: float, y: float, name: str, colour: tuple[int, int, int], height: int) -> None:
        font = ImageFont.load_default(height)
        half = font.getlength(name) / 2 + 2
        across, down = pixel(x, y)
        # A bin at a wall would have half of its name outside.
        at = max(half, min(across, shown.width - half)), down
        draw.text(at, name, fill=colour, font=font, anchor="mm", stroke_width=2, stroke_fill=(255, 255, 255))

    for room in plan.rooms:
        draw.polygon([pixel(*corner) for corner in room.outline.corners], outline=ROOM)
    for r in plan.receptacles:
        draw.polygon([pixel(*corner) for corner in r.outline.corners], fill=TOP, outline=SURFACE)
    for room in plan.rooms:
        write(*room.middle, room.name, ROOM, 16)
    for r in plan.receptacles:
        write(*r.center[:2], r.name, SURFACE, 11)
    return shown


def surface_rows(plan: FloorPlan) -> list[dict[str, Any]]:
    """Surfaces and bins for other programs: height (of a bin its rim) [m], corners [map], and the sides that they are
    reached from as unit steps [map]."""
    rows = []
    for r in plan.receptacles:
        rows.append(
            {
                "name": r.name, "kind": r.kind, "height": r.depth or r.center[2], "yaw": r.yaw,
                "outline": [[round(x, 4), round(y, 4)] for x, y in r.outline.corners],
                "reached_from": [[round(v, 4) for v in r.outline.direction(*a)] for a in r.approach],
            }
        )  # fmt: skip
    return rows
