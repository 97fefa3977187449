"""Where a known shape must stand to explain the points that were seen of it. Pure.

Round things are profiles turned about a vertical axis, boxes have a yaw. Both stand upright on a surface whose
height is known, so that two or three numbers are sought; the residual says how well the shape explains the points.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from common.scene import ObjectKind, Vec3

Array = NDArray[np.float64]
Segment = tuple[tuple[float, float], tuple[float, float]]
SAMPLE = 160
ROBUST, STRAY = 0.004, 0.007
MUG_WALL, BOWL_WALL, BOWL_LEAN = 0.004, 0.006, 0.55
NECK, NECK_FROM = 0.014, 0.72
EDGE_WEIGHT = 3.0
_CORNERS = np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)])


@dataclass(frozen=True)
class Fit:
    """Centre (x, y) [m] and yaw [rad] of a shape, and the mean distance [m] of the points from its surface."""

    x: float
    y: float
    yaw: float
    residual: float


def profile(kind: ObjectKind, size: Vec3) -> list[Segment]:
    """The outline (radius, height above the surface) that is turned about the axis of a round thing."""
    r, h = size[0] / 2, size[2]
    if kind == "mug":
        inner = r - MUG_WALL
        return [((r, 0), (r, h)), ((inner, 0.008), (inner, h)), ((inner, h), (r, h)), ((0, 0.008), (inner, 0.008))]
    if kind == "bowl":
        base = r - h * math.tan(BOWL_LEAN)
        wall = BOWL_WALL / math.cos(BOWL_LEAN)
        return [((base, 0), (r, h)), ((base - wall, 0), (r - wall, h)), ((0, 0.010), (base, 0.010))]
    if kind == "bottle":
        shoulder = NECK_FROM * h
        return [
            ((r, 0), (r, shoulder)),
            ((r, shoulder), (NECK, shoulder)),
            ((NECK, shoulder), (NECK, h)),
            ((NECK, h), (0, h)),
        ]
    return [((r, 0), (r, h)), ((r, h), (0, h))]


def _from_segments(rho: Array, z: Array, segments: Sequence[Segment]) -> Array:
    best = np.full(len(rho), np.inf)
    for (r0, z0), (r1, z1) in segments:
        dr, dz = r1 - r0, z1 - z0
        t = np.clip(((rho - r0) * dr + (z - z0) * dz) / (dr * dr + dz * dz), 0.0, 1.0)
        best = np.minimum(best, np.hypot(rho - r0 - t * dr, z - z0 - t * dz))
    return best


def _from_box(local: Array, z: Array, size: Vec3) -> Array:
    outside = np.abs(np.stack([local[:, 0], local[:, 1], z - size[2] / 2], axis=1)) - np.array(size) / 2
    distance = np.linalg.norm(np.maximum(outside, 0.0), axis=1) + np.minimum(outside.max(axis=1), 0.0)
    return np.asarray(np.abs(distance))


def distances(kind: ObjectKind, size: Vec3, points: Array, floor: float, x: float, y: float, yaw: float) -> Array:
    """Distance [m] of each point (n, 3) from the surface of a shape that stands at (x, y) on height `floor`."""
    dx, dy, z = points[:, 0] - x, points[:, 1] - y, points[:, 2] - floor
    if kind in ("block", "box"):
        c, s = math.cos(yaw), math.sin(yaw)
        return _from_box(np.stack([c * dx + s * dy, c * dy - s * dx], axis=1), z, size)
    if kind in ("apple", "ball"):
        r = size[0] / 2
        return np.abs(np.sqrt(dx * dx + dy * dy + (z - r) ** 2) - r)
    return _from_segments(np.hypot(dx, dy), z, profile(kind, size))


def _bearings(points: Array, camera: Array, ahead: float) -> Array:
    """The leftmost and the rightmost of points (n, 2), seen from `camera`, about the bearing `ahead` [rad]."""
    bearings = np.arctan2(points[:, 1] - camera[1], points[:, 0] - camera[0]) - ahead
    bearings = np.remainder(bearings + math.pi, 2 * math.pi) - math.pi
    return np.array([bearings.min(), bearings.max()])


def _corners(size: Vec3, x: float, y: float, yaw: float) -> Array:
    c, s = math.cos(yaw), math.sin(yaw)
    return np.asarray(_CORNERS * np.array(size[:2]) / 2 @ np.array([[c, s], [-s, c]]) + np.array([x, y]))


def fit(kind: ObjectKind, size: Vec3, points: Array, floor: float, camera: Array, whole: bool = True) -> Fit:
    """Place a shape on the surface of height `floor` so that it explains `points` (n, 3), seen from `camera` (3,).

    `whole`: nothing hides a part of it, so that a box must end where its points do.
    """
    used = points[:: max(1, len(points) // SAMPLE)]
    middle = used[:, :2].mean(axis=0)
    away = middle - camera[:2]
    away /= max(1e-6, float(np.linalg.norm(away)))
    boxy = kind in ("block", "box")
    yaws = (0.0, 0.5, 1.0, 1.5) if size[0] == size[1] else (0.0, 0.5, 1.0, 1.5, 2.0, 2.5)
    # A box of unequal sides also ends where its points do, or its far side would be free.
    ends = whole and boxy and size[0] != size[1]
    ahead, scale = math.atan2(away[1], away[0]), EDGE_WEIGHT * float(np.linalg.norm(middle - camera[:2]))
    edges = _bearings(points, camera, ahead) if ends else None

    def off(p: Array, points: Array) -> Array:
        apart = distances(kind, size, points, floor, p[0], p[1], p[2] if boxy else 0.0)
        if edges is None:
            return apart
        past = _bearings(_corners(size, p[0], p[1], p[2]), camera, ahead) - edges
        return np.append(apart, scale * past)

    def badness(p: Array) -> float:
        apart = np.minimum(np.abs(off(p, used)), 0.02)
        return float(apart[: len(used)].mean() + apart[len(used) :].sum() / EDGE_WEIGHT)

    if boxy:
        # Only the better starts of a box are followed to the end.
        turned = [(yaw, abs(math.cos(yaw - ahead)) * size[0] + abs(math.sin(yaw - ahead)) * size[1]) for yaw in yaws]
        starts = sorted((np.array([*middle + away * 0.4 * deep, yaw]) for yaw, deep in turned), key=badness)[:2]
    else:
        starts = [middle + away * 0.25 * size[0]]
    best = min(
        (least_squares(off, p, args=(used,), loss="soft_l1", f_scale=ROBUST, max_nfev=15) for p in starts),
        key=lambda found: float(found.cost),
    )
    # Once more without what the shape does not have, such as a mug's handle.
    own = used[off(best.x, used)[: len(used)] < STRAY]
    if len(own) > len(used) // 2:
        best = least_squares(off, best.x, args=(own,), loss="soft_l1", f_scale=ROBUST / 2, max_nfev=10)
    x, y = float(best.x[0]), float(best.x[1])
    yaw = float(best.x[2]) if boxy else 0.0
    left = np.minimum(distances(kind, size, used, floor, x, y, yaw), 0.02)
    return Fit(x, y, math.remainder(yaw, math.pi), float(left.mean()))


def handle_yaw(size: Vec3, points: Array, x: float, y: float, camera: Array) -> float:
    """Where a mug's handle points: to the points outside its wall, or away from the camera when none are seen."""
    dx, dy = points[:, 0] - x, points[:, 1] - y
    rho = np.hypot(dx, dy)
    outside = (rho > size[0] / 2 + 0.006) & (rho < size[0] / 2 + 0.04)
    if np.count_nonzero(outside) >= 6:
        return math.atan2(float(dy[outside].mean()), float(dx[outside].mean()))
    return math.atan2(y - float(camera[1]), x - float(camera[0]))
