"""A lidar message as end points in the base frame. Pure."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from common import messages as m
from common.approach import HALF_WIDTH

Array = NDArray[np.float64]


class Scan(NamedTuple):
    """Taken at `t` [s]: `points` (n, 2) are where rays ended, `passed` (k, 2) how far the others went without a hit;
    both in the base frame, and `lidar` is where the rays began [m]."""

    t: float
    points: Array
    passed: Array
    lidar: tuple[float, float]


def scan_of(message: m.LaserScan) -> Scan:
    """The scan of a message, without the rays that end on the robot itself.

    Raises:
        ValueError: ranges that no lidar reports.
    """
    if len(message.ranges) < 8 or len(message.ranges) % 4:
        raise ValueError("ranges are at least two 32 bit floats")
    ranges = np.frombuffer(message.ranges, "<f4").astype(np.float64)
    if not np.isfinite(ranges).all() or not 0.0 < message.angle_increment < 1.0:
        raise ValueError("not the ranges of a lidar")
    angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    lidar = np.array((message.x, message.y))
    ends = directions * ranges[:, None] + lidar
    own = np.abs(ends).max(axis=1) < HALF_WIDTH
    hit = (ranges <= message.range_max) & (ranges > message.range_min) & ~own
    # A ray without an echo says little: glass, black leather or nothing at all. It counts for half of the range.
    none = ranges > message.range_max
    return Scan(message.t, ends[hit], directions[none] * (message.range_max / 2) + lidar, (message.x, message.y))
