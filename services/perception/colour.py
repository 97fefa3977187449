"""Names of colours, and how alike two colours are whatever the light. Pure."""

import colorsys
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# hue [turns] up to which a colour has that name
_HUES = (
    (0.035, "red"), (0.115, "orange"), (0.19, "yellow"), (0.45, "green"), (0.70, "blue"), (0.80, "purple"),
    (0.93, "pink"), (1.01, "red"),
)  # fmt: skip


def typical(rgb: NDArray[np.uint8]) -> Array:
    """The colour (3,) in 0..1 that most of the pixels (n, 3) have, shadows and small parts aside."""
    values = rgb.astype(np.float64) / 255
    share = values / np.maximum(values.sum(axis=1, keepdims=True), 1e-3)
    middle = np.median(share, axis=0)
    near = np.abs(share - middle).sum(axis=1) < 0.12
    chosen = values[near] if np.count_nonzero(near) >= 5 else values
    return np.asarray(np.percentile(chosen, 75, axis=0), dtype=np.float64)


def difference(a: Sequence[float] | Array, b: Sequence[float] | Array) -> float:
    """Distance of two colours: mostly of their chromaticity, a little of their brightness."""
    first, second = np.asarray(a, np.float64)[:3], np.asarray(b, np.float64)[:3]
    chroma = np.abs(first / max(first.sum(), 1e-3) - second / max(second.sum(), 1e-3)).sum()
    return float(chroma + 0.06 * abs(first.max() - second.max()))


def name(rgb: Array) -> str:
    """The everyday name of a colour (3,) in 0..1."""
    hue, saturation, value = colorsys.rgb_to_hsv(*(float(v) for v in rgb))
    if value < 0.16:
        return "black"
    if saturation < 0.16:
        return "white" if value > 0.62 else "grey"
    if 0.02 < hue < 0.11 and value < 0.45:
        return "brown"
    return next(word for limit, word in _HUES if hue < limit)
