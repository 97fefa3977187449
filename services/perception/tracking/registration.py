"""How far what one view shows of an object lies from where it is believed to be: a shift, and no turn. Pure.

In the manner of trimmed ICP (Chetverikov et al., "The trimmed iterative closest point algorithm", ICPR 2002): what has
no counterpart, as a side that was not seen before, counts no more than what is `APART`. Where the believed object would
be, and the view sees what is behind it, counts as well: so the outline of a flat thing says where it is.
"""

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from common.geometry import Array
from services.perception.views.view import View

APART = 0.006
"""Distance [m] from which points are of different parts. Chosen: less than the thickness of a thing, more than the
noise of either camera and the distance of the points."""
THROUGH = 0.006
"""How far [m] behind a believed point the view must see for nothing to be there: several times its noise."""
STEPS = (0.004, 0.002, 0.001, 0.0005)
"""Steps [m] of the search along and between the axes. Chosen: from within what finds its counterpart to a quarter of
the error of an arm."""
FARTHEST = 0.02
"""Farthest shift [m] that is an error of the cameras' mounts, 8 mm for either at 1 m, and no other place."""
STAYS = 0.03
"""What a shift by `FARTHEST` costs, as a share of all points: along what the view does not show the end of it stays."""
EXPLAINED = 0.6
"""Least share of the seen points that have a counterpart after the shift: less is another object, or hardly any of
it."""
LEAST = 0.2
"""Least share of the believed points that is seen: of less, as between closing fingers, the outline is theirs."""
MOST = 300
"""Points of either that are looked at. Chosen: 80 ms of a step for one object."""
ALIKE, BETWEEN, FEW = 0.2, 0.010, 150
"""How badly points may lie on those of earlier views that show the same sides: two frames of 20 mm bars, 5 mm apart,
have .3. How far apart [m] they are found, which is the error of localisation: what is thinner has one side only. Of how
many points that is asked."""
_AROUND = np.array(sorted(itertools.product((-1.0, 0.0, 1.0), repeat=3), key=any))
_LEVEL = _AROUND[_AROUND[:, 2] == 0.0]


def shift(believed: Array, seen: Array, view: View) -> Array | None:
    """How far (3,) [m] an object is from where its points (n, 3) [map] are believed to be, by those that a view shows
    of it; None where they are not of one object.
    """
    if not len(believed) or len(seen) < LEAST * len(believed):
        return None
    tree, seen, believed = cKDTree(believed), _some(seen), _some(believed)

    def costs(moved: Array) -> Array:
        stays = STAYS * np.square(moved).sum(axis=1) / FARTHEST**2
        far = _unlike(tree, seen - moved[:, None])
        return np.asarray(far + _empty(believed + moved[:, None], view) + stays)

    best = _lowest(costs, _AROUND, FARTHEST)
    if best is None:
        return None
    apart, _ = tree.query(seen - best, distance_upper_bound=APART)
    return best if float(np.isfinite(apart).mean()) >= EXPLAINED else None


def _lowest(costs: Callable[[Array], Array], ways: Array, farthest: float) -> Array | None:
    """The shift (3,) [m] that costs least, downhill by steps along `ways` (n, 3), none of them first; None where that
    leads farther."""
    best = np.zeros(3)
    for step in STEPS:
        while True:
            tried = best + step * ways
            lowest = int(np.argmin(costs(tried)))
            if not lowest:
                break
            best = tried[lowest]
            if float(np.linalg.norm(best)) > farthest:
                return None
    return best


def laid_over(believed: Array, seen: Array) -> Array:
    """Points (m, 3) of a view, moved level to where nearly all of them lie on those (n, 3) of earlier ones; as they are
    where that is so already, or nowhere near."""
    tree, few = cKDTree(believed), _some(seen, FEW)
    if float(_unlike(tree, few)) <= ALIKE:
        return seen
    by = _lowest(lambda moved: _unlike(tree, few + moved[:, None]), _LEVEL, BETWEEN)
    return seen if by is None or float(_unlike(tree, few + by)) > ALIKE else seen + by


def unlike(believed: Array, seen: Array) -> float:
    """How badly points (m, 3) lie on those (n, 3) of earlier views: 0 when all have a counterpart, 1 when none has."""
    return float(_unlike(cKDTree(believed), _some(seen)))


def _unlike(tree: Any, seen: Array) -> Array:
    """That of points (..., m, 3)."""
    apart, _ = tree.query(seen, distance_upper_bound=APART)
    return np.asarray(np.square(np.minimum(apart, APART) / APART).mean(axis=-1))


def _empty(points: Array, view: View) -> Array:
    """Shares (n,) of the points (n, m, 3) [map] in the picture through whose places a view sees."""
    u, v, far = np.moveaxis(view.project(points.reshape(-1, 3)).reshape(points.shape), 2, 0)
    h, w = view.shape
    inside = (far > 0) & (u >= 0) & (u < w) & (v >= 0) & (v < h)
    depth = view.depth[np.clip(v, 0, h - 1).astype(int), np.clip(u, 0, w - 1).astype(int)]
    through = inside & (depth > far + THROUGH)
    return np.asarray(through.sum(axis=1) / np.maximum(1, inside.sum(axis=1)))


def _some(points: Array, most: int = MOST) -> Array:
    return points[:: max(1, math.ceil(len(points) / most))]
