"""Objects that touch: one segment into the pieces that are objects of their own. Pure.

A segment stays whole when one shape explains it, whatever is printed on it. Otherwise pieces of one colour each, and
pieces on both sides of a valley, are tried: what they are must be explained much better one by one, and none of them
may hang in the air.
"""

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Array, Rectangle
from services.perception.segments.air import hangs
from services.perception.segments.joints import jointed
from services.perception.segments.seams import unseamed
from services.perception.segments.segment import Segment
from services.perception.segments.segmentation import MAX_EXTENT, MIN_PIXELS, extent
from services.perception.shapes.measurement import Measurement
from services.perception.shapes.primitives import quantile
from services.perception.unlisted import measured, noise_of
from services.perception.views.view import View

CHROMA = 0.05
"""Difference of chromaticity (red and green by the sum) of two pixels from which a colour ends between them. Chosen:
five times the noise of a pixel, smoothed, in a lit room."""
BRIGHT = 0.30
"""Difference of brightness, by that of both, from which a colour ends: black beside white has no other."""
LEAST_SHARE = 0.08
"""Share of the segment's pixels that a piece has at least."""
MOST_PIECES, IN_A_CROWD = 4, 9
"""Patches of colour beyond which they are print on one object, and beyond which they are no crowd of objects."""
GAIN, NOISE_GAIN = 0.0008, 0.3
"""How much less [m], plus that of the noise, the mean distance from the shapes must be for pieces to be objects."""
FINE, FINE_NOISE = 0.0006, 0.45
"""Mean distance [m] from the shape, plus that of the noise, below which pieces would explain nothing better."""
BESIDE, APART = 0.2, 0.75
"""Share of that gain which is enough for pieces that stand beside each other, and how far apart they do, by their half
widths."""
EXPLAINED = 0.6
"""Mean distance from a part's shape, by that of the whole's, up to which the part is an object of its own."""
HIGH = 0.03
"""Height [m] over the surface from which a piece begins that stands on another one. Chosen: a brick's."""
OVER = 0.01
"""How far [m] beyond another's shape, whose far side is hidden, the middle of a piece may be that stands on it."""
VALLEY = 0.75
"""Height on the line between two pieces, by that of the lower one, below which there is a valley."""
BAND, BRIDGE = 0.006, 0.01
"""Half width [m] of that line, and of what is looked through under it."""
LONGEST, WIDEST = 0.42, 0.12
"""Extents [m] on the floor plan up to which what is too long for a vessel is one object: a ladle, a rolling pin."""
SPLITS = 2
"""How often pieces are cut again."""


@dataclass(frozen=True)
class Piece:
    """A segment and what was measured of it."""

    segment: Segment
    shape: Measurement


def pieces(view: View, segment: Segment) -> list[Piece]:
    """The objects that a segment consists of; none where it is too wide for one and nothing parts it, but a tool."""
    if extent(segment) >= MAX_EXTENT:
        crowd = [p for part in _crowd(view, segment) for p in pieces(view, part)]
        return crowd or [p for p in [Piece(segment, measured(view, segment))] if _is_long(p.shape)]
    return _pieces(view, Piece(segment, measured(view, segment)), SPLITS)


def _is_long(shape: Measurement) -> bool:
    """It is as long as the longest tool, and no wider."""
    width, length = sorted(shape.size[:2])
    return length < LONGEST and width < WIDEST


def _crowd(view: View, segment: Segment) -> list[Segment]:
    """The parts of a segment that is too wide for one object, by their colours, else by the valley between them."""
    cut = by_colour(view, segment, IN_A_CROWD)
    if cut is None:
        cut = by_valley(view, segment)
    return _cut(segment, cut) if cut is not None else []


def _pieces(view: View, whole: Piece, again: int) -> list[Piece]:
    segment = whole.segment
    noise = noise_of(view, segment)
    if again == 0 or len(segment.rows) < 2 * MIN_PIXELS or whole.shape.residual < FINE + FINE_NOISE * noise:
        return [whole]
    coloured = by_colour(view, segment)
    for cut in (
        unseamed(view, segment, coloured, noise) if coloured is not None else None,
        by_valley(view, segment),
    ):
        if cut is None or (cut := jointed(view, segment, cut, noise)) is None:
            continue
        cuts = _cut(segment, cut)
        hanging = np.isin(cut, [n for n, s in enumerate(cuts) if hangs(view, s.points, s.surface.height)])
        if hanging.any():
            # It is no object by itself, and no part of the body: a handle, a spout.
            beside = Piece(segment, measured(view, segment, hanging))
            whole = beside if beside.shape.residual < whole.shape.residual else whole
            continue
        parts = [Piece(s, measured(view, s)) for s in cuts]
        if any(_stands_on(p, parts) for p in parts):
            continue
        share = np.array([len(p.segment.rows) for p in parts]) / len(segment.rows)
        residual = float(share @ [p.shape.residual for p in parts])
        shaped = all(p.shape.family != "irregular" for p in parts)
        ease = BESIDE if shaped and _beside(parts) else 1.0
        better = whole.shape.residual - residual > ease * (GAIN + NOISE_GAIN * noise)
        if better or (whole.shape.family == "irregular" and shaped) or _mostly(whole, parts):
            return [found for p in parts for found in _pieces(view, p, again - 1)]
    return [whole]


def _stands_on(piece: Piece, parts: list[Piece]) -> bool:
    """A piece begins high over the surface, with its middle over another one: a candle in its holder, a cap.

    What is behind another one shows no more of its lower part, but is not over its shape.
    """
    if quantile(piece.segment.points[:, 2], 0.05) - piece.segment.surface.height < HIGH:
        return False
    shapes = (p.shape for p in parts if p is not piece)
    outlines = (Rectangle(s.x, s.y, s.size[0], s.size[1], s.yaw) for s in shapes)
    return any(outline.contains(piece.shape.x, piece.shape.y, OVER) for outline in outlines)


def _mostly(whole: Piece, parts: list[Piece]) -> bool:
    """Most of what no shape explains as a whole is of parts with shapes of their own, whatever the rest is."""
    better = [p for p in parts if p.shape.family != "irregular" and p.shape.residual < EXPLAINED * whole.shape.residual]
    most = sum(len(p.segment.rows) for p in better) >= len(whole.segment.rows) / 2
    return len(better) > 1 and most and _beside(parts)


def _beside(parts: list[Piece]) -> bool:
    """The shapes of the parts stand beside each other: what is printed on a thing has its place."""

    def half(p: Piece) -> float:
        return (p.shape.size[0] + p.shape.size[1]) / 4

    return all(
        math.hypot(a.shape.x - b.shape.x, a.shape.y - b.shape.y) > APART * (half(a) + half(b))
        for a, b in itertools.combinations(parts, 2)
    )


def _cut(segment: Segment, cut: NDArray[np.intp]) -> list[Segment]:
    """The parts of a segment by the number (n,) of each pixel's; a side on which another part lies is hidden or not,
    which is not known: the segment's own word is kept."""
    found = []
    for n in range(int(cut.max()) + 1):
        own = cut == n
        found.append(
            replace(
                segment,
                rows=segment.rows[own],
                columns=segment.columns[own],
                points=segment.points[own],
                dark=segment.dark[:0],
            )
        )
    return found


def by_colour(view: View, segment: Segment, most: int = MOST_PIECES) -> NDArray[np.intp] | None:
    """Number (n,) of the patch of one colour that each pixel belongs to; None if there is only one, or over `most`."""
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
    large = np.flatnonzero(counts >= max(MIN_PIXELS, LEAST_SHARE * len(segment.rows)))
    if not 2 <= len(large) <= most:
        return None
    # What belongs to no large patch joins the nearest in the picture.
    numbered = np.full(shape, -1)
    for n, label in enumerate(large):
        numbered[labels == label] = n
    nearest = ndimage.distance_transform_edt(numbered < 0, return_distances=False, return_indices=True)
    found: NDArray[np.intp] = numbered[tuple(nearest)][segment.rows - top, segment.columns - left].astype(np.intp)
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


def by_valley(view: View, segment: Segment) -> NDArray[np.intp] | None:
    """Number (n,) of the side of a valley, seen from above, on which each point lies; None if there is none, or if a
    bridge hangs over it.
    """
    plan = segment.points[:, :2]
    middle = plan.mean(axis=0)
    axis = np.linalg.eigh(np.cov((plan - middle).T))[1][:, 1]
    along = (plan - middle) @ axis
    height = segment.points[:, 2] - segment.surface.height
    low, high = quantile(along, 0.15), quantile(along, 0.85)
    if high - low < 4 * BAND:
        return None
    best, depth = 0.0, 1.0
    for at in np.linspace(low, high, 13):
        before, after = along < at, along >= at
        tops = [quantile(height[side], 0.95) for side in (before, after)]
        band = height[np.abs(along - at) < BAND]
        ratio = (quantile(band, 0.95) if len(band) > 3 else 0.0) / max(min(tops), 1e-3)
        if ratio < depth:
            best, depth = float(at), ratio
    side = (along >= best).astype(np.intp)
    few = min(np.count_nonzero(side), np.count_nonzero(side == 0))
    if depth >= VALLEY or few < max(MIN_PIXELS, LEAST_SHARE * len(side)):
        return None
    return None if hangs(view, segment.points[np.abs(along - best) < BRIDGE], segment.surface.height) else side
