"""Directions of walls that are not at right angles to the rest of a home, from lidar end points. Pure.

Lines are taken one by one, the one with the most points first, as in Duda and Hart, "Use of the Hough transformation to
detect lines and curves in pictures", 1972: a wall that is a little askew would else be a stair of short straight ones.
"""

import math

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, Mask

STEP, NORMAL = math.radians(1.0), math.radians(12)
"""Step of the directions that are tried, and turn of a point's own direction against its line's [rad]; chosen: the
noise over some 15 cm of wall."""
BIN, BAND, TAIL = 0.01, 0.035, 0.07
"""Width of the histogram's bins, and distances [m] from a line of the points that count to it and of all its noise."""
END, GAP, LONG, LEAST = 0.12, 0.20, 1.0, 12
"""How far beyond a line's last point its corner may be, where points have no direction, the gap that ends it and the
length from which one that is askew is a wall and no furniture [m], and the least points of one [count]."""
STRAIGHT, ALIKE = math.radians(2.0), math.radians(2.0)
"""Turn against the home's directions up to which a line is not askew, and that of two lines in one direction [rad]."""


def askew(points: Array, normals: Array, yaw: float) -> list[tuple[float, Mask]]:
    """Further directions [rad] of walls of a home that is turned by `yaw`, and which of the points (n, 2) lie on them.

    `normals` (n,) [rad] are across what each point lies on, nan where that is no line.
    """
    found: list[tuple[float, Mask]] = []
    left: Mask = ~np.isnan(normals)
    angles = yaw + np.arange(-math.pi / 2, math.pi / 2, STEP)
    lines = [_longest(points, left & lies_across(normals, a), a) for a in angles]
    while True:
        # Lines only lose points: one that lost none is the longest if no other was longer.
        first = max(range(len(lines)), key=lambda n: len(lines[n][2]))
        angle, offset, run = lines[first]
        if len(run) < LEAST:
            break
        if not left[run].all():
            lines[first] = _longest(points, left & lies_across(normals, angle), angle)
            continue
        across, along = points @ _unit(angle), points @ _unit(angle + math.pi / 2)
        low, high = along[run].min() - END, along[run].max() + END
        on = (np.abs(across - offset) < TAIL) & (along > low) & (along < high)
        left[run] = False
        left &= ~on
        if abs(math.remainder(angle - yaw, math.pi / 2)) > STRAIGHT and high - low > LONG + 2 * END:
            found.append((angle, on))
    return _grouped(found)


def _unit(angle: float) -> Array:
    return np.array([math.cos(angle), math.sin(angle)])


def lies_across(normals: Array, angle: float) -> Mask:
    """Which normals are those of a line whose own is `angle`, from either side."""
    return np.abs(np.mod(normals - angle + math.pi / 2, math.pi) - math.pi / 2) < NORMAL


def _longest(points: Array, of: Mask, angle: float) -> tuple[float, float, NDArray[np.intp]]:
    """The direction again, the offset along it [m] and the points (indices) of the line with the most of them."""
    index = np.nonzero(of)[0]
    if len(index) < LEAST:
        return angle, 0.0, index[:0]
    across, along = points[index] @ _unit(angle), points[index] @ _unit(angle + math.pi / 2)
    edges = np.arange(across.min() - BAND, across.max() + BAND + BIN, BIN)
    count = np.convolve(np.histogram(across, edges)[0], np.ones(round(2 * BAND / BIN)), "same")
    offset = float(edges[int(np.argmax(count))])
    on = np.nonzero(np.abs(across - offset) < BAND)[0]
    on = on[np.argsort(along[on])]
    runs = np.split(on, np.nonzero(np.diff(along[on]) > GAP)[0] + 1)
    return angle, offset, index[max(runs, key=len)]


def _grouped(lines: list[tuple[float, Mask]]) -> list[tuple[float, Mask]]:
    """Lines in one direction together: they may be the two sides of a wall."""
    found: list[tuple[float, Mask]] = []
    for angle, on in lines:
        for n, (other, mask) in enumerate(found):
            if abs(math.remainder(angle - other, math.pi / 2)) < ALIKE:
                found[n] = other, mask | on
                break
        else:
            found.append((angle, on))
    return found
