"""Objects that touch: one segment into the pieces that are objects of their own. Pure.

A segment stays whole when one shape explains it, whatever is printed on it. Otherwise pieces of one colour each,
pieces on both sides of a valley, and pieces on both sides of a jump of depth are tried: what they are must be explained
much better one by one, and none of them may hang in the air.
"""

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from common.geometry import Point, Rectangle
from services.perception.segments.air import hangs
from services.perception.segments.colours import FEW_IN_A_CROWD, IN_A_CROWD, LEAST_SHARE, by_colour
from services.perception.segments.in_line import LONGEST, WIDEST, end_to_end
from services.perception.segments.joints import jointed
from services.perception.segments.parts import between_jumps
from services.perception.segments.seams import unseamed
from services.perception.segments.segment import Segment, covered, spread
from services.perception.segments.segmentation import MAX_EXTENT, MIN_PIXELS, extent
from services.perception.shapes.measurement import Measurement
from services.perception.shapes.primitives import quantile
from services.perception.unlisted import measured, noise_of
from services.perception.views.view import View

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
LOWEST, EQUATOR = 0.05, 0.4
"""Quantile of the heights that counts as the lowest, and its height, by that of a ball, up to which the ball is seen to
below its equator: it lies on the surface, whatever stands before the rest."""
VALLEY = 0.75
"""Height on the line between two pieces, by that of the lower one, below which there is a valley."""
BAND, BRIDGE = 0.006, 0.01
"""Half width [m] of that line, and of what is looked through under it."""
HANDLED = 0.5
"""Extent [m] on the floor plan up to which what carries a handle that hangs in the air is one: a pan, a rolling pin."""
SLIMMEST = 3.0
"""Length by width of the shortest tool of two colours. Chosen: a whisk has 4, two things beside each other 2."""
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
        whole, noise = Piece(segment, measured(view, segment)), noise_of(view, segment)
        long = _is_long(whole.shape)
        cut, hanging = _crowd(view, segment, noise, long)
        if cut is None and hanging.any():
            return [_with_handle(view, whole, hanging)]
        crowd = [p for part in _cut(view, segment, cut) for p in pieces(view, part)] if cut is not None else []
        return crowd or [whole] * long
    return _pieces(view, Piece(segment, measured(view, segment)), SPLITS)


def _is_long(shape: Measurement) -> bool:
    """It is as long as the longest tool, and no wider."""
    width, length = sorted(shape.size[:2])
    return length < LONGEST and width < WIDEST


def _crowd(view: View, segment: Segment, noise: float, long: bool) -> tuple[NDArray[np.intp] | None, NDArray[np.bool_]]:
    """Number (n,) of the part of each pixel of a segment that is too wide for one object but a `long` one, or one with
    a handle: by colours, those that hang together as one, else by the valley between them, else by the smallest
    patches; None where nothing parts it. And which pixels (n,) hang in the air."""
    cut, hanging = by_colour(view, segment, IN_A_CROWD), np.zeros(len(segment.rows), bool)
    if cut is not None:
        in_air = [n for n, part in enumerate(_cut(view, segment, cut)) if _in_air(view, part, noise)]
        joint = jointed(view, segment, cut, noise, crowd=not long, hanging=in_air)
        hanging = np.isin(cut, in_air)
        body = segment.points[~hanging, :2]
        handled = hanging.any() and extent(segment) < HANDLED and np.ptp(body, axis=0).max() < MAX_EXTENT
        if (joint is None and (long or handled)) or (long and _in_line(segment, cut)):
            return None, hanging
        cut = cut if joint is None else joint
    if cut is None:
        cut = by_valley(view, segment)
    if cut is None and not long:
        cut = by_colour(view, segment, IN_A_CROWD, FEW_IN_A_CROWD)
    return cut, hanging


def _pieces(view: View, whole: Piece, again: int) -> list[Piece]:
    segment = whole.segment
    noise = noise_of(view, segment)
    if again == 0 or len(segment.rows) < 2 * MIN_PIXELS or whole.shape.residual < FINE + FINE_NOISE * noise:
        return [whole]
    coloured = by_colour(view, segment)
    if coloured is not None:
        coloured = unseamed(view, segment, coloured, noise)
        slim = SLIMMEST * min(whole.shape.size[:2]) < max(whole.shape.size[:2])
        if coloured is not None and slim and jointed(view, segment, coloured, noise) is None:
            # The waist between a blade and its handle parts them no more than their colours do.
            return [whole]
    for cut in (coloured, by_valley(view, segment), by_jump(view, segment)):
        if cut is None or _in_line(segment, cut) or (cut := jointed(view, segment, cut, noise)) is None:
            continue
        cuts = [Piece(s, measured(view, s)) for s in _cut(view, segment, cut)]
        hanging = np.isin(cut, [n for n, piece in enumerate(cuts) if _hangs(view, piece, noise)])
        if hanging.any():
            # It is no object by itself, and no part of the body: a handle, a spout.
            whole = _with_handle(view, whole, hanging)
            continue
        parts = _level_joined(view, segment, cut, cuts)
        if len(parts) < 2 or any(_stands_on(p, parts) for p in parts):
            continue
        share = np.array([len(p.segment.rows) for p in parts]) / len(segment.rows)
        residual = float(share @ [p.shape.residual for p in parts])
        shaped = all(p.shape.family != "irregular" for p in parts)
        ease = BESIDE if shaped and _beside(parts) else 1.0
        better = whole.shape.residual - residual > ease * (GAIN + NOISE_GAIN * noise)
        if better or (whole.shape.family == "irregular" and shaped) or _mostly(whole, parts):
            return [found for p in parts for found in _pieces(view, p, again - 1)]
    return [whole]


def _level_joined(view: View, segment: Segment, cut: NDArray[np.intp], parts: list[Piece]) -> list[Piece]:
    """The parts of a cut, those that no shape explains together with what they are level with."""
    noise = noise_of(view, segment)
    shapeless = [n for n, p in enumerate(parts) if not _explained(p, noise)]
    joint = jointed(view, segment, cut, noise, shapeless) if shapeless else cut
    if joint is None or int(joint.max()) + 1 == len(parts):
        return [] if joint is None else parts
    return [Piece(s, measured(view, s)) for s in _cut(view, segment, joint)]


def _in_line(segment: Segment, cut: NDArray[np.intp]) -> bool:
    """The pieces of a cut (n,) lie end to end: they are a tool's."""
    over = segment.points - (0.0, 0.0, segment.surface.height)
    return end_to_end([over[cut == n] for n in range(int(cut.max()) + 1)])


def _with_handle(view: View, whole: Piece, hanging: NDArray[np.bool_]) -> Piece:
    """An object of which some pixels (n,) hang beside its body, if that explains it better."""
    found = Piece(whole.segment, measured(view, whole.segment, hanging))
    return found if found.shape.residual < whole.shape.residual else whole


def _in_air(view: View, segment: Segment, noise: float) -> bool:
    """What was not measured yet hangs in the air; what does not at first sight need not be."""
    hanging = hangs(view, segment.points, segment.surface.height)
    return hanging and not _curves_in(Piece(segment, measured(view, segment)), noise)


def _hangs(view: View, piece: Piece, noise: float) -> bool:
    """A piece hangs in the air, and is no ball on the surface."""
    return not _curves_in(piece, noise) and hangs(view, piece.segment.points, piece.segment.surface.height)


def _curves_in(piece: Piece, noise: float) -> bool:
    """A piece is a ball on the surface, under which one looks as it curves in."""
    low = quantile(piece.segment.points[:, 2], LOWEST) - piece.segment.surface.height
    return piece.shape.family == "ball" and _explained(piece, noise) and low < EQUATOR * piece.shape.size[2]


def _explained(piece: Piece, noise: float) -> bool:
    return piece.shape.family != "irregular" and piece.shape.residual < FINE + FINE_NOISE * noise


def _stands_on(piece: Piece, parts: list[Piece]) -> bool:
    """A piece begins high over the surface, with its middle over another one: a candle in its holder, a cap.

    What is behind another one shows no more of its lower part, but is not over its shape.
    """
    if quantile(piece.segment.points[:, 2], LOWEST) - piece.segment.surface.height < HIGH:
        return False
    middle = piece.shape.x, piece.shape.y
    return any(_holds(p, middle, sum(piece.shape.size[:2]) / 4) for p in parts if p is not piece)


def _holds(piece: Piece, middle: Point, radius: float) -> bool:
    """A place on the floor plan is over a piece; of one without a shape there are points within `radius` [m] of it."""
    s = piece.shape
    if not Rectangle(s.x, s.y, s.size[0], s.size[1], s.yaw).contains(*middle, OVER):
        return False
    near = np.hypot(*(piece.segment.points[:, :2] - middle).T) < radius
    return s.family != "irregular" or int(np.count_nonzero(near)) >= MIN_PIXELS


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


def _cut(view: View, segment: Segment, cut: NDArray[np.intp]) -> list[Segment]:
    """The parts of a segment by the number (n,) of each pixel's; whether what is nearer hides a side of one is seen."""
    found = []
    nobody = np.zeros(view.shape, bool)
    for n in range(int(cut.max()) + 1):
        own = cut == n
        rows, columns = segment.rows[own], segment.columns[own]
        some, left, right = covered(view, rows, columns, nobody)
        found.append(
            replace(
                segment,
                rows=rows,
                columns=columns,
                points=segment.points[own],
                cut=segment.cut or some or left or right,
                ends=(segment.ends[0] and not right, segment.ends[1] and not left),
                dark=segment.dark[:0],
            )
        )
    return found


def by_jump(view: View, segment: Segment) -> NDArray[np.intp] | None:
    """Number (n,) of the part of each pixel where the depth jumps within a segment: one thing of its colour behind
    another, of which the picture shows one; None if it does not jump.
    """
    found = between_jumps(view, segment.rows, segment.columns, max(MIN_PIXELS, int(LEAST_SHARE * len(segment.rows))))
    return spread(segment, found) if len(found) > 1 else None


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
