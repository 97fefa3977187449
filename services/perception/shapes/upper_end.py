"""Whether the upper end of what stands is open or closed, by the lines of sight that go through it. Pure."""

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, Point
from common.messages import End

INNER_PART = 0.6
"""Share of the radius within which the upper end of a vessel is its bottom or its opening, and no rim."""
FLAT, LEVEL_SHARE = 0.006, 0.8
"""How far [m] from its height points of a level end are, beside the noise, and the least share of them that are."""
DEEP, OPEN_SHARE = 0.012, 0.6
"""How far [m] below it the inside is, beside the noise, and the least share of the points that are. Chosen: the lid
of a can lies 5 mm below its rim."""
LOOKED_INTO = 0.02
"""How far [m] above the end the camera has to be to look at it."""
FEWEST, END_SEEN = 5, 0.06
"""Points through the inner part that tell anything: at least so many, and at least this share of all points. Chosen: a
third of what a whole view from 45 degrees above shows."""


def upper_end(points: Array, middle: Point, radius: float, h: float, eye: Array, noise: float) -> End:
    """What points (n, 3) above their surface, seen from `eye` (3,), show of an end of `radius` [m] at height `h` [m].

    Where nothing dark returns depth there is no point, and that tells nothing: "".
    """
    inner = points[through(points, middle, INNER_PART * radius, h, eye)]
    if len(inner) < max(FEWEST, END_SEEN * len(points)):
        return ""
    below = h - inner[:, 2]
    if np.mean(np.abs(below) < FLAT + noise) > LEVEL_SHARE:
        return "closed"
    return "open" if np.mean(below > DEEP + noise) > OPEN_SHARE else ""


def through(points: Array, middle: Point, radius: float, h: float, eye: Array) -> NDArray[np.bool_]:
    """Which points (n, 3) are seen through a level circle, or lie on it; none from beside it."""
    if eye[2] < h + LOOKED_INTO:
        return np.zeros(len(points), bool)
    drop = np.minimum(points[:, 2], h) - eye[2]
    at = eye[:2] + (points[:, :2] - eye[:2]) * ((h - eye[2]) / drop)[:, None]
    return np.asarray(np.hypot(at[:, 0] - middle[0], at[:, 1] - middle[1]) < radius)
