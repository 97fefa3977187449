"""What a receptacle is built of: the boxes that the simulator makes of it, and that a lidar can hit. Pure."""

from typing import NamedTuple

from common.floor_plan import Receptacle, Vec3
from common.geometry import SIDES

LEG, LEG_INSET, BODY_INSET, BIN_WALL, TOP = 0.05, 0.04, 0.01, 0.015, 0.03
"""How furniture is built [m]: a table's legs and how far inside the top's edge they stand, how far a cabinet's body
stays behind its top, the thickness of a bin's walls and of a top."""


class Part(NamedTuple):
    """A box of full extents `size` [m], its middle in the receptacle's own frame above the floor; the part with the
    usable surface has no `name`."""

    name: str
    center: Vec3
    size: Vec3


def parts(r: Receptacle) -> list[Part]:
    """A table: a top on four legs. A bin: a floor and four walls. All else: a closed body under a top."""
    (sx, sy), z = r.size, r.center[2]
    if r.kind == "bin":
        wide, long = sx + 2 * BIN_WALL, sy + 2 * BIN_WALL
        middles = [(i * (sx + BIN_WALL) / 2, j * (sy + BIN_WALL) / 2, r.depth / 2) for i, j in SIDES]
        sizes = [(BIN_WALL if i else wide, BIN_WALL if j else long, r.depth) for i, j in SIDES]
        walls = zip(middles, sizes, strict=True)
        return [Part("", (0, 0, z / 2), (sx, sy, max(z, 0.01))), *(Part(f"_wall_{n}", *w) for n, w in enumerate(walls))]
    top, under = Part("", (0, 0, z - TOP / 2), (sx, sy, TOP)), z - TOP
    if r.kind == "table":
        feet = [(i * (sx / 2 - LEG_INSET), j * (sy / 2 - LEG_INSET)) for i in (1, -1) for j in (1, -1)]
        return [top, *(Part(f"_leg_{n}", (x, y, under / 2), (LEG, LEG, under)) for n, (x, y) in enumerate(feet))]
    return [Part("_body", (0, 0, under / 2), (sx - 2 * BODY_INSET, sy - 2 * BODY_INSET, under)), top]
