"""The patches of one colour of a segment. Pure."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Array
from services.perception.segments.segment import Segment, spread
from services.perception.segments.segmentation import MIN_PIXELS
from services.perception.views.view import View

CHROMA = 0.05
"""Difference of chromaticity (red and green by the sum) of two pixels from which a colour ends between them. Chosen:
five times the noise of a pixel, smoothed, in a lit room."""
BRIGHT = 0.30
"""Difference of brightness, by that of both, from which a colour ends: black beside white has no other."""
LEAST_SHARE, FEW_IN_A_CROWD = 0.08, 0.03
"""Share of the segment's pixels that a piece has at least, and that the smallest of a crowd has."""
MOST_PIECES, IN_A_CROWD = 4, 9
"""Patches of colour beyond which they are print on one object, and beyond which they are no crowd of objects."""


def by_colour(
    view: View, segment: Segment, most: int = MOST_PIECES, least: float = LEAST_SHARE
) -> NDArray[np.intp] | None:
    """Number (n,) of the patch of one colour, of a `least` share of them, that each pixel belongs to; None if there is
    only one, or over `most`."""
    top, left = int(segment.rows.min()), int(segment.columns.min())
    shape = int(segment.rows.max()) - top + 1, int(segment.columns.max()) - left + 1
    window = slice(top, top + shape[0]), slice(left, left + shape[1])
    rgb = view.rgb[window].astype(np.float32) / np.float32(255)
    mask = np.zeros(shape, bool)
    mask[segment.rows - top, segment.columns - left] = True
    smooth = _smoothed(rgb, mask)
    total = np.maximum(smooth.sum(axis=-1), 0.02)
    red, green = smooth[..., 0] / total, smooth[..., 1] / total
    edge = np.zeros(shape, bool)
    for axis in (0, 1):
        step = np.abs(np.diff(red, axis=axis)) + np.abs(np.diff(green, axis=axis))
        a, b = (np.take(total, range(*r), axis=axis) for r in ((1, shape[axis]), (0, shape[axis] - 1)))
        ends = (step > CHROMA) | (np.abs(a - b) > BRIGHT * (a + b))
        edge[(slice(None, -1), slice(None)) if axis == 0 else (slice(None), slice(None, -1))] |= ends
    labels = ndimage.label(mask & ~edge)[0]
    counts = np.bincount(labels[mask], minlength=1)
    counts[0] = 0
    large = np.flatnonzero(counts >= max(MIN_PIXELS, least * len(segment.rows)))
    if not 2 <= len(large) <= most:
        return None
    patches = [np.nonzero(labels == label) for label in large]
    found = spread(segment, [(rows + top, columns + left) for rows, columns in patches])
    return _alike_joined(found, smooth[segment.rows - top, segment.columns - left].astype(np.float64))


def _smoothed(rgb: NDArray[np.float32], mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Mean colour of the 3 x 3 pixels of the mask around each."""
    weight = ndimage.uniform_filter(mask.astype(np.float32), 3)
    planes = [ndimage.uniform_filter(rgb[..., i] * mask, 3) / np.maximum(weight, 1e-3) for i in range(3)]
    return np.stack(planes, axis=-1)


def _alike_joined(cut: NDArray[np.intp], rgb: Array) -> NDArray[np.intp] | None:
    """Patches of the same colour are one: print or a rim may lie between them."""
    colours = []
    for n in range(int(cut.max()) + 1):
        middle = np.median(rgb[cut == n], axis=0)
        colours.append(np.append(middle[:2] / max(0.02, middle.sum()), 0.1 * middle.sum()))
    joined = np.arange(len(colours))
    for i in range(len(colours)):
        for j in range(i):
            if np.abs(colours[i] - colours[j]).sum() < CHROMA:
                joined[joined == joined[i]] = joined[j]
    names, found = np.unique(joined[cut], return_inverse=True)
    return found.reshape(-1).astype(np.intp) if len(names) > 1 else None
