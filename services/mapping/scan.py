"""A lidar message as end points in the base frame. Pure."""

from typing import NamedTuple

from common import messages as m
from common.geometry import Array
from common.robot.lidar import rays_of


class Scan(NamedTuple):
    """A scan at `t` [s]: `points` (n, 2) are where rays ended, `passed` (k, 2) how far the others went without a hit;
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
    rays, lidar = rays_of(message), (message.x, message.y)
    # A ray without an echo says little: glass, black leather or nothing at all. It counts for half of the range.
    none = rays.ranges > message.range_max
    return Scan(message.t, rays.ends[rays.hit], rays.directions[none] * (message.range_max / 2) + lidar, lidar)
