"""Tracking errors of base and arm."""

from collections.abc import Sequence

import numpy as np

from common import messages as m
from common.geometry import Pose2

FRESH = 0.25
"""A set-point older than this [s] is not followed any more."""


def off_path(path: Sequence[tuple[float, float]], base: Pose2) -> float:
    """Distance [m] from the base to the nearest point of a path; 0 without one."""
    if len(path) < 2:
        return 0.0
    points = np.asarray(path, dtype=np.float64)
    start, way = points[:-1], np.diff(points, axis=0)
    long = np.maximum((way**2).sum(axis=1), 1e-12)
    share = np.clip((((base[0], base[1]) - start) * way).sum(axis=1) / long, 0.0, 1.0)
    near = start + share[:, np.newaxis] * way
    return float(np.hypot(near[:, 0] - base[0], near[:, 1] - base[1]).min())


def arm_error(command: m.ArmCommand | None, joints: dict[str, float]) -> float:
    """The largest difference [rad] between the arm's set-point and its joints; 0 without a set-point."""
    if command is None:
        return 0.0
    pairs = ((q, joints.get(f"joint_{n}")) for n, q in enumerate(command.position, 1))
    return max((abs(q - at) for q, at in pairs if at is not None), default=0.0)
