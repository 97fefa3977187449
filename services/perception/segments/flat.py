"""What lies so flat that no pixel of it stands out of the noise of depth: a patch of another colour than its surface
has, that stands out as a whole. Pure.

A comb of 4 mm is one standard deviation high from 2 m. The mean height of its pixels is known five times better, and
print, a stain or a shadow has none.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Mask
from services.perception.segments.dark import DARK, Pixels
from services.perception.segments.segment import RIM
from services.perception.views.masks import dilated, eroded
from services.perception.views.view import View

OTHER, DARKER = 0.12, 0.3
"""Differences from the surface around, of chromaticity and of brightness by that, from which a pixel is of another
colour; the means of 3 x 3 pixels. Chosen: three times the noise of either in a dim room, beyond the grain of wood."""
AROUND = 61
"""Side [pixels] of the square in which the surface's own colour is taken."""
LEAST, MOST = 24, 3000
"""Pixels of a patch, at least, and beyond which it is a cloth."""
LIFT, SURE = 0.0012, 2.5
"""Height [m] of a patch over the surface around it, at least, and in standard deviations of its mean. Chosen: a third
of a comb's; a surface shows hardly any patch of another colour that is none."""
THIN, HIGHER = 0.02, 0.2
"""Height [m] up to which a thing lies flat, so that parts of it may not stand out, and the share of its pixels that may
be higher: the foot of what stands is seen, and the table beside it is tinted by it."""
ALIKE = 25
"""Pixels that share their noise: stereo cameras match windows of about 5 x 5."""


def patches(view: View, pixels: NDArray[np.intp], heights: NDArray[np.float32], over: NDArray[np.bool_]) -> Pixels:
    """Rows and columns of the patches that lie on a surface whose `pixels` (n,) have these heights [m] over its plane.

    `over` (n,): those that stand out of it by themselves. What has a colour and is of one patch with them need not lift
    as surely.
    """
    rows, columns = np.unravel_index(pixels, view.shape)
    top, left = int(rows.min()), int(columns.min())
    window = slice(top, int(rows.max()) + 1), slice(left, int(columns.max()) + 1)
    shape = window[0].stop - top, window[1].stop - left
    height, raised, tall = np.full(shape, np.nan, np.float32), np.zeros(shape, bool), np.zeros(shape, bool)
    height[(rows - top)[~over], (columns - left)[~over]] = heights[~over]
    thin = over & (heights < THIN)
    raised[(rows - top)[thin], (columns - left)[thin]] = True
    tall[(rows - top)[over & ~thin], (columns - left)[over & ~thin]] = True
    level = np.isfinite(height)
    differs, tinted = (_wide(mask) for mask in _of_another_colour(view.rgb[window].astype(np.float32), level))
    found = np.zeros(shape, bool)
    for mask, least in ((differs & level, LEAST), (tinted & (level | raised | tall), 1)):
        numbers = ndimage.label(mask, np.ones((3, 3)))[0]
        counts = np.bincount(numbers.ravel())
        low, high = (np.bincount(numbers[part], minlength=len(counts)) for part in (raised, tall))
        carried = (low >= LEAST) & (high < HIGHER * low)
        for n in np.flatnonzero((counts >= least) & (counts < MOST) & (carried if least == 1 else True)):
            own = (numbers == n) & level
            if n and own.any() and _lifts(own, height, level & ~differs, 0.0 if least == 1 else SURE):
                found |= own
    at = np.nonzero(found)
    return at[0] + top, at[1] + left


def _wide(mask: Mask) -> Mask:
    """A mask (h, w) without its lines of less than three pixels: the seams between boards are that thin, and a pencil
    at 1.2 m is not."""
    return mask & dilated(dilated(eroded(mask)))


def _of_another_colour(rgb: NDArray[np.float32], level: Mask) -> tuple[Mask, Mask]:
    """Which pixels (h, w) have another colour than the surface, seen where it is `level`, around them, and which of
    them another chromaticity, which no shadow has."""
    weight = np.maximum(ndimage.uniform_filter(level.astype(np.float32), AROUND), 1e-3)
    planes = [ndimage.uniform_filter(rgb[..., i], 3) for i in range(3)]
    around = [ndimage.uniform_filter(plane * level, AROUND) / weight for plane in planes]
    own, usual = np.maximum(sum(planes), 1.0), np.maximum(sum(around), 1.0)
    off = sum(np.abs(a / own - b / usual) for a, b in zip(planes, around, strict=True))
    alone = np.maximum(sum(rgb[..., i] for i in range(3)), 1.0)
    # A pixel beside the patch has some of its colour in the mean only.
    raw = sum(np.abs(rgb[..., i] / alone - b / usual) for i, b in enumerate(around))
    # What is dark has its own way to be seen: by its outline.
    brightest = np.maximum(np.maximum(planes[0], planes[1]), planes[2])
    bright, tinted = brightest > DARK, np.minimum(off, raw) > OTHER
    return bright & ((off > OTHER) | (np.abs(own - usual) > DARKER * usual)), bright & tinted


def _lifts(own: Mask, height: NDArray[np.float32], plain: Mask, sure: float) -> bool:
    """A patch is higher on average than the `plain` surface around it, by `sure` standard deviations of that."""
    rows, columns = np.nonzero(own)
    low, high = (
        (np.array([rows.min(), columns.min()]) - 2 * RIM).clip(0),
        (rows.max() + 2 * RIM, columns.max() + 2 * RIM),
    )
    window = slice(low[0], high[0] + 1), slice(low[1], high[1] + 1)
    around = ndimage.binary_dilation(own[window], iterations=2 * RIM) & plain[window]
    if np.count_nonzero(around) < len(rows) / 2:
        return False
    mine, others = height[window][own[window]], height[window][around]
    error = float(max(mine.std(), others.std())) * np.sqrt(ALIKE / len(mine) + ALIKE / len(others))
    return bool(mine.mean() - others.mean() > max(LIFT, sure * error))
