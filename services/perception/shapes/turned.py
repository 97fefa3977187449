"""Turned shapes with a free profile that stand upright, fitted to the points of one view. Pure."""

import math

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.messages import ShapeFamily
from services.perception.shapes import primitives
from services.perception.shapes.measurement import SLICES, Measurement
from services.perception.shapes.primitives import Silhouette, Solution
from services.perception.shapes.upper_end import through, upper_end

CAVITY = 0.06
"""Share of the points that are seen through the plane of the rim, from which an object is hollow. Chosen: a mug at 2 m
shows three times as much."""
SURELY, INSIDE = 0.8, 0.97
"""Shares of the rim's radius within which what is seen through it tells that there is an inside, and belongs to it."""
DEEP, SHALLOW = 0.012, 0.4
"""How far [m] below its rim the inside of an object is, and which share of its height where it is low: a plate's."""
HANDLE = 0.012
"""Distance [m] beyond the wall from which points belong to a handle."""
HANDLE_REACH = 0.05
"""How far [m] beyond the wall a handle reaches at most."""
HANDLE_SHARE = (0.025, 0.3)
"""Least and most share of the points that are of a handle."""
ONE_SIDE = 0.8
"""Mean of the unit vectors towards a handle's points, from which they are on one side."""
BODY = 12
"""Fewest points of what is beside a handle: with fewer the fit is off, and what is beyond its wall is no handle."""
VESSEL = (0.05, 0.17)
"""Least and most height [m] of what is tried with a handle."""


WIDER, WIDTH_COST = 1.15, 0.3
"""Width of a turned shape by that of its outline up to which it may be one, and the share of what it is wider that
counts as off. Chosen: the error of an outline at 2 m; as a ball's height counts."""
HALF_HIDDEN = 2.0
"""The same, by what is seen of it, where an end is hidden: what shows less of itself tells no width."""


def spread(solution: Solution, entries: slice) -> float:
    """Standard deviation [m] of parameters."""
    return float(np.sqrt(np.diag(solution.covariance)[entries].mean()))


def start(points: Array, outline: Silhouette) -> tuple[Array, float]:
    """Middle (2,) of the front of the points moved back by half their width, and that half [m]."""
    wide = outline.ends[1] - outline.ends[0]
    local = points[:, :2] - outline.camera
    across = np.array([-math.sin(outline.ahead), math.cos(outline.ahead)])
    r = float(np.ptp(local @ across)) / 2 if math.isnan(wide) else float(outline.distance * math.tan(wide / 2))
    r = max(r, 0.008)
    away = np.array([math.cos(outline.ahead), math.sin(outline.ahead)])
    depth = local @ away
    return points[:, :2].mean(axis=0) + away * (float(np.percentile(depth, 4)) + r - float(depth.mean())), r


def standing(
    points: Array, h: float, outline: Silhouette, eye: Array, noise: float, of_handle: NDArray[np.bool_]
) -> Measurement:
    """The turned shape of height `h` [m] that explains points (n, 3) seen from `eye` (3,), perhaps with a handle.

    `of_handle` (n,): the points that are of one by the picture.
    """
    body, handle = np.ones(len(points), bool), math.nan
    solution = _upright(points, h, outline, noise)
    if VESSEL[0] < h < VESSEL[1] and of_handle.any() and np.count_nonzero(~of_handle) >= BODY:
        own = primitives.silhouette(points[~of_handle], np.append(outline.camera, 0.0), seen_ends(outline), 0.0)
        alone = _upright(points[~of_handle], h, own, noise)
        towards = points[of_handle, :2].mean(axis=0) - alone.p[:2]
        if float(np.hypot(*towards)) > alone.p[2]:
            body, solution, handle = ~of_handle, alone, math.atan2(towards[1], towards[0])
    if math.isnan(handle) and VESSEL[0] < h < VESSEL[1] and h > 0.5 * solution.p[2]:
        # A handle makes the silhouette wider: without the silhouette its points are off the wall.
        hidden = primitives.Silhouette(outline.camera, outline.ahead, np.full(2, np.nan), outline.distance)
        alone = _upright(points, h, hidden, noise)
        x, y, r = (float(v) for v in alone.p[:3])
        rho = np.hypot(points[:, 0] - x, points[:, 1] - y)
        beyond = (rho > r + HANDLE) & (rho < r + HANDLE_REACH) & (points[:, 2] < 0.95 * h)
        wall = rho < r + HANDLE / 2
        if (
            r < solution.p[2] - 0.003
            and np.count_nonzero(wall) >= BODY
            and _on_one_side(points[:, :2] - (x, y), beyond)
        ):
            body = wall
            rest = points[body]
            own = primitives.silhouette(rest, np.append(outline.camera, 0.0), seen_ends(outline), 0.0)
            solution = _upright(rest, h, own, noise)
            handle = math.atan2(*(points[beyond, :2].mean(axis=0) - solution.p[:2])[::-1])
    x, y, r, grows = (float(v) for v in solution.p)
    rho = np.hypot(points[:, 0] - x, points[:, 1] - y)
    widest = max(0.006, r + abs(grows) * h / 2)
    # A vessel's floor and far wall, seen from above, are not the wall that faces the camera.
    inner = _within(points, x, y, INSIDE * widest, h, eye, noise)
    outer = body & ~inner
    radii = np.minimum(_profile(points[outer], rho[outer], h, outline, x, y, r), widest)
    level = np.clip((points[:, 2] / h * SLICES).astype(int), 0, SLICES - 1)
    hollow = bool(
        np.count_nonzero(_within(points, x, y, SURELY * float(radii[-1]), h, eye, noise)) > CAVITY * len(points)
    )
    deep = (rho < radii[level] - primitives.INNER) & (points[:, 2] < h - primitives.INNER)
    steps = np.interp(points[:, 2], (np.arange(SLICES) + 0.5) * h / SLICES, radii)
    wall = np.abs(rho - steps)
    # A shoulder is level: it lies between the radii of the slices that it parts.
    lower, upper = radii[np.maximum(level - 1, 0)], radii[np.minimum(level + 1, SLICES - 1)]
    shoulder = (rho < np.maximum(lower, steps)) & (rho > np.minimum(upper, steps))
    off = np.where(shoulder, np.minimum(wall, noise), wall)
    off = np.where(rho < steps, np.minimum(off, np.abs(points[:, 2] - h)), off)
    off = np.where(deep, np.minimum(off, noise if hollow else 0.02), off)
    off = np.where(body & ~(inner & hollow), off, np.minimum(off, noise))
    beyond = (rho > steps + HANDLE) & (rho < steps + HANDLE_REACH) & (points[:, 2] < 0.95 * h)
    if math.isnan(handle) and _on_one_side(points[:, :2] - (x, y), beyond):
        handle = math.atan2(*(points[beyond, :2].mean(axis=0) - (x, y))[::-1])
        off = np.where(beyond, np.minimum(off, noise), off)
    # Of what is turned the outline shows the whole width; nan where an end is hidden.
    shown = WIDER * outline.distance * float(np.ptp(outline.ends))
    if math.isnan(shown):
        shown = HALF_HIDDEN * max(h, float(np.ptp(points[:, :2], axis=0).max()))
    beyond_it = 2 * widest - shown - noise
    too_wide = WIDTH_COST * beyond_it if beyond_it > 0.0 else 0.0
    flared = grows > 0.25 or radii[-1] > 1.25 * radii[1]
    # Past a neck one looks as well.
    closed = not hollow and upper_end(points, (x, y), float(radii[-2]), h, eye, noise) == "closed"
    shape: ShapeFamily = "bowl" if hollow and (flared or h < 1.1 * widest) else "round"
    return Measurement(
        shape, x, y, 0.0 if math.isnan(handle) else handle, (2 * widest, 2 * widest, h),
        float(np.minimum(off, 0.02).mean()) + too_wide, spread(solution, slice(0, 3)),
        profile=tuple(round(float(v) / widest, 2) for v in radii), hollow=hollow, handle=handle, free=5,
        end="open" if hollow else "closed" if closed else "",
    )  # fmt: skip


def _upright(points: Array, h: float, outline: Silhouette, noise: float) -> Solution:
    (x, y), r = start(points, outline)
    begin = np.array([x, y, r, 0.0])
    prior = begin, np.array([1.0, 1.0, 1.0, 0.5])
    return primitives.fit(primitives.turned(h), primitives.round_ends(h / 2), begin, points, outline, noise, prior)


def seen_ends(outline: Silhouette) -> tuple[bool, bool]:
    return not math.isnan(outline.ends[0]), not math.isnan(outline.ends[1])


def _on_one_side(from_axis: Array, beyond: NDArray[np.bool_]) -> bool:
    """Points beyond the wall are of a handle: neither few nor many, and all on the same side of the axis."""
    count = np.count_nonzero(beyond)
    if count < 5 or not HANDLE_SHARE[0] < count / len(beyond) < HANDLE_SHARE[1]:
        return False
    towards = from_axis[beyond]
    towards = towards / np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-6)
    return bool(np.linalg.norm(towards.mean(axis=0)) > ONE_SIDE)


def _within(points: Array, x: float, y: float, rim: float, h: float, eye: Array, noise: float) -> NDArray[np.bool_]:
    """Which points (n, 3) are well below the rim and seen through its plane: they are of the inside."""
    low = points[:, 2] < h - max(min(DEEP, SHALLOW * h), 2.5 * noise)
    return low & through(points, (x, y), rim, h, eye)


def _profile(points: Array, rho: Array, h: float, outline: Silhouette, x: float, y: float, r: float) -> Array:
    """Radius (SLICES,) at the heights of a turned shape: the median of the wall that faces the camera."""
    facing = (points[:, 0] - x) * (outline.camera[0] - x) + (points[:, 1] - y) * (outline.camera[1] - y)
    front = facing > 0.2 * rho * np.hypot(outline.camera[0] - x, outline.camera[1] - y)
    return filled(profile(rho[front], points[front, 2] / h, 0.5), r)


def profile(rho: Array, share: Array, quantile: float) -> Array:
    """Radius (SLICES,) [m] by the share of the axis, 0 to 1: a quantile of the points there; nan if they are few."""
    level = np.clip((share * SLICES).astype(int), 0, SLICES - 1)
    return np.array(
        [np.quantile(rho[level == k], quantile) if np.count_nonzero(level == k) >= 4 else np.nan for k in range(SLICES)]
    )


def filled(radii: Array, otherwise: float) -> Array:
    """Radii (SLICES,) [m] with those that are not known between those that are; `otherwise` where none is."""
    known = ~np.isnan(radii)
    at = np.arange(SLICES)
    return np.asarray(np.interp(at, at[known], radii[known])) if known.any() else np.full(SLICES, otherwise)
