"""Scan matching: registration of one set of lidar end points with another, by small_gicp's GICP.

Planar points are repeated in layers above each other, so that a wall is a vertical plane whose normal the library can
estimate. Source: Segal et al., "Generalized-ICP", RSS 2009; Koide, "small_gicp", JOSS 2024.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.spatial import KDTree

from common.geometry import Array, Pose2, transformed

LAYERS = (-0.1, 0.0, 0.1)
"""Heights at which the points are repeated [m]: as far apart as neighbours on a wall some metres away."""
VOXEL = 0.05
"""Points closer together are merged [m]: what several scans saw of one spot is one point, with less noise than each."""
NEIGHBOURS = 12
"""Points that a normal is fitted to [count]: four of each layer, 0.2 m of a wall."""
REACH = 0.30
"""Greatest distance of two points that are taken for the same [m]; chosen: the drift between two keyframes and more."""
INLIER = 0.05
"""Distance within which a point is explained by the other set [m]: three times both lidars' noise."""
MIN_POINTS = 30
"""Points without which nothing is matched [count]."""


class Match(NamedTuple):
    """`pose` of the source in the target's frame, and the share of its points (`fit`) that lie on the target."""

    pose: Pose2
    fit: float


class Target:
    """Points (n, 2) that others are matched to, prepared for repeated use."""

    def __init__(self, points: Array) -> None:
        import small_gicp

        self._cloud, self._tree = small_gicp.preprocess_points(_layered(points), VOXEL, NEIGHBOURS)
        self._plane = KDTree(points)

    def match(self, points: Array, guess: Pose2, reach: float = REACH) -> Match:
        """Match points (n, 2) of another frame, from a guess of that frame's pose."""
        if len(points) < MIN_POINTS:
            return Match(guess, 0.0)
        import small_gicp

        source, _ = small_gicp.preprocess_points(_layered(points), VOXEL, NEIGHBOURS)
        result = small_gicp.align(
            self._cloud, source, self._tree, _matrix(guess), "GICP", max_correspondence_distance=reach,
            max_iterations=30, rotation_epsilon=1e-4, translation_epsilon=1e-4,
        )  # fmt: skip
        pose = _pose(np.asarray(result.T_target_source))
        return Match(pose, self.fit(points, pose))

    def fit(self, points: Array, pose: Pose2) -> float:
        """The share of points (n, 2) that lie on the target when their frame is at `pose`."""
        distance, _ = self._plane.query(placed(points, pose))
        return float(np.mean(distance < INLIER))


def placed(points: Array, pose: Pose2) -> Array:
    """Points (n, 2 or 3) of the frame at `pose` in its parent; heights stay."""
    return np.column_stack([transformed(pose, points[:, :2]), points[:, 2:]])


def _layered(points: Array) -> Array:
    count = len(points)
    layers = np.repeat(np.array(LAYERS), count)
    return np.column_stack([np.tile(points, (len(LAYERS), 1)), layers])


def _matrix(pose: Pose2) -> Array:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return np.array([[c, -s, 0, pose[0]], [s, c, 0, pose[1]], [0, 0, 1, 0], [0, 0, 0, 1]])


def _pose(t: Array) -> Pose2:
    return float(t[0, 3]), float(t[1, 3]), math.atan2(t[1, 0] - t[0, 1], t[0, 0] + t[1, 1])
