"""Whether pieces hang together end to end: a blade and its handle are one tool, whatever their colours. Pure."""

import math
from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from services.perception.segments.segment import Segment, renumbered
from services.perception.views.view import View

LOW = 0.045
"""Height [m] over the surface up to which pieces lie there: a ladle, a brush, no block. Chosen: what stands beside
another stands higher."""
SHORT = 0.3
"""Share of the smaller piece's outline at which they meet, up to which that is a joint. Chosen: a handle meets its
blade at a tenth, a pen the book that it lies on all round."""
THREAD = 0.05
"""The same, up to which it is one whatever the step: what hides a part of another does so along a side."""
STEP, STEP_NOISE = 0.006, 2.0
"""Step of depth [m] at that line, plus that of noise, up to which one goes on in the other."""
RINGED, RIM = 0.6, 2
"""Share of the band of that width [pixels] around a piece from which it is within another that no shape explains and
stands over it, and is of it: the lens of a magnifying glass. Chosen: the far side of its rim is hidden."""
STANDS, NARROW, MOSTLY = 0.07, 0.35, 0.6
"""Height [m] from which pieces stand beside each other, share of the smaller one's outline at which they meet, up to
which that is a joint of what is lower, and the share of it without such a step that makes them one: a bulb and its cap.
Chosen: a lying bulb, a whisk; what stands before another hides more of it, or steps down to it."""
CARRIED = 0.25
"""Share of that line without such a step that makes a joint, and that a piece which hangs in the air has with what
carries it: the handle of a pan, of a rolling pin."""
ALL_ALONG = 0.75
"""Share of that line on which there is no such step, from which a piece that has no shape of its own belongs to the
other. Chosen: a wooden handle that runs round the red of its bat does; what lies on another or behind it steps down."""


def jointed(
    view: View,
    segment: Segment,
    cut: NDArray[np.intp],
    noise: float,
    shapeless: Collection[int] = (),
    crowd: bool = False,
    hanging: Collection[int] = (),
) -> NDArray[np.intp] | None:
    """The number (n,) of the piece of each pixel of `cut`, those that meet at a joint as one; None if all do.

    `noise` [m]: of points along the line of sight; `shapeless`: pieces that no shape explains; `crowd`: they are of
    several objects, of which only those that lie are joined; `hanging`: pieces that hang in the air, each of which
    belongs to what it meets without a step.
    """
    numbers = np.full((int(np.ptp(segment.rows)) + 3, int(np.ptp(segment.columns)) + 3), -1)
    rows, columns = segment.rows - segment.rows.min() + 1, segment.columns - segment.columns.min() + 1
    numbers[rows, columns] = cut
    far = np.zeros(numbers.shape, np.float32)
    far[rows, columns] = view.depth[segment.rows, segment.columns]
    sides = [(numbers[:-1], numbers[1:], far[:-1], far[1:]), (numbers[:, :-1], numbers[:, 1:], far[:, :-1], far[:, 1:])]
    first, second, one, other = (np.concatenate([side[i].ravel() for side in sides]) for i in range(4))
    edge = first != second
    first, second, step = first[edge], second[edge], np.abs(one - other)[edge]
    outline = [np.count_nonzero((first == n) | (second == n)) for n in range(int(cut.max()) + 1)]
    names = np.arange(len(outline))
    tops = [float(np.percentile(segment.points[cut == n, 2], 90)) for n in names]
    for a in range(len(outline)):
        for b in range(a):
            meet = step[((first == a) & (second == b)) | ((first == b) & (second == a))]
            share = len(meet) / min(outline[a], outline[b])
            level = float(np.mean(meet < STEP + STEP_NOISE * noise)) if len(meet) else 0.0
            if {a, b} & {*hanging} and level >= CARRIED:
                names[names == names[a]] = names[b]
                continue
            high = max(tops[a], tops[b]) - segment.surface.height
            if high > LOW:
                if high < STANDS and not crowd and share < NARROW and level >= MOSTLY:
                    names[names == names[a]] = names[b]
                continue
            some = CARRIED if share < SHORT else ALL_ALONG if {a, b} & {*shapeless} else math.inf
            inner, outer = sorted((a, b), key=lambda n: outline[n])
            ringed = outer in shapeless and tops[inner] < tops[outer] and _around(numbers, inner, outer) > RINGED
            if level >= some or ringed or 0 < share < THREAD:
                names[names == names[a]] = names[b]
    return renumbered(names[cut])


def _around(numbers: NDArray[np.intp], inner: int, outer: int) -> float:
    """Share of the band around one piece that is of another; between the two depth may be missing."""
    own = numbers == inner
    band = ndimage.binary_dilation(own, iterations=RIM) & ~own
    return float(np.mean(ndimage.binary_dilation(numbers == outer, iterations=RIM)[band]))
