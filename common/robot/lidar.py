"""A lidar message as rays in the base frame, checked. Pure."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from common import messages as m
from common.approach import HALF_WIDTH
from common.geometry import Array

MAX_RANGE, MAX_VALUE = 1000.0, 1e9
"""What no lidar [m] and no odometry [m, m/s, rad] reports: a fault of its sender."""
FEWEST = 8
"""Bytes without which it is no scan: two rays."""


class Rays(NamedTuple):
    """The n rays of a scan: `angles` (n,) [rad], `directions` (n, 2), `ranges` (n,) [m], `ends` (n, 2) [base].

    `own` (n,): those that end on the robot's body, `hit` (n,): on something else.
    """

    angles: Array
    directions: Array
    ranges: Array
    ends: Array
    own: Array
    hit: Array


def rays_of(scan: m.LaserScan) -> Rays:
    """The rays of a message.

    Raises:
        ValueError: it is not the scan of a lidar.
    """
    if len(scan.ranges) < FEWEST or len(scan.ranges) % 4:
        raise ValueError("ranges are at least two 32 bit floats")
    with np.errstate(invalid="ignore"):
        ranges = np.frombuffer(scan.ranges, "<f4").astype(np.float64)
    described = sane(scan.t, scan.x, scan.y, scan.angle_min, scan.range_min, scan.range_max)
    if not described or not 0.0 < scan.angle_increment < 1.0 or not (np.abs(ranges) <= MAX_RANGE).all():
        raise ValueError("not the ranges of a lidar")
    angles, directions = _layout(len(ranges), scan.angle_min, scan.angle_increment)
    ends = directions * ranges[:, None] + (scan.x, scan.y)
    own = np.abs(ends).max(axis=1) < HALF_WIDTH
    hit = (ranges <= scan.range_max) & (ranges > scan.range_min) & ~own
    return Rays(angles, directions, ranges, ends, own, hit)


@lru_cache(maxsize=4)
def _layout(count: int, first: float, step: float) -> tuple[Array, Array]:
    """Angles (n,) and directions (n, 2) of the rays, which hardly ever change."""
    angles = np.asarray(first + np.arange(count) * step, np.float64)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    angles.flags.writeable = directions.flags.writeable = False
    return angles, directions


def sane(*values: float) -> bool:
    """True for numbers that a sensor can have measured."""
    return all(abs(v) <= MAX_VALUE for v in values)
