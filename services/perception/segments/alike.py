"""Parts of one colour that the picture shows as one, where depth is missing between them. Pure.

A stereo camera finds no depth for some pixels along an edge: the spout before its can, the far half of a ring, a
handle before its body come as parts of their own, and the picture shows that one goes on in the other.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Array
from services.perception.segments.dark import DARK, Pixels
from services.perception.views import colour
from services.perception.views.view import View

ALIKE = 0.05
"""Difference of two colours (`colour.difference`) up to which they are of one thing. Chosen: light and shade of one
make .04, a colour beside another .15."""
SHADE = 0.4
"""Brightness of one part by that of the other from which it may be its shaded side."""
OWN = 0.12
"""Difference of chromaticity, the mean of 3 x 3 pixels, up to which a pixel has that colour: three times its noise
where it is dim."""
BRIDGED = 0.06
"""Gap [m] on the floor plan between such parts: of a spout's mouth from its can, of a hoop's two sides."""
LEVEL, AROUND = 0.006, 12
"""Distance [m] from its plane within which a surface is seen, and how far around the parts [pixels] it is looked at."""


def one_in_picture(view: View, plane: Array, a: Pixels, b: Pixels) -> bool:
    """One of two parts goes on in the other through pixels of their colour, and the surface z = plane (3,) @ (x, y, 1)
    around them is of another."""
    own, its = colour.typical(view.rgb[a]), colour.typical(view.rgb[b])
    darker, brighter = sorted((float(own.max()), float(its.max())))
    # What is dark has no colour; its outline joins it.
    if darker < max(DARK / 255, SHADE * brighter) or colour.difference(own, its) >= ALIKE:
        return False
    rows, columns = (np.concatenate(pair) for pair in zip(a, b, strict=True))
    top, left = max(0, int(rows.min()) - AROUND), max(0, int(columns.min()) - AROUND)
    window = slice(top, int(rows.max()) + AROUND), slice(left, int(columns.max()) + AROUND)
    rgb = ndimage.uniform_filter(view.rgb[window].astype(np.float32), (3, 3, 1))
    share = rgb / np.maximum(rgb.sum(axis=-1, keepdims=True), 1.0)
    mine = np.abs(share - own / max(float(own.sum()), 1e-3)).sum(axis=-1) < OWN
    x, y, z = np.moveaxis(view.points[window], -1, 0)
    level = (view.depth[window] > 0) & (np.abs(z - (plane[0] * x + plane[1] * y + plane[2])) < LEVEL)
    if np.count_nonzero(mine & level) > np.count_nonzero(level) / 2:
        return False
    numbers = ndimage.label(mine, np.ones((3, 3)))[0]
    one, other = (_mostly(numbers[p[0] - top, p[1] - left]) for p in (a, b))
    return one == other != 0


def _mostly(numbers: NDArray[np.int32]) -> int:
    """The number that most have."""
    return int(np.bincount(numbers).argmax())
