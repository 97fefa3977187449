"""Whether a surface runs on across the line at which its colour changes: print on one object, not two. Pure."""

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from services.perception.segments.segment import Segment, renumbered
from services.perception.views.view import View

PATCH = 0.01
"""How far [m] around a point of the line the surface on its two sides is looked at. Chosen: less than a finger."""
BENT, OFF = 0.35, 0.5
"""How far the middle of one side may be off the plane of the other, by the distance of the two middles and by the noise
of points. Chosen: a bottle of 44 mm bends by .25 within a patch, a box in the corner of another by .7."""
RUNS_ON = 0.75
"""Share of the line at which the surface has to run on. Chosen: two boxes of one depth and unlike heights have half."""
CLEAR = 0.0025
"""Noise [m] of points from which a bend cannot be told: that at 1.3 m."""
LEAST, MOST = 5, 60
"""Points on one side of a patch, at least, and patches that are looked at, at most."""


def unseamed(view: View, segment: Segment, cut: NDArray[np.intp], noise: float) -> NDArray[np.intp] | None:
    """The number (n,) of the piece of each pixel of `cut`, those as one whose surface runs on; None if all does.

    `noise` [m]: of points along the line of sight.
    """
    if noise > CLEAR:
        return cut
    joined = np.arange(int(cut.max()) + 1)
    for (a, b), share in _running_on(view, segment, cut, noise).items():
        if share >= RUNS_ON:
            joined[joined == joined[b]] = joined[a]
    return renumbered(joined[cut])


def _running_on(view: View, segment: Segment, cut: NDArray[np.intp], noise: float) -> dict[tuple[int, int], float]:
    """Share of the line between two pieces at which the surface runs on, for each pair of neighbours."""
    top, left = int(segment.rows.min()), int(segment.columns.min())
    rows, columns = segment.rows - top, segment.columns - left
    numbers = np.full((int(rows.max()) + 1, int(columns.max()) + 1), -1)
    numbers[rows, columns] = cut
    points = np.full((*numbers.shape, 3), np.nan)
    points[rows, columns] = view.points[segment.rows, segment.columns]
    far = float(np.median(np.linalg.norm(segment.points - view.position, axis=1)))
    half = max(2, round(PATCH * view.focal[0] / far))
    found: dict[tuple[int, int], list[bool]] = {}
    seams = _seams(numbers)
    for row, column, a, b in seams[:: max(1, len(seams) // MOST)]:
        window = slice(max(0, row - half), row + half + 1), slice(max(0, column - half), column + half + 1)
        sides = [points[window][numbers[window] == n] for n in (a, b)]
        if min(map(len, sides)) >= LEAST:
            found.setdefault((min(a, b), max(a, b)), []).append(_runs_on(sides[0], sides[1], noise))
    return {pair: float(np.mean(answers)) for pair, answers in found.items()}


def _seams(numbers: NDArray[np.intp]) -> list[tuple[int, int, int, int]]:
    """Where two pieces meet: row, column, and the numbers of the two."""
    found = []
    for down, aside in ((0, 1), (1, 0)):
        first = numbers[: numbers.shape[0] - down, : numbers.shape[1] - aside]
        second = numbers[down:, aside:]
        for row, column in zip(*np.nonzero((first != second) & (first >= 0) & (second >= 0)), strict=True):
            found.append((int(row), int(column), int(first[row, column]), int(second[row, column])))
    return sorted(found)


def _runs_on(a: Array, b: Array, noise: float) -> bool:
    """The middle of each side lies in the plane of the other."""
    between = b.mean(axis=0) - a.mean(axis=0)
    most = BENT * float(np.linalg.norm(between)) + OFF * noise
    return all(abs(float(between @ np.linalg.eigh(np.cov(side.T))[1][:, 0])) < most for side in (a, b))
