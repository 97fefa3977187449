"""How an object looks, as numbers that a later look can be compared with. Pure.

Colours count by their chromaticity, which light and shade change little, and along the object's own axis, which turning
it about that axis changes little; both from several looks, since a box has another face behind. Shape counts by
the extents.
"""

import math
from collections.abc import Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.messages import Vec3
from services.perception.naming.crop import Crop

Cells = NDArray[np.intp]
PARTS = 4
"""Parts along the axis with a colour histogram each: cap, neck, label, foot of a bottle."""
CELLS = 6
"""Cells of each of the two chromaticities of a histogram."""
SPAN = 1.2
"""Largest opponent chromaticity that has a cell of its own: that of a saturated print."""
FINER = 3.0
"""How much finer the cells are near grey, where most colours of a home lie, than at SPAN. Chosen: a lamp's tint of
8 % is a quarter of a cell there."""
LEVELS = 4
"""Cells of brightness relative to the object's median: dark print on a light ground is told from light on dark."""
STOPS = 6.0
"""Range of that brightness, in factors of two."""
GREY = 12.0
"""Brightness (of 255) below which chromaticity is noise."""
EXTENT_NOISE, EXTENT_SHARE = 0.007, 0.07
"""Standard deviation of a measured extent: this [m], and this share of it; measured on drawn packages."""
SHAPE_WEIGHT = 0.08
"""What a squared standard deviation of shape beyond the first counts for in `difference`. Chosen: at twice the noise it
is a third of what separates two colours, at three times more than colours can say for it."""
TINY = 1e-12
"""Stands in for a share of zero in a division."""


class Look(msgspec.Struct, frozen=True):
    """One look at an object: `histogram`, float16 PARTS x CELLS x CELLS x LEVELS, which sums to 1; `bearing`: unit
    vector to the camera in frame map; `distance` [m]; `size` and `seen` as in `Crop`."""

    histogram: bytes
    size: Vec3
    bearing: Vec3
    distance: float
    seen: float = 1.0


def look_of(crop: Crop) -> Look:
    """The numbers of one crop."""
    colours = crop.colours.astype(np.float64)
    red, green, blue = colours.T + 1.0
    level = (red + green + blue) / 3
    weight = np.minimum(1.0, level / GREY)
    # Opponent chromaticities: red against green, both against blue.
    first = np.clip((red - green) / level / SPAN, -1, 1) * weight
    second = np.clip(((red + green) / 2 - blue) / level / SPAN, -1, 1) * weight
    bright = np.clip(np.log2(level / np.median(level)) / STOPS + 0.5, 0.0, 1.0)
    part = np.minimum((crop.along * PARTS).astype(np.intp), PARTS - 1)
    cube = np.zeros((PARTS, CELLS, CELLS, LEVELS))
    for (i, f), (j, s), (k, g) in _soft(_spread(first), _spread(second), (bright * (LEVELS - 1), LEVELS)):
        np.add.at(cube, (part, i, j, k), f * s * g)
    cube /= len(colours)
    x, y, z = (float(v) for v in crop.bearing)
    return Look(
        histogram=cube.astype("<f2").tobytes(), size=crop.size, bearing=(x, y, z), distance=crop.distance,
        seen=crop.seen,
    )  # fmt: skip


def _spread(chroma: Array) -> tuple[Array, int]:
    """Position among the cells, finer near grey."""
    return (np.arcsinh(FINER * chroma) / math.asinh(FINER) / 2 + 0.5) * (CELLS - 1), CELLS


def _soft(*axes: tuple[Array, int]) -> list[tuple[tuple[Cells, Array], ...]]:
    """For each corner of the cell that a value lies in: index and weight by axis, so that no edge tears them apart."""
    sides: list[tuple[tuple[Cells, Array], tuple[Cells, Array]]] = []
    for position, number in axes:
        position = np.clip(position, 0.0, number - 1.0)
        low = np.minimum(position.astype(np.intp), number - 2)
        share = position - low
        sides.append(((low, 1.0 - share), (low + 1, share)))
    return [(a, b, c) for a in sides[0] for b in sides[1] for c in sides[2]]


def colour_difference(a: Look, b: Look) -> float:
    """Hellinger distance of two looks' histograms, 0 the same to 1 nothing in common."""
    first, second = _parts(a), _parts(b)
    if first.shape != second.shape:
        return 1.0
    here, there = first.sum(axis=1), second.sum(axis=1)
    both = np.minimum(here, there)
    if not both.any():
        return 1.0
    # Each part by itself: that the foot is hidden in one of them says nothing.
    overlap = np.sqrt(first * second).sum(axis=1) / np.sqrt(here * there + TINY)
    return float(math.sqrt(max(0.0, 1.0 - float((overlap * both).sum() / both.sum()))))


def _parts(look: Look) -> Array:
    return np.frombuffer(look.histogram, "<f2").astype(np.float64).reshape(PARTS, -1)


def shape_difference(a: Vec3, b: Vec3) -> float:
    """How many standard deviations two measured sizes are apart, root mean square over the extents."""
    first = np.array([*sorted(a[:2]), a[2]])
    second = np.array([*sorted(b[:2]), b[2]])
    spread = EXTENT_NOISE + EXTENT_SHARE * np.maximum(first, second)
    return float(np.sqrt(np.mean(((first - second) / (math.sqrt(2) * spread)) ** 2)))


def difference(a: Look, b: Look) -> float:
    """How unlike two looks are: colours, plus what of the shape is beyond the noise."""
    return colour_difference(a, b) + SHAPE_WEIGHT * max(0.0, shape_difference(a.size, b.size) ** 2 - 1.0)


def nearest(look: Look, known: Sequence[Look]) -> float:
    """Difference to the most alike of the looks that are known; inf without any."""
    return min((difference(look, other) for other in known), default=math.inf)
