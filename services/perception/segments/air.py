"""Parts that hang in the air: what one looks through under them is no object by itself. Pure.

A handle, a spout, the bed of a toy truck between its wheels: whatever their colour, they belong to what carries them.
"""

import numpy as np

from common.geometry import Array
from services.perception.segments.segment import DEPTH_NOISE
from services.perception.views.view import View

LOW, SHARE_LOW = 0.015, 0.15
"""Height [m], and by that of its top, below which a part's lowest points rest on the surface. Chosen: a ball of 64 mm
shows itself down to 14 mm from as steep as the head camera looks."""
SEEN, OPEN = 0.4, 0.6
"""Share of the points under which one looks through, and by those under which one looks through or at something.
Chosen: under a handle that runs away from the camera its own nearer end is before half of them, under the front of a
large ball one looks through to a quarter."""
KNOWN = 0.5
"""Least share of the points under which there is any depth in the picture."""
FEW, SAMPLE = 8, 200
"""Fewest points of which anything is said, and how many of them are looked at."""
NOISE, ERROR = 3.0, 0.004
"""Standard deviations of depth, and what else [m] it is off at edges, up to which something is at a point."""
ATTACHED = 0.03
"""Distance [m] up to which a part that hangs is carried by another one: the width of the gap that a step of depth
leaves, and of a handle's bend."""


def hangs(view: View, points: Array, floor: float) -> bool:
    """Points (n, 3) [map] do not reach the surface at height `floor` [m], and one looks through under them, halfway
    between the surface and the lowest."""
    if len(points) < FEW:
        return False
    some = points[:: max(1, len(points) // SAMPLE)]
    height = some[:, 2] - floor
    low, top = (float(v) for v in np.quantile(height, (0.02, 0.98)))
    if low < max(LOW, SHARE_LOW * top):
        return False
    beyond = _beyond(view, some * (1.0, 1.0, 0.0) + (0.0, 0.0, floor + low / 2))
    known = beyond[np.isfinite(beyond)]
    tolerance = ERROR + NOISE * DEPTH_NOISE * float(np.linalg.norm(some.mean(axis=0) - view.position)) ** 2
    through, at = np.count_nonzero(known > tolerance), np.count_nonzero(np.abs(known) <= tolerance)
    return len(known) >= KNOWN * len(some) and bool(through > max(SEEN * len(known), OPEN * (through + at)))


def _beyond(view: View, points: Array) -> Array:
    """How much farther [m] than points (n, 3) the picture's depth is there; nan where there is none."""
    u, v, far = view.project(points).T
    h, w = view.shape
    inside = (far > 0) & (u >= 0) & (v >= 0) & (u < w) & (v < h)
    depth = np.zeros(len(far))
    depth[inside] = view.depth[v[inside].astype(int), u[inside].astype(int)]
    return np.where(depth > 0, depth - far, np.nan)


def gap(a: Array, b: Array) -> float:
    """Distance [m] of two clouds (n, 3), from a sample of each."""
    one, other = (c[:: max(1, len(c) // SAMPLE)] for c in (a, b))
    return float(np.linalg.norm(one[:, None] - other[None], axis=2).min())
