"""Detection of walls in lidar end points: straight faces, and pairs of them that are two sides of one wall. Pure.

Most walls of a home are along two directions at right angles, some askew (`askew.py`). The faces along a direction
are found in histograms of the points' offsets, each to a fraction of the lidar's noise by the mean of the many points
on it.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from common.floor_plan import Wall
from common.geometry import Array, Rectangle, cell_means
from services.mapping.askew import askew, lies_across

AROUND, NEIGHBOURS, LEAST, FLAT = 0.12, 48, 6, 0.85
"""How far from a point its direction is fitted [m], to how many cells of points at most and at least [count], and how
much longer than wide they must lie [-]. Chosen: ten cells along a wall, and the four rows that noise makes of it."""
TAIL = 0.07
"""Distance [m] from a face within which what else lies along it is its noise, or a skirting board."""
THIN = 0.025
"""Side of the cells whose points are merged [m]: two and a half times the lidar's noise."""
BIN, BAND = 0.01, 0.035
"""Width of the histogram's bins, and distance from a face of the points that count to it [m]: three times the noise."""
GAP, SHORTEST, CORE = 0.40, 0.20, 0.07
"""Gap [m] that ends a face, which is less than a door; length from which it is one, beside a door; and of that the
piece at least whose points have a direction, which the AROUND before either end have not."""
TRIED, TRY, MOST = 3.0, 0.1, 6000
"""Directions that are tried around that of the normals, their step [degrees], and the points that they are tried on
[count]: in 0.1 degrees a wall of 5 m moves by its noise."""
END_GAP = 0.12
"""Gap [m] between two points at the end of a face: what two neighbouring rays leave on a wall some metres away."""
DENSE = 12
"""Points for each metre of a face, at least [count]."""
THICKNESS = (0.04, 0.32)
"""Distances [m] of two opposite faces that are one wall."""
UNSEEN = 0.10
"""Thickness [m] of a wall that is seen from one side only."""
HEIGHT = 2.4
"""Of a wall [m]: no sensor looks so high."""


class Face(NamedTuple):
    """A straight piece along direction `axis` (0 or 1) of the home, `offset` along the other one, from `low` to `high`
    [m]; `side` is +1 where it is seen from beyond its offset, -1 from before it."""

    axis: int
    offset: float
    low: float
    high: float
    side: int


def find_walls(points: Array, eyes: Array, taken: list[Rectangle]) -> list[Wall]:
    """Walls among lidar end points (n, 2) [map] that were seen from `eyes` (n, 2); none of them on `taken` ground."""
    free = np.ones(len(points), bool)
    for r in taken:
        free &= r.signed_distances(points[:, 0], points[:, 1]) > 0.0
    points, eyes, weights = _thinned(points[free], eyes[free])
    if len(points) < LEAST:
        return []
    near = KDTree(points).query(points, min(NEIGHBOURS, len(points)), distance_upper_bound=AROUND)
    normals = _normals(points, eyes, weights, near)
    known = ~np.isnan(normals)
    if not known.any():
        return []
    main = _refined(points[known], weights[known], normals[known], main_direction(normals[known]))
    for across in (main, main + math.pi / 2):
        again = _normals(points, eyes, weights, near, across)
        normals = np.where(np.isnan(normals) & lies_across(again, across), again, normals)
    known = ~np.isnan(normals)
    rest, others = np.ones(len(points), bool), []
    for yaw, on in askew(points, normals, main):
        own = on & known
        others.append((_refined(points[own], weights[own], normals[own], yaw), on))
        rest = rest & ~on
    walls: list[Wall] = []
    for yaw, on in ((main, rest), *others):
        c, s = math.cos(yaw), math.sin(yaw)
        turn = np.array([[c, -s], [s, c]])
        walls += [_wall(w, turn) for w in _paired(_faces(points[on] @ turn, eyes[on] @ turn, normals[on] - yaw))]
    return walls


def main_direction(normals: Array) -> float:
    """The angle [rad] within (-45, 45] degrees by which the home is turned, from the angles (n,) [rad] of normals."""
    mean = complex(np.mean(np.exp(4j * normals)))
    first = math.atan2(mean.imag, mean.real) / 4
    off = np.mod(normals - first + math.pi / 4, math.pi / 2) - math.pi / 4
    near = np.abs(off) < math.radians(10)
    return first + float(np.median(off[near])) if near.any() else first


def _thinned(points: Array, eyes: Array) -> tuple[Array, Array, Array]:
    """The mean of the points (n, 2) of each cell of THIN, where one of them was seen from, and how many they are.

    Of thousands of points on a spot the nearest ones tell their noise and not the wall's direction.
    """
    if not len(points):
        return points, eyes, np.ones(0)
    means, first, count = cell_means(points, THIN)
    return means, eyes[first], count.astype(float)


def _refined(points: Array, weights: Array, normals: Array, yaw: float) -> float:
    """The direction near `yaw` in which the points fall onto the fewest lines."""
    chosen = np.linspace(0, len(points) - 1, min(MOST, len(points))).astype(int)
    points, weights, off = points[chosen], weights[chosen], normals[chosen] - yaw
    across = np.abs(np.mod(off + math.pi / 4, math.pi) - math.pi / 4) < math.pi / 4
    best = (-1.0, yaw)
    for turn in np.radians(np.linspace(-TRIED, TRIED, 2 * round(TRIED / TRY) + 1)):
        c, s = math.cos(yaw + turn), math.sin(yaw + turn)
        score = 0.0
        for own, axis in ((across, (c, s)), (~across, (-s, c))):
            if own.any():
                offsets = points[own] @ np.array(axis)
                score += float(
                    np.square(np.bincount(((offsets - offsets.min()) / BIN).astype(int), weights[own])).sum()
                )
        best = max(best, (score, yaw + float(turn)))
    return best[1]


def _normals(
    points: Array, eyes: Array, weights: Array, near: tuple[Array, Array], across: float | None = None
) -> Array:
    """Direction (n,) [rad] across what each point lies on; nan where that is no line; `near`: distances
    and numbers (n, k) of the points around each, a distance infinite where there are no more.

    Weighted: of a wall that was seen for long the noise has points in many cells, and most of them in the middle ones.
    What was seen from the opposite direction is a thin wall's other side, and so is what was seen from beyond the line
    through a point where walls are known to lie `across` [rad]: both sides may be seen from along the wall.
    """
    there = np.isfinite(near[0])
    found = np.where(there, near[1], 0)
    views = eyes - points
    if across is None:
        there &= np.einsum("ni,nki->nk", views, views[found]) > 0.0
    else:
        beyond = views @ (math.cos(across), math.sin(across)) > 0.0
        there &= beyond[:, None] == beyond[found]
    weight = np.where(there, weights[found], 0.0)
    weight /= weight.sum(axis=1, keepdims=True)
    away = points[found]
    away = away - np.einsum("nk,nki->ni", weight, away)[:, None]
    values, vectors = np.linalg.eigh(np.einsum("nk,nki,nkj->nij", weight, away, away))
    normals = np.arctan2(vectors[:, 1, 0], vectors[:, 0, 0])
    normals[(values[:, 0] > (1.0 - FLAT) * values[:, 1]) | (there.sum(axis=1) < LEAST)] = np.nan
    return np.asarray(normals)


def _faces(points: Array, eyes: Array, normals: Array) -> list[Face]:
    """Faces in the home's own frame; a face along axis 0 has its normal along axis 1."""
    found: list[Face] = []
    for axis in (0, 1):
        across = 1 - axis
        mine = lies_across(normals, across * math.pi / 2)
        side = np.where(eyes[:, across] > points[:, across], 1, -1)
        for sign in (1, -1):
            on = mine & (side == sign)
            faces = _faces_along(points[on, axis], points[on, across], axis, sign)
            whole = (_extended(f, points[:, axis], points[:, across]) for f in faces)
            found += [f for f in whole if f.high - f.low >= SHORTEST]
    return found


def _faces_along(along: Array, across: Array, axis: int, sign: int) -> list[Face]:
    found: list[Face] = []
    left: NDArray[np.bool_] = np.ones(len(along), bool)
    while left.sum() >= DENSE * CORE:
        edges = np.arange(across[left].min() - BIN, across[left].max() + 3 * BIN, BIN)
        count = np.convolve(np.histogram(across[left], edges)[0], np.ones(4), "same")
        if count.max() < DENSE * CORE:
            break
        middle = float(edges[int(np.argmax(count))])
        on = left & (np.abs(across - middle) < BAND)
        middle = float(np.median(across[on]))
        on = left & (np.abs(across - middle) < BAND)
        if not on.any():
            break
        left &= ~on
        beside = left & (np.abs(across - middle) < TAIL)
        order = np.argsort(along[on])
        a, b = along[on][order], across[on][order]
        for run in np.split(np.arange(len(a)), np.nonzero(np.diff(a) > GAP)[0] + 1):
            low, high = float(a[run[0]]), float(a[run[-1]])
            if high - low >= CORE and len(run) >= max(DENSE * (high - low), 3):
                # Each piece at its own offset: two cupboards in a row need not stand in one line.
                found.append(Face(axis, float(np.mean(b[run])), low, high, sign))
                left &= ~(beside & (along > low) & (along < high))
    return found


def _extended(face: Face, along: Array, across: Array) -> Face:
    """The face up to its ends, where corners leave points without a direction."""
    a = np.sort(along[np.abs(across - face.offset) < BAND])
    low, high = np.searchsorted(a, face.low), np.searchsorted(a, face.high, "right") - 1
    while low > 0 and a[low] - a[low - 1] < END_GAP:
        low -= 1
    while high < len(a) - 1 and a[high + 1] - a[high] < END_GAP:
        high += 1
    return face._replace(low=float(a[low]), high=float(a[high]))


def _paired(faces: list[Face]) -> list[tuple[Face, float]]:
    """Each wall as the face in its middle, and its thickness; a face without another side is its wall's front."""
    found: list[tuple[Face, float]] = []
    done: set[int] = set()
    for i, f in enumerate(faces):
        if f.side != 1:
            continue
        for j, g in enumerate(faces):
            if j in done or g.axis != f.axis or g.side != -1:
                continue
            thick, overlap = f.offset - g.offset, min(f.high, g.high) - max(f.low, g.low)
            if THICKNESS[0] < thick < THICKNESS[1] and overlap > 0.5 * min(f.high - f.low, g.high - g.low):
                low, high = min(f.low, g.low), max(f.high, g.high)
                found.append((Face(f.axis, (f.offset + g.offset) / 2, low, high, 0), thick))
                done |= {j}
                done.add(-1 - i)
    for i, f in enumerate(faces):
        if i not in done and -1 - i not in done:
            found.append((f._replace(offset=f.offset - f.side * UNSEEN / 2), UNSEEN))
    return found


def _wall(found: tuple[Face, float], turn: Array) -> Wall:
    """A wall of the floor plan, whose ends are half a thickness before what its footprint reaches."""
    face, thickness = found
    inset = min(thickness / 2, (face.high - face.low) / 2 - 0.01)
    ends = []
    for along in (face.low + inset, face.high - inset):
        own = np.array((along, face.offset) if face.axis == 0 else (face.offset, along))
        x, y = (turn @ own).tolist()
        ends.append((round(x, 4), round(y, 4)))
    return Wall(start=ends[0], end=ends[1], thickness=round(thickness, 4), height=HEIGHT)
