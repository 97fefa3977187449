"""A turn of the lidar as end points in the base frame."""

from dataclasses import dataclass

import numpy as np

from common import messages as m
from common.geometry import Array, Pose2, transformed
from common.robot.lidar import rays_of


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
        """The scan as points in the frame of a base that has moved by `motion` since."""
        back = transformed((-motion[0], -motion[1], -motion[2]), self.points)
        return Scan(back, self.ranges, self.angles, self.reach, self.lidar, self.range_max)


def scan_of(message: m.LaserScan) -> Scan:
    """The scan of a message.

    Raises:
        ValueError: it is not the scan of a lidar.
    """
    rays = rays_of(message)
    reach = np.where(rays.own, 0.0, rays.ranges)
    points, ranges = rays.ends[rays.hit], rays.ranges[rays.hit]
    return Scan(points, ranges, rays.angles, reach, (message.x, message.y), message.range_max)
