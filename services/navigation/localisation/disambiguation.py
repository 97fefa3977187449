"""Where a robot that may be in several places drives to find out in which it is. Pure.

It drives in the frame of its wheels, over floor that is free wherever it may be, to the spot from which the lidar would
see the greatest differences.
"""

import math
from collections.abc import Sequence

import numpy as np

from common.floor_plan import FloorPlan, Place
from common.geometry import Array, Pose2, compose, inverse, transformed
from services.navigation.localisation.distance_field import DistanceField
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

REACH = 5.0
"""Half the side of the square around the robot in which it looks for a spot [m]: a room and what is behind its door."""
SPOTS = 80
"""Spots that are compared [count]: some one per half metre squared of a room."""
RAYS, STEPS, FAR = 36, 60, 8.0
"""Rays of an expected scan, steps along each [count], and how far they go [m]; chosen: 10 degrees tell rooms apart."""
DIFFERENT = 0.3
"""Difference of two ranges that is not noise, nor the errors of a pose [m]."""
PER_METRE = 0.02
"""What a metre of the way costs, in shares of rays that differ [1/m]; chosen: a clear difference is worth the way."""
NEAREST = 0.3
"""Spots nearer than this tell nothing new [m]."""


def common_ground(costmap: Costmap, odometry: Pose2, poses: Sequence[Pose2], start: float) -> Costmap:
    """The floor around the robot, in the frame of its wheels, that is free whichever of `poses` [map] is true.

    `start` [m]: within this the robot stands already, whatever the map says.
    """
    x, y, _ = odometry
    here = Place(name="here", x=x, y=y, theta=0.0)
    area = FloorPlan(name="around", low=(x - REACH, y - REACH), high=(x + REACH, y + REACH), home=here)
    found = Costmap(area, costmap.resolution, costmap.obstacles.memory)
    centres = found.centres().reshape(-1, 2)
    distance = found.static_distance.ravel()
    rows, columns = costmap.shape
    for pose in poses:
        at = transformed(compose(pose, inverse(odometry)), centres)
        cells = np.floor((at - costmap.origin) / costmap.resolution).astype(np.intp)
        inside = ((cells >= 0) & (cells < (columns, rows))).all(axis=1)
        cells[~inside] = 0
        here_free = np.where(inside, costmap.static_distance[cells[:, 1], cells[:, 0]], 0.0)
        distance = np.minimum(distance, here_free)
    under = np.hypot(centres[:, 0] - x, centres[:, 1] - y) < start
    found.confine(np.where(under, np.maximum(distance, start), distance).reshape(found.shape))
    return found


def expected_ranges(field: DistanceField, poses: Array) -> Array:
    """What the lidar would measure (n, RAYS) [m] from poses (n, 3) [map] by the map alone; FAR at most."""
    angles = poses[:, 2:] + np.arange(RAYS) * (2 * math.pi / RAYS)
    ways = np.stack([np.cos(angles), np.sin(angles)], axis=2)
    ranges = np.zeros(angles.shape)
    for _ in range(STEPS):
        ends = poses[:, None, :2] + ways * ranges[:, :, None]
        free = field.nearest(ends.reshape(-1, 2)).reshape(ranges.shape)
        ranges = np.minimum(ranges + np.maximum(free, 0.0), FAR)
    return ranges


def most_telling(
    ground: Costmap, planner: PathPlanner, field: DistanceField, odometry: Pose2, poses: Sequence[Pose2]
) -> Pose2 | None:
    """The spot [odometry] whose scans would differ most between the hypotheses; None when the robot cannot move.

    Where all look alike as far as one sees, it is the farthest spot.
    """
    cost = planner.field(odometry[0], odometry[1]).cost
    rows, columns = np.nonzero(np.isfinite(cost))
    order = np.argsort(cost[rows, columns])
    order = order[np.linspace(0, len(order) - 1, min(SPOTS, len(order))).astype(int)]
    spots = [(*ground.point(int(rows[n]), int(columns[n])), odometry[2]) for n in order]
    ways = cost[rows[order], columns[order]]
    far = [n for n, spot in enumerate(spots) if math.dist(spot[:2], odometry[:2]) > NEAREST]
    if not far:
        return None
    there = [compose(inverse(odometry), spots[n]) for n in far]
    seen = expected_ranges(field, np.array([compose(pose, to) for to in there for pose in poses]))
    scans = seen.reshape(len(far), len(poses), RAYS)
    pairs = np.triu_indices(len(poses), 1)
    differs = np.abs(scans[:, pairs[0]] - scans[:, pairs[1]]) > DIFFERENT
    told = differs.mean(axis=(1, 2)) if len(poses) > 1 else np.zeros(len(far))
    gain = told - PER_METRE * ways[far]
    best = int(np.argmax(np.where(gain > 0.0, gain, -1.0 / (1.0 + ways[far]))))
    return spots[far[best]]
