"""Primitives with free parameters, fitted to the points that were seen of an object on a surface. Pure.

Each has a distance of points from its surface for many parameter vectors at once, so that the solver gets its slopes
by differences in one pass. Points are in a frame whose z is the height above the surface; `h` is the measured top.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from common.geometry import Array
from services.perception.shapes.least_squares import solve

# Parameters (m, k) and points (n, 3) to distances (m, n).
Distances = Callable[[Array, Array], Array]
STEP = 1e-5
"""Difference [m, rad] by which slopes are taken."""
ROBUST = 0.004
"""Distance [m] beyond which a point counts less. Chosen: twice the depth noise at 1.2 m."""
TRIES = 12
"""Steps of the solver."""
STRAYED = 4.0
"""Standard deviations beyond what is expected at which the solver went astray, and the start is kept: a brush whose
handle slopes down is no box of twice its length."""
INNER = 0.012
"""Distance [m] behind the surface beyond which a point is of the inside of a hollow object, and pulls nothing."""
STRAYS = 0.015
"""Share of the points at either end that a rectangle leaves out."""
CELLS = 14.0
"""Cells along the longer side of an outline in which it is counted what is covered."""
END_WEIGHT = 4.0
"""Weight of a visible end of the silhouette, in points."""


@dataclass(frozen=True)
class Silhouette:
    """Bearings [rad] of an object's right and left end from `camera` (2,) about `ahead`; nan where it is hidden."""

    camera: Array
    ahead: float
    ends: Array
    distance: float


# The silhouette and parameters (m, k) to how far [m] their ends are from it (m, e).
Ends = Callable[[Silhouette, Array], Array]


@dataclass(frozen=True)
class Solution:
    """Parameters (k,), their covariance (k, k), and the mean distance [m] of the points from the surface."""

    p: Array
    covariance: Array
    residual: float


def silhouette(points: Array, camera: Array, seen: tuple[bool, bool], half_pixel: float) -> Silhouette:
    """The ends of points (n, 3) from `camera` (3,); `half_pixel` [rad]: how far a pixel reaches beyond its centre."""
    middle = points[:, :2].mean(axis=0)
    ahead = math.atan2(middle[1] - camera[1], middle[0] - camera[0])
    bearings = np.arctan2(points[:, 1] - camera[1], points[:, 0] - camera[0]) - ahead
    bearings = np.remainder(bearings + math.pi, 2 * math.pi) - math.pi
    ends = np.array([bearings.min() - half_pixel, bearings.max() + half_pixel])
    ends[~np.array(seen)] = np.nan
    distance = math.hypot(middle[0] - camera[0], middle[1] - camera[1])
    return Silhouette(camera[:2], ahead, ends, distance)


def bearing_of(outline: Silhouette, x: Array, y: Array) -> Array:
    """Bearings [rad] of points from the camera, about where the silhouette is."""
    bearings = np.arctan2(y - outline.camera[1], x - outline.camera[0]) - outline.ahead
    return np.asarray(np.remainder(bearings + math.pi, 2 * math.pi) - math.pi)


def apart(outline: Silhouette, ends: Array) -> Array:
    """How far [m] right and left ends (m, 2) [rad] are from those of the silhouette that are in view (m, e)."""
    return outline.distance * (ends - outline.ends)[:, ~np.isnan(outline.ends)]


def round_ends(half: float) -> Ends:
    """Tangents of a turned shape, p as in `turned` for half its height [m] or in `ball`: its widest part has them."""

    def ends(outline: Silhouette, p: Array) -> Array:
        x, y, r = p.T[:3]
        widest = r + np.abs(p[:, 3]) * half if p.shape[1] > 3 else r
        far = np.maximum(np.hypot(x - outline.camera[0], y - outline.camera[1]), 1e-3)
        angle = np.arcsin(np.clip(widest / far, -0.99, 0.99))
        bearing = bearing_of(outline, x, y)
        return apart(outline, np.stack([bearing - angle, bearing + angle], axis=1))

    return ends


def corner_ends(lies: bool) -> Ends:
    """The outermost corners of a box, or of one around what `lies`."""

    def ends(outline: Silhouette, p: Array) -> Array:
        x, y, yaw, *sides = p.T
        length, width = (sides[1], 2 * sides[0]) if lies else sides
        c, s = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
        a, b = np.array([1, 1, -1, -1]) * length[:, None] / 2, np.array([1, -1, 1, -1]) * width[:, None] / 2
        bearings = bearing_of(outline, x[:, None] + c * a - s * b, y[:, None] + s * a + c * b)
        return apart(outline, np.stack([bearings.min(axis=1), bearings.max(axis=1)], axis=1))

    return ends


def turned(h: float) -> Distances:
    """Turned about the vertical: p = (x, y, radius at half height, growth of the radius with height)."""

    def distances(p: Array, points: Array) -> Array:
        x, y, r, grows = (p[:, i, None] for i in range(4))
        rho = np.hypot(points[:, 0] - x, points[:, 1] - y)
        side = rho - r - grows * (points[:, 2] - h / 2)
        cap = points[:, 2] - h
        # Within the outline the top is as good as the wall; deep below it the inside of something hollow is seen.
        inside = np.minimum(np.minimum(-side, np.abs(cap)), INNER)
        return np.where(side > 0, np.hypot(side, np.maximum(cap, 0.0)), inside)

    return distances


def ball() -> Distances:
    """A ball that lies on the surface: p = (x, y, radius)."""

    def distances(p: Array, points: Array) -> Array:
        x, y, r = (p[:, i, None] for i in range(3))
        dx, dy, dz = points[:, 0] - x, points[:, 1] - y, points[:, 2] - r
        return np.sqrt(dx * dx + dy * dy + dz * dz) - r

    return distances


def box(h: float) -> Distances:
    """An upright box: p = (x, y, yaw, length, width)."""

    def distances(p: Array, points: Array) -> Array:
        x, y, yaw, length, width = (p[:, i, None] for i in range(5))
        c, s = np.cos(yaw), np.sin(yaw)
        dx, dy = points[:, 0] - x, points[:, 1] - y
        u, v = np.abs(c * dx + s * dy) - length / 2, np.abs(c * dy - s * dx) - width / 2
        w = np.broadcast_to(points[:, 2] - h, u.shape)
        deep = np.maximum(np.maximum(u, v), w)
        outside = np.sqrt(np.maximum(u, 0) ** 2 + np.maximum(v, 0) ** 2 + np.maximum(w, 0) ** 2)
        return np.where(deep > 0, outside, np.minimum(-deep, INNER))

    return distances


def lying() -> Distances:
    """Turned about a horizontal axis, on the surface: p = (x, y, yaw of the axis, radius, length)."""

    def distances(p: Array, points: Array) -> Array:
        x, y, yaw, r, length = (p[:, i, None] for i in range(5))
        c, s = np.cos(yaw), np.sin(yaw)
        dx, dy = points[:, 0] - x, points[:, 1] - y
        along = np.abs(c * dx + s * dy) - length / 2
        side = np.hypot(c * dy - s * dx, points[:, 2] - r) - r
        outside = np.hypot(np.maximum(side, 0.0), np.maximum(along, 0.0))
        deep = np.maximum(side, along)
        return np.where(deep > 0, outside, np.minimum(-deep, INNER))

    return distances


def fit(
    distances: Distances,
    ends: Ends,
    start: Array,
    points: Array,
    outline: Silhouette,
    noise: float,
    prior: tuple[Array, Array] | None = None,
) -> Solution:
    """The parameters that explain points (n, 3) and the silhouette best, from `start` (k,).

    `noise` [m]: the points'. `prior`: expected parameters (k,) and their standard deviations, for what no point shows.
    """
    count = len(start)
    shifts = np.concatenate([np.zeros((1, count)), STEP * np.eye(count)])

    def off(p: Array) -> tuple[Array, Array]:
        many = p + shifts
        parts = [distances(many, points), END_WEIGHT * ends(outline, many)]
        if prior is not None:
            parts.append(noise * (many - prior[0]) / prior[1])
        apart = np.concatenate(parts, axis=1)
        return apart[0], ((apart[1:] - apart[0]) / STEP).T

    p = solve(off, start, max(ROBUST, 1.5 * noise), TRIES)[0]
    if prior is not None and (p - prior[0] > STRAYED * prior[1]).any():
        p = start
    apart, slopes = off(p)
    left = np.abs(apart[: len(points)])
    # Neighbouring points share their noise: a fifth of them counts.
    scale = max(noise, float(np.sqrt(np.mean(np.minimum(left, 0.02) ** 2))))
    weight = 1.0 / (1.0 + (apart / ROBUST) ** 2)
    information = (slopes * weight[:, None]).T @ slopes / (5 * scale * scale) + np.eye(count) * 25.0
    covariance = np.linalg.inv(information)
    return Solution(p, np.asarray(covariance, np.float64), float(np.minimum(left, 0.02).mean()))


def rectangle(plan: Array, turns: int) -> list[tuple[float, float, Array, Array]]:
    """Rectangles around points (n, 2): area [m2], yaw [rad], extents (2,) and middle (2,), the smallest first."""
    yaws = np.arange(turns) * (math.pi / 2 / turns)
    c, s = np.cos(yaws), np.sin(yaws)
    turn = np.stack([np.stack([c, -s], 1), np.stack([s, c], 1)], 1)
    local = np.sort(plan @ turn, axis=1)
    strays = round(STRAYS * (len(plan) - 1))
    low, high = local[:, strays], local[:, len(plan) - 1 - strays]
    middles = np.einsum("tij,tj->ti", turn, (low + high) / 2)
    areas = (high - low).prod(axis=1)
    return [(float(areas[n]), float(yaws[n]), high[n] - low[n], middles[n]) for n in np.argsort(areas, kind="stable")]


def quantile(values: Array, share: float) -> float:
    """The value (n,) below which that share of the others lies."""
    place = round(share * (len(values) - 1))
    return float(np.partition(values, place)[place])


def top_of(points: Array, noise: float) -> float:
    """Height [m] of the top of points (n, 3): of its flat part when there is one. `noise` [m]: of the heights."""
    z = points[:, 2]
    high = quantile(z, 0.98)
    flat: NDArray[np.float64] = z[z > high - 3.5 * noise - 0.002]
    return float(np.median(flat)) if len(flat) > 0.25 * len(z) else high


def solidity(points: Array, eye: Array) -> float:
    """Area that points (n, 3) cover as seen from `eye` (3,), by that of its convex hull: 1 for what is convex."""
    rays = points - eye
    away = rays.mean(axis=0)
    away /= np.linalg.norm(away)
    side = np.cross(away, (0.0, 0.0, 1.0))
    side /= max(1e-6, float(np.linalg.norm(side)))
    flat = np.stack([rays @ side, rays @ np.cross(side, away)], axis=1) / (rays @ away)[:, None]
    low, extent = flat.min(axis=0), float(np.ptp(flat, axis=0).max())
    cell = extent / float(np.clip(math.sqrt(len(points)) / 1.8, 3.0, CELLS))
    grid = np.unique(np.floor((flat - low) / cell), axis=0)
    corners = (grid[:, None] + [(0, 0), (0, 1), (1, 0), (1, 1)]).reshape(-1, 2)
    return float(len(grid) / ConvexHull(corners).volume)
