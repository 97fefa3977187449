"""The whole surface of an object from the part that was seen: completed by the symmetry of its shape family."""

import math
from collections.abc import Callable

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from common.geometry import Array, yaw_matrix
from services.manipulation.grasps.slices import slices
from services.manipulation.grasps.target import Target

SPACING = 0.004
"""Distance [m] between neighbouring points of a completed surface: a fifth of a pad's width."""
GAP = 0.009
"""Half the widest gap [m] between points that were seen which is taken for surface as well: points are 5 to 7 mm apart,
and pixels at edges are missing."""
BAND = 0.010
"""Height [m] of the bands in which the radius of a round object is measured: each holds a dozen points."""
WALL = 0.004
"""How far [m] within its outer wall, and below its rim, what was seen of a vessel is its inside. Chosen: three times
the noise of depth at arm's length."""
UPRIGHT, UPRIGHT_BY = 0.05, 0.7
"""Height [m], and by the lesser of the level extents, from which something irregular is seen from its front."""
FRONT = 0.5
"""Share of what was seen that lies below its top from which that is of its front."""
UPPER, THINNER = 8, 0.012
"""Points on the upper face of a box from which it counts as seen, and how much thinner [m] than its extents what was
seen of it must be that these do not count: more than points 7 mm apart leave out on either side."""


def surface(target: Target) -> Array:
    """Points (n, 3) [m] on the surface of an object in the base frame, `SPACING` apart.

    What is round is turned about its axis with the radius that was seen at each height; a box and a ball are what was
    measured of them; what is irregular and seen from its front is completed slice by slice; of anything else what was
    seen from above is taken to reach down to what it rests on.
    """
    return np.array(target.position) + _maker(target)(target) @ yaw_matrix(target.yaw).T


def _maker(target: Target) -> Callable[[Target], Array]:
    if target.family in ("round", "bowl") or (target.lies and target.family == "long"):
        return _turned
    if target.family == "ball":
        return _ball
    if target.points is None or (target.family == "box" and not _thinner(target)):
        return _box
    # Of a box whose top was seen that tells how deep it is.
    return _slices if target.family == "irregular" and _stands_up(target) else _columns


def _stands_up(target: Target) -> bool:
    """One sees more of its front than of what is on top."""
    seen = own_points(target)
    front = float(np.mean(seen[:, 2] < target.size[2] / 2 - BAND)) if len(seen) else 0.0
    tall = target.size[2] > max(UPRIGHT, UPRIGHT_BY * min(target.size[:2]))
    return not target.lies and tall and front > FRONT


def guessed_along(target: Target) -> Array | None:
    """The level direction (3,) in the base frame along which the extents of an object are a guess, since only its front
    was seen; None where the shape tells its far side, or that was seen from above."""
    if target.points is None or target.family != "irregular" or not _stands_up(target):
        return None
    away = np.array([*target.position[:2], 0.0])
    found: Array = away / np.linalg.norm(away)
    return found


def _slices(target: Target) -> Array:
    found = slices(own_points(target), away(target), target.size[2], SPACING)
    return found if len(found) else _box(target)


def _thinner(target: Target) -> bool:
    """What was seen of a box, its upper face included, is thinner than its extents, which then are a guess."""
    seen, half = own_points(target), np.array(target.size) / 2
    upper = bool(np.count_nonzero(seen[:, 2] > half[2] - BAND) >= UPPER)
    return upper and bool((np.ptp(seen[:, :2], axis=0) < 2 * half[:2] - THINNER).any())


def own_points(target: Target) -> Array:
    """What was seen (n, 3), along the object's own axes; empty when nothing was."""
    return np.empty((0, 3)) if target.points is None else target.points @ yaw_matrix(target.yaw)


def _steps(low: float, high: float) -> Array:
    return np.linspace(low, high, max(2, 1 + math.ceil((high - low) / SPACING)))


def _turned(target: Target) -> Array:
    """A surface of revolution: about the vertical, or about its own x when it lies."""
    seen = own_points(target)
    if target.lies:
        seen, (length, *across) = seen[:, [1, 2, 0]], target.size
    else:
        across, length = list(target.size[:2]), target.size[2]
    heights = _steps(-length / 2, length / 2)
    radii = profile(seen, heights, max(across) / 2)
    inside = _inside(seen, heights, radii) if target.family == "bowl" and not target.lies else np.empty((0, 2))
    mouth = min(float(inside[:, 0].max()), radii[-1]) if len(inside) else 0.0
    flat = [(r, heights[0]) for r in _steps(0.0, radii[0])] + [(r, heights[-1]) for r in _steps(mouth, radii[-1])]
    walls = zip(radii, heights, strict=True)
    found = np.concatenate([_ring(float(radius), float(height)) for radius, height in (*walls, *flat, *inside)])
    return found[:, [2, 0, 1]] if target.lies else found


def away(target: Target) -> Array:
    """The level direction (2,) from the robot to an object, along the object's own axes."""
    at = np.array(target.position[:2])
    found: Array = at @ yaw_matrix(target.yaw)[:2, :2] / np.linalg.norm(at)
    return found


def _inside(seen: Array, heights: Array, radii: Array) -> Array:
    """Radius and height (n, 2) [m] of the inside of a vessel: what was seen well within its wall and below its rim."""
    radius = np.hypot(seen[:, 0], seen[:, 1])
    inner = (radius < np.interp(seen[:, 2], heights, radii) - WALL) & (seen[:, 2] < heights[-1] - WALL)
    cells = np.stack([radius[inner], seen[inner, 2]], axis=1) / SPACING
    found: Array = np.unique(np.round(cells), axis=0) * SPACING
    return found


def _ring(radius: float, height: float) -> Array:
    count = max(6, math.ceil(2 * math.pi * radius / SPACING))
    turn = np.linspace(0.0, 2 * math.pi, count, endpoint=False)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(count, height)], axis=1)


def profile(seen: Array, heights: Array, widest: float) -> Array:
    """The radius [m] at each height: the outermost that was seen there, `widest` at most; `widest` without sight."""
    radius, places, found = np.hypot(seen[:, 0], seen[:, 1]), [], []
    for middle in np.arange(heights[0], heights[-1] + BAND / 2, BAND):
        band = radius[np.abs(seen[:, 2] - middle) <= BAND / 2]
        if len(band) >= 4:
            places.append(float(middle))
            # What lies on the axis' side of the wall is an upper face or the inside of a vessel.
            found.append(min(float(np.percentile(band, 80)), widest))
    return np.interp(heights, places, found) if len(found) >= 2 else np.full(len(heights), widest)


def _ball(target: Target) -> Array:
    half = np.array(target.size) / 2
    count = max(40, math.ceil(4 * math.pi * float(half.max()) ** 2 / SPACING**2))
    # A Fibonacci lattice: even on the sphere.
    z = 1.0 - (2 * np.arange(count) + 1) / count
    turn = np.arange(count) * math.pi * (3.0 - math.sqrt(5.0))
    flat = np.sqrt(1.0 - z * z)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1) * half


def _box(target: Target) -> Array:
    half, faces = np.array(target.size) / 2, []
    for axis in range(3):
        u, v = (i for i in range(3) if i != axis)
        grid = np.stack(np.meshgrid(_steps(-half[u], half[u]), _steps(-half[v], half[v])), axis=-1).reshape(-1, 2)
        for side in (-half[axis], half[axis]):
            face = np.empty((len(grid), 3))
            face[:, u], face[:, v], face[:, axis] = grid[:, 0], grid[:, 1], side
            faces.append(face)
    return np.concatenate(faces)


def _columns(target: Target) -> Array:
    """A body of vertical columns from what was seen down to its underside."""
    seen, bottom = own_points(target), -target.size[2] / 2
    low, reach = seen[:, :2].min(axis=0), math.ceil(GAP / SPACING)
    index = np.floor((seen[:, :2] - low) / SPACING).astype(int) + reach
    shape = tuple(int(n) for n in index.max(axis=0) + 1 + reach)
    here = np.zeros(shape, bool)
    here[tuple(index.T)] = True
    disc = np.hypot(*np.mgrid[-reach : reach + 1, -reach : reach + 1]) * SPACING <= GAP
    # Closing: what lies between points that were seen counts, what lies beyond the outermost does not.
    inside = ndimage.binary_closing(here, disc)
    low = low + SPACING * (0.5 - reach)
    flat = low + np.argwhere(np.ones(shape, bool)) * SPACING
    _, near = cKDTree(seen[:, :2]).query(flat, k=min(3, len(seen)))
    tops = np.median(seen[near.reshape(len(flat), -1), 2], axis=1).reshape(shape)
    tops = np.where(inside, np.maximum(tops, bottom), bottom)
    lowest = ndimage.minimum_filter(
        tops, footprint=ndimage.generate_binary_structure(2, 1), mode="constant", cval=bottom
    )
    found = []
    for (i, j), inner in np.ndenumerate(inside):
        if inner:
            x, y = low + np.array([i, j]) * SPACING
            heights = _steps(float(lowest[i, j]), float(tops[i, j])) if lowest[i, j] < tops[i, j] else [tops[i, j]]
            found += [(x, y, float(z)) for z in heights]
    return np.array(found) if found else _box(target)
