"""The floor as it is seen, and the rugs on it, of which no map need tell. Pure."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.floor_plan import DRIVEN_OVER
from common.geometry import Array, Mask
from services.perception.views.visible_plan import Cloud

SEARCH = 0.025
"""How far [m] from where it is believed to be the floor is looked for. Chosen: errors of the camera's pose."""
SAMPLE, LEAST, FITS = 11, 60, 5
"""Every which pixel of the floor its plane is fitted to, how few of them tell of none, and fits, each to what is near
the one before [count]."""
LAYER = 0.004
"""Height [m] from which on what is wide is a layer on the floor. Chosen: half of what an object stands up at least."""
CELL, PIXELS = 0.025, 3
"""Side [m] of the cells whose height is the mean of every so many-th pixel; chosen: some ten of them at 1.5 m."""
WIDE = 7
"""Cells (18 cm) that a layer extends in all directions, as no object that is as low does but a large book."""
SHADOW = 6
"""Cells (15 cm) of a layer that what stands on it hides."""


def layers(cloud: Cloud) -> list[tuple[float, Cloud]]:
    """The floor, and what lies on it as wide as a rug: the height [m] of each, and the points over it.

    Their heights are as seen: a camera that is tilted by 0.3 degrees more than it is believed to be sees the floor rise
    by 12 mm within 2.2 m.
    """
    cloud = _levelled(cloud)
    if not len(cloud.pixels):
        return []
    rows, columns = (((axis - axis.min()) / CELL).astype(np.intp) for axis in (cloud.x, cloud.y))
    levels = _levels(
        rows[::PIXELS], columns[::PIXELS], cloud.z[::PIXELS], (int(rows.max()) + 1, int(columns.max()) + 1)
    )
    if not levels.any():
        return [(0.0, cloud)]
    level = levels[rows, columns]
    return [(float(height), cloud.kept(level == height)) for height in np.unique(level)]


def _levelled(cloud: Cloud) -> Cloud:
    """Heights above a plane through the lower points: what is wide and stands up a little is on it."""
    few = np.abs(cloud.z[::SAMPLE]) < SEARCH
    if few.sum() < LEAST:
        return cloud
    x, y, z = (axis[::SAMPLE][few].astype(np.float64) for axis in (cloud.x, cloud.y, cloud.z))
    rows = np.stack([x, y, np.ones_like(x)], axis=1)
    plane: Array = np.zeros(3)
    near = np.ones(len(z), bool)
    for _ in range(FITS):
        if near.sum() < LEAST:
            break
        plane = np.asarray(np.linalg.lstsq(rows[near], z[near], rcond=None)[0])
        off = z - rows @ plane
        near = (off > -SEARCH / 2) & (off < LAYER)
    return Cloud(cloud.pixels, cloud.x, cloud.y, cloud.z - (plane[0] * cloud.x + plane[1] * cloud.y + plane[2]))


def _levels(
    rows: NDArray[np.intp], columns: NDArray[np.intp], z: NDArray[np.float32], shape: tuple[int, int]
) -> NDArray[np.float32]:
    """In each cell the height [m] of what lies there as wide as a rug, else 0."""
    cells, size = rows * shape[1] + columns, shape[0] * shape[1]
    capped = np.clip(z, -SEARCH, DRIVEN_OVER + 2 * LAYER)
    with np.errstate(invalid="ignore"):
        height = (np.bincount(cells, capped, size) / np.bincount(cells, minlength=size)).reshape(shape)
    low: Mask = (height > LAYER) & (height < DRIVEN_OVER + LAYER)
    # It may go on where the picture ends.
    wide = low & ndimage.binary_erosion(low | np.isnan(height), np.ones((WIDE, WIDE)), border_value=1)
    labels, _ = ndimage.label(low)
    level = np.zeros(shape, np.float32)
    for n in np.unique(labels[wide]):
        layer = np.pad(labels == n, SHADOW)
        around = ndimage.binary_closing(layer, np.ones((SHADOW, SHADOW)))[SHADOW:-SHADOW, SHADOW:-SHADOW]
        level[ndimage.binary_dilation(around)] = np.median(height[labels == n])
    return level
