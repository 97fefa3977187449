"""What was seen of a vessel: its rim, the slope of its wall, whether it is open. Pure."""

import math

import numpy as np

from common.geometry import Array
from services.manipulation.grasps.surface import away, own_points, profile
from services.manipulation.grasps.target import Target

SECTORS, AROUND = 12, 0.75
"""Into how many sectors a vessel is divided, and in which share of them some of it is seen: of its rim one sees all."""
DEEP, DEEP_BY, BEYOND, OPEN = 0.022, 0.6, 0.25, 0.08
"""How far [m] below the top, by the height where that is low, and how far beyond the axis, by the radius, what was seen
is the inside of a vessel and no lid with its knob; and the share of all points from which it is open: a mug at 2 m
shows twice as much."""
AT_WALL, STANDS_OUT = 0.8, 0.015
"""Share of the radius from which what was seen of a vessel is of its wall, and how far [m] something has to reach over
that to be no part of it: a spout reaches less."""
UPPER_WALL = 0.03
"""How far [m] below a rim its wall is what the pads are laid on: their length less what is above it."""


def rim_lean(target: Target) -> float | None:
    """How far [rad] the wall of a vessel leans outwards below its rim, where that was seen; None of what was not."""
    seen, top = own_points(target), target.size[2] / 2
    if not target.measured or target.lies or len(seen) == 0:
        return None
    run = min(UPPER_WALL, target.size[2] / 2)
    low, high = profile(seen, np.array([top - run, top]), max(target.size[:2]) / 2)
    return max(0.0, math.atan2(float(high - low), run))


def rim_height(target: Target) -> float:
    """How high [m] over its underside the rim of a vessel is: the height of its wall as it was seen around the axis,
    where something that stands in it, or is its handle, reaches higher; the vessel's own where it was not seen."""
    height, radius = target.size[2], max(target.size[:2]) / 2
    seen = own_points(target)
    wall = seen[np.hypot(seen[:, 0], seen[:, 1]) > AT_WALL * radius]
    if not target.measured or target.lies or not len(wall) or not all_around(wall):
        return height
    sectors = _sectors(wall)
    tops = [float(wall[sectors == n, 2].max()) for n in np.unique(sectors)]
    rim = float(np.median(tops)) + height / 2
    return rim if rim < height - STANDS_OUT else height


def seen_open(target: Target) -> bool:
    """The far wall of a vessel was seen from inside, below its rim; True of what was not measured."""
    if target.points is None or not target.measured:
        return True
    seen, height = own_points(target), target.size[2]
    deep = min(DEEP, DEEP_BY * height)
    beyond = seen[:, :2] @ away(target) > BEYOND * max(target.size[:2]) / 2
    return float(np.mean(beyond & (seen[:, 2] < height / 2 - deep))) > OPEN


def all_around(points: Array) -> bool:
    """Points (n, 3) lie on all sides of the axis."""
    return len(np.unique(_sectors(points))) >= AROUND * SECTORS


def _sectors(points: Array) -> Array:
    """The number (n,) of the sector around the axis in which each point lies."""
    found: Array = np.floor(np.arctan2(points[:, 1], points[:, 0]) / math.tau * SECTORS)
    return found
