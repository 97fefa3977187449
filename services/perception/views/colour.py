"""Names of colours, and how alike two colours are whatever the light. Pure.

Words for parts of hue, saturation and value: Berlin and Kay (1969), eleven basic terms; the limits
are chosen on household goods.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array

WORDS = ("red", "orange", "yellow", "green", "blue", "purple", "pink", "brown", "black", "grey", "white")
"""Names of colours; `pixel_words` counts by their place here."""
_HUES = ((0.035, 0), (0.115, 1), (0.19, 2), (0.45, 3), (0.70, 4), (0.80, 5), (0.93, 6), (1.01, 0))
"""Hue [turns] up to which a colour has that word."""
PART = 0.15
"""Share of an object's pixels from which a colour is one of its own. Chosen: highlights and edges stay below it."""
SHADOW = 0.55
"""Brightness of a coloured pixel, by that of bright ones of its hue, below which it lies in shadow."""
COLOURED, HUE_PARTS, BRIGHT = 0.3, 12, 85
"""Saturation from which a pixel has a hue, the parts of the circle of hues that are told apart, and the percentile of
brightness of what is lit. Chosen: as wide as a colour's word."""
_SHADES = (
    (0.1, 0.0, 1.0, 0.7, 1.0), (0.16, 0.0, 1.0, 0.4, 1.0), (0.16, 0.0, 1.0, 1.0, 1.0), (0.1, 0.0, 1.0, 0.7, 0.65),
    (0.12, -0.012, 1.0, 0.7, 1.0), (0.12, 0.012, 1.0, 0.7, 1.0), (0.12, 0.0, 0.88, 0.7, 1.0),
    (0.12, 0.0, 1.14, 0.7, 1.0),
)  # fmt: skip
"""Weight, turn of the hue [turns], gain of the brightness, share of the light's cast and of the saturation with which a
colour is named: at the limit it has two words. Chosen: what light and camera leave uncertain; a home's neutral surfaces
are warm themselves, so that grey seems blue where all of that is taken for the light's; and what people call grey is
bluish by a quarter."""
MOST_PIXELS = 600
"""Pixels of an object whose colours are named."""
NEUTRAL, FEW_NEUTRAL, MOST_CAST = 0.22, 0.04, 0.12
"""Saturation up to which a pixel may be neutral, the share of the picture that must be, and the largest cast taken for
one: beyond it the walls are painted."""
LIT, WALL, PALEST = 60, 98, 0.75
"""Percentiles of the brightness of neutral pixels from which they show the light's colour, where a floor of beige tiles
shows its own, and that pale walls have; the share of it from which what is pale is white and not grey. Chosen: white
paint reflects 0.9, a pale wall 0.8, what is called grey 0.5."""
WHITE, DIMMEST = 0.55, 0.38
"""Brightness from which what is pale is white in a well-lit room, and in the dimmest that is made up for."""
FACING = 95
"""Percentile of the brightness of what is pale that shows its shade: the side that faces the lamp most. Chosen: of 21
white things in lamps of all kinds 3 are grey then, 8 by all their pixels, and of these in shades of 0.6 all are."""
DOUBT = 0.85, 1.17
"""Least and most by which the light at an object may differ from that of the room, evenly: what is then white as well
as grey has both words. Chosen: what lamps in a corner of the ceiling leave open."""
SAMPLE = 6
"""Every which pixel (and row) of the picture the light's colour is estimated from."""


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


def light(rgb: NDArray[np.uint8]) -> Array:
    """Gains (3,) that make the neutral surfaces of a picture (h, w, 3) grey, and as bright as in a well-lit room."""
    values = rgb[::SAMPLE, ::SAMPLE].reshape(-1, 3).astype(np.float64) / 255
    red, green, blue = values.T
    high, low = np.maximum(np.maximum(red, green), blue), np.minimum(np.minimum(red, green), blue)
    neutral = values[(high > 0.25) & (high < 0.98) & (high - low < NEUTRAL * high)]
    if len(neutral) < FEW_NEUTRAL * len(values):
        return np.ones(3)
    bright = neutral.max(axis=1)
    middle = np.median(neutral[bright >= np.percentile(bright, LIT)], axis=0)
    gains = middle.mean() / middle
    dim = WHITE / np.clip(PALEST * np.percentile(bright, WALL), DIMMEST, WHITE)
    return np.asarray(dim * (gains if np.abs(gains - 1).max() < MOST_CAST else np.ones(3)))


def _hsv(rgb: Array) -> tuple[Array, Array, Array]:
    """Hue [turns], saturation and value (n,) of colours (n, 3) in 0..1."""
    high, low = rgb.max(axis=1), rgb.min(axis=1)
    span = np.maximum(high - low, 1e-9)
    red, green, blue = rgb.T
    hue = np.where(
        high == red, (green - blue) / span, np.where(high == green, 2 + (blue - red) / span, 4 + (red - green) / span)
    )
    return np.remainder(hue / 6, 1.0), (high - low) / np.maximum(high, 1e-9), high


def pixel_words(rgb: Array, turn: float = 0.0) -> NDArray[np.intp]:
    """Place in WORDS (n,) of the name of each colour (n, 3) in 0..1, its hue turned by `turn` [turns]."""
    hue, saturation, value = _hsv(np.clip(rgb, 0.0, 1.0))
    hue = np.remainder(hue + turn, 1.0)
    limits = np.array([limit for limit, _ in _HUES])
    found = np.array([word for _, word in _HUES])[np.minimum(np.searchsorted(limits, hue), len(_HUES) - 1)]
    warm = (hue > 0.015) & (hue < 0.125)
    dull = (saturation < 0.6) & (value < 0.85) | (saturation < 0.78) & (value < 0.45) | (value < 0.36)
    found[warm & dull] = WORDS.index("brown")
    found[(hue > 0.125) & (hue < 0.2) & (value < 0.4)] = WORDS.index("green")
    # The same hue is magenta where it is bright and purple where it is deep.
    found[(hue > 0.8) & (hue < 0.9) & (saturation > 0.45) & (value < 0.75)] = WORDS.index("purple")
    reddish = (hue < 0.03) | (hue > 0.93)
    found[reddish & (saturation < 0.5) & (value > 0.7)] = WORDS.index("pink")
    # Cream and ivory are called white.
    pale = (
        (saturation < 0.16)
        | ((saturation < 0.22) & (value > 0.75))
        | ((saturation < 0.28) & (hue > 0.07) & (hue < 0.2) & (value > 0.7))
    )
    found[pale] = np.where(value[pale] > WHITE, WORDS.index("white"), WORDS.index("grey"))
    found[(value < 0.16) | ((value < 0.22) & (saturation < 0.3))] = WORDS.index("black")
    return np.asarray(found, np.intp)


def shares(rgb: NDArray[np.uint8], gains: Array) -> dict[str, float]:
    """The colours of pixels (n, 3) by name, with the share of the pixels that has each; the largest first."""
    values = rgb.astype(np.float64) / 255 * gains
    values = _evenly_lit(values[~_shaded(values)][:: max(1, len(values) // MOST_PIXELS)])
    counts = np.zeros(len(WORDS))
    for weight, turn, gain, cast, full in _SHADES:
        lit = values * gain * (gains / gains.mean()) ** (cast - 1.0)
        high = lit.max(axis=1, keepdims=True)
        words = pixel_words(high - full * (high - lit), turn)
        counts += weight * np.bincount(words, minlength=len(WORDS)) / max(1, len(values))
    return {WORDS[n]: float(counts[n]) for n in np.argsort(-counts, kind="stable") if counts[n] > 0.02}


def _evenly_lit(values: Array) -> Array:
    """The pixels (n, 3) with those of white or grey as bright as their lit ones: a white bowl is not grey on the side
    that is turned from the lamp. What is much darker is of another shade of grey."""
    high = values.max(axis=1)
    pale = np.isin(pixel_words(values), (WORDS.index("white"), WORDS.index("grey")))
    if np.count_nonzero(pale) < max(1.0, PART * len(values)):
        return values
    bright = np.percentile(high[pale], FACING)
    lit = pale & (high > SHADOW * bright)
    factors = bright / np.maximum(high, 1e-3) * np.linspace(*DOUBT, len(values))
    return np.where(lit[:, None], values * factors[:, None], values)


def _shaded(values: Array) -> NDArray[np.bool_]:
    """Which of the coloured pixels (n, 3) lie in a shadow of the object's own: they are darker than others of their
    hue, and their hue is noise. Where hardly any have it, than the object: what is dark beside a white label is no
    shadow of the label."""
    hue, saturation, high = _hsv(values)
    coloured = saturation > COLOURED
    part = (hue * HUE_PARTS).astype(np.intp) % HUE_PARTS
    bright = np.full(HUE_PARTS, np.percentile(high, BRIGHT))
    for n in np.unique(part[coloured]):
        apart = np.abs(part - n)
        near = coloured & (np.minimum(apart, HUE_PARTS - apart) <= 1)
        if np.count_nonzero(near) >= PART * len(values):
            bright[n] = np.percentile(high[near], BRIGHT)
    return np.asarray(coloured & (high < SHADOW * bright[part]))


def main_words(found: dict[str, float]) -> list[str]:
    """The colours that an object is called by, the largest first, at least one."""
    total = sum(found.values()) or 1.0
    ordered = sorted(found, key=lambda word: (-found[word], word))
    return [word for n, word in enumerate(ordered) if n == 0 or found[word] >= PART * total]


def name(rgb: Array) -> str:
    """The everyday name of a colour (3,) in 0..1."""
    return WORDS[int(pixel_words(np.asarray(rgb, np.float64)[None, :3])[0])]
