"""A flat that is mapped without physics: scans by the slab method along a way, wheels that drift."""

import itertools
import math

import numpy as np

from common.geometry import Pose2, compose, inverse
from services.mapping.scan import Scan
from services.mapping.trajectory import Trajectory
from services.navigation.localisation.distance_field import rectangles
from tests.unit.navigation_flat import ANGLES, SCENE, cast

BOXES = rectangles(SCENE, 0.2)
ROUND = ((0, 0), (0.2, -1.2), (1.6, -0.75), (3.4, -0.75), (4.2, -0.3), (4.2, 1.8), (3.5, 3.2), (1.5, 3.2), (-0.4, 3.0),
         (-0.45, 1.5), (-0.4, 0), (0, 0), (0.2, -1.2), (1.6, -0.75))  # fmt: skip
"""Through all four rooms and back."""
STEP = 0.4


def scan(pose: Pose2, rng: np.random.Generator) -> Scan:
    """What the lidar of a robot at `pose` sees, with noise of 1 cm."""
    ranges = cast(pose, BOXES) + rng.normal(0.0, 0.01, len(ANGLES))
    hit = ranges < 10.0
    return Scan(0.0, np.stack([np.cos(ANGLES), np.sin(ANGLES)], 1)[hit] * ranges[hit, None], np.empty((0, 2)), (0, 0))


def way(corners: tuple[tuple[float, float], ...] = ROUND) -> list[Pose2]:
    """Poses every STEP along the corners, facing ahead."""
    found: list[Pose2] = [(0.0, 0.0, 0.0)]
    for a, b in itertools.pairwise(corners):
        count, heading = int(math.dist(a, b) / STEP) + 1, math.atan2(b[1] - a[1], b[0] - a[0])
        found += [(a[0] + (b[0] - a[0]) * k / count, a[1] + (b[1] - a[1]) * k / count, heading)
                  for k in range(1, count + 1)]  # fmt: skip
    return found


def drifting(true: list[Pose2]) -> list[Pose2]:
    """What wheels report on that way that are 2 % off, and turn half a degree a metre without noticing."""
    found = [true[0]]
    for a, b in itertools.pairwise(true):
        dx, dy, turn = compose(inverse(a), b)
        found.append(compose(found[-1], (dx * 1.02, dy * 0.985, turn * 1.01 + 0.008 * math.hypot(dx, dy))))
    return found


def mapped(true: list[Pose2], wheels: list[Pose2], seed: int = 1) -> Trajectory:
    rng = np.random.default_rng(seed)
    trajectory = Trajectory()
    for pose, believed in zip(true, wheels, strict=True):
        trajectory.add(scan(pose, rng), believed)
    return trajectory
