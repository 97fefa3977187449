"""A turn of the lidar as end points in the base frame."""

from dataclasses import dataclass

import numpy as np

from common import messages as m
from common.approach import HALF_WIDTH
from common.geometry import Pose2
from services.navigation.localisation.distance_field import Array

MAX_RANGE, MAX_VALUE = 1000.0, 1e9
"""What no lidar [m] and no odometry [m, m/s, rad] reports: a fault of its sender."""
FEWEST = 8
"""Bytes without which it is no scan: two rays."""


@dataclass(frozen=True)
class Scan:
    """`points` (n, 2) [base] are what the rays hit and `ranges` (n,) [m] how far that is.

    Of every ray: its angle and its `reach` [m], 0 where the robot's own body holds it up; from `lidar` (x, y) [base].
    """

    points: Array
    ranges: Array
    angles: Array
    reach: Array
    lidar: tuple[float, float]
    range_max: float

    def after(self, motion: Pose2) -> "Scan":
        """The same for a base that has moved by `motion` since."""
        back = transformed((-motion[0], -motion[1], -motion[2]), self.points)
        return Scan(back, self.ranges, self.angles, self.reach, self.lidar, self.range_max)


class ScanReader:
    """Reads messages; the directions of the rays are kept as long as the layout stays."""

    def __init__(self) -> None:
        self._layout = (0, 0.0, 0.0)
        self._angles: Array = np.empty(0)
        self._directions: Array = np.empty((0, 2))

    def read(self, scan: m.LaserScan) -> Scan:
        """The scan of a message.

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
        layout = len(ranges), scan.angle_min, scan.angle_increment
        if self._layout != layout:
            self._layout = layout
            self._angles = np.asarray(scan.angle_min + np.arange(len(ranges)) * scan.angle_increment, np.float64)
            self._directions = np.stack([np.cos(self._angles), np.sin(self._angles)], axis=1)
        ends = self._directions * ranges[:, None] + (scan.x, scan.y)
        own = np.abs(ends).max(axis=1) < HALF_WIDTH
        hit = (ranges <= scan.range_max) & (ranges > scan.range_min) & ~own
        reach = np.where(own, 0.0, ranges)
        return Scan(ends[hit], ranges[hit], self._angles, reach, (scan.x, scan.y), scan.range_max)


def transformed(frame: Pose2, points: Array) -> Array:
    """Points (n, 2) of `frame` in its parent."""
    c, s = np.cos(frame[2]), np.sin(frame[2])
    moved: Array = points @ np.array([[c, s], [-s, c]]) + frame[:2]
    return moved


def sane(*values: float) -> bool:
    """True for numbers that a sensor can have measured."""
    return all(abs(v) <= MAX_VALUE for v in values)
