"""Turned shapes with a free profile, fitted to the points of one view: upright, or lying on their side. Pure."""

import math

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.messages import ShapeFamily
from services.perception import primitives
from services.perception.measurement import LEVEL, SLICES, Measurement
from services.perception.primitives import Silhouette, Solution

LONG = 1.6
"""Length by width from which what lies is long. Chosen: cans on their side have 1.4 and more."""
CAVITY = 0.06
"""Share of the points that are seen through the plane of the rim, from which an object is hollow. Chosen: a mug at 2 m
shows three times as much."""
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
SQUARE = 0.12
"""Credit for a round thing on its side: a box would need two sides that are alike to look the same, and few have."""


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


def standing(points: Array, h: float, outline: Silhouette, eye: Array, noise: float) -> Measurement:
    """The turned shape of height `h` [m] that explains points (n, 3) seen from `eye` (3,), perhaps with a handle."""
    body, handle = np.ones(len(points), bool), math.nan
    solution = _upright(points, h, outline, noise)
    if VESSEL[0] < h < VESSEL[1] and h > 0.5 * solution.p[2]:
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
            own = primitives.silhouette(rest, np.append(outline.camera, 0.0), _seen(outline), 0.0)
            solution = _upright(rest, h, own, noise)
            handle = math.atan2(*(points[beyond, :2].mean(axis=0) - solution.p[:2])[::-1])
    x, y, r, grows = (float(v) for v in solution.p)
    rho = np.hypot(points[:, 0] - x, points[:, 1] - y)
    widest = max(0.006, r + abs(grows) * h / 2)
    radii = np.minimum(_profile(points[body], rho[body], h, outline, x, y, r), widest)
    level = np.clip((points[:, 2] / h * SLICES).astype(int), 0, SLICES - 1)
    hollow = _hollow(points, x, y, float(radii[-1]), h, eye, noise)
    deep = (rho < radii[level] - primitives.INNER) & (points[:, 2] < h - primitives.INNER)
    steps = np.interp(points[:, 2], (np.arange(SLICES) + 0.5) * h / SLICES, radii)
    wall = np.abs(rho - steps)
    # A shoulder is level: it lies between the radii of the slices that it parts.
    lower, upper = radii[np.maximum(level - 1, 0)], radii[np.minimum(level + 1, SLICES - 1)]
    shoulder = (rho < np.maximum(lower, steps)) & (rho > np.minimum(upper, steps))
    off = np.where(shoulder, np.minimum(wall, noise), wall)
    off = np.where(rho < steps, np.minimum(off, np.abs(points[:, 2] - h)), off)
    off = np.where(deep, np.minimum(off, noise if hollow else 0.02), off)
    off = np.where(body, off, np.minimum(off, noise))
    beyond = (rho > steps + HANDLE) & (rho < steps + HANDLE_REACH) & (points[:, 2] < 0.95 * h)
    if math.isnan(handle) and _on_one_side(points[:, :2] - (x, y), beyond):
        handle = math.atan2(*(points[beyond, :2].mean(axis=0) - (x, y))[::-1])
        off = np.where(beyond, np.minimum(off, noise), off)
    flared = grows > 0.25 or radii[-1] > 1.25 * radii[1]
    shape: ShapeFamily = "bowl" if hollow and (flared or h < 1.1 * widest) else "round"
    return Measurement(
        shape, x, y, 0.0 if math.isnan(handle) else handle, (2 * widest, 2 * widest, h),
        float(np.minimum(off, 0.02).mean()), spread(solution, slice(0, 3)),
        profile=tuple(round(float(v) / widest, 2) for v in radii), hollow=hollow, handle=handle, free=5,
    )  # fmt: skip


def _upright(points: Array, h: float, outline: Silhouette, noise: float) -> Solution:
    (x, y), r = start(points, outline)
    begin = np.array([x, y, r, 0.0])
    prior = begin, np.array([1.0, 1.0, 1.0, 0.5])
    return primitives.fit(primitives.turned(h), primitives.round_ends(h / 2), begin, points, outline, noise, prior)


def _seen(outline: Silhouette) -> tuple[bool, bool]:
    return not math.isnan(outline.ends[0]), not math.isnan(outline.ends[1])


def _on_one_side(from_axis: Array, beyond: NDArray[np.bool_]) -> bool:
    """Points beyond the wall are of a handle: neither few nor many, and all on the same side of the axis."""
    count = np.count_nonzero(beyond)
    if count < 5 or not HANDLE_SHARE[0] < count / len(beyond) < HANDLE_SHARE[1]:
        return False
    towards = from_axis[beyond]
    towards = towards / np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-6)
    return bool(np.linalg.norm(towards.mean(axis=0)) > ONE_SIDE)


def _hollow(points: Array, x: float, y: float, rim: float, h: float, eye: Array, noise: float) -> bool:
    """Points well below the rim are seen through the plane of the rim."""
    low = points[points[:, 2] < h - max(0.012, 2.5 * noise)]
    if eye[2] < h + 0.02 or not len(low):
        return False
    through = eye + (low - eye) * ((h - eye[2]) / (low[:, 2] - eye[2]))[:, None]
    inside = np.hypot(through[:, 0] - x, through[:, 1] - y) < 0.8 * rim
    return bool(np.count_nonzero(inside) > CAVITY * len(points))


def _profile(points: Array, rho: Array, h: float, outline: Silhouette, x: float, y: float, r: float) -> Array:
    """Radius (SLICES,) at the heights of a turned shape: the median of the wall that faces the camera."""
    facing = (points[:, 0] - x) * (outline.camera[0] - x) + (points[:, 1] - y) * (outline.camera[1] - y)
    front = facing > 0.2 * rho * np.hypot(outline.camera[0] - x, outline.camera[1] - y)
    return _medians(rho[front], points[front, 2] / h, r)


def _medians(rho: Array, share: Array, otherwise: float) -> Array:
    """Median radius (SLICES,) of points by their share of the axis, 0 to 1; between known ones where there are few."""
    level = np.clip((share * SLICES).astype(int), 0, SLICES - 1)
    radii = np.array(
        [np.median(rho[level == k]) if np.count_nonzero(level == k) >= 4 else np.nan for k in range(SLICES)]
    )
    known = ~np.isnan(radii)
    at = np.arange(SLICES)
    return np.asarray(np.interp(at, at[known], radii[known])) if known.any() else np.full(SLICES, otherwise)


def lying(points: Array, h: float, outline: Silhouette, eye: Array, noise: float) -> list[Measurement]:
    """The turned shape on its side, `h` [m] high, that explains points (n, 3): along their outline, or across it."""
    _, yaw, extents, middle = primitives.rectangle(points[:, :2], 24)[0]
    if extents[1] > extents[0]:
        yaw, extents = yaw + math.pi / 2, extents[::-1]
    found = [_lying_along(points, h, outline, eye, noise, np.array([*middle, yaw, h / 2, float(extents[0])]))]
    if extents[0] < 1.4 * extents[1]:
        # A handle beside it makes it as wide as it is long.
        across = np.array([*middle, yaw + math.pi / 2, h / 2, float(extents[1])])
        found.append(_lying_along(points, h, outline, eye, noise, across))
    return [m for m in found if m is not None]


def _lying_along(
    points: Array, h: float, outline: Silhouette, eye: Array, noise: float, begin: Array
) -> Measurement | None:
    ends = primitives.corner_ends(lies=True)
    prior = begin, np.array([1.0, 1.0, 1.0, 0.003, 0.5])
    body, handle = np.ones(len(points), bool), math.nan
    solution = primitives.fit(primitives.lying(), ends, begin, points, outline, noise, prior)
    x, y, yaw, r, length = (float(v) for v in solution.p)
    beside = -math.sin(yaw) * (points[:, 0] - x) + math.cos(yaw) * (points[:, 1] - y)
    far = np.abs(beside)
    beyond = (far > h / 2 + HANDLE) & (far < h / 2 + HANDLE_REACH + HANDLE)
    wall = far < h / 2 + HANDLE / 2
    has_handle = np.count_nonzero(wall) >= BODY and HANDLE_SHARE[0] < beyond.mean() < HANDLE_SHARE[1]
    if VESSEL[0] < length < VESSEL[1] and has_handle:
        body = wall
        own = primitives.silhouette(points[body], np.append(outline.camera, 0.0), _seen(outline), 0.0)
        solution = primitives.fit(primitives.lying(), ends, begin, points[body], own, noise, prior)
        x, y, yaw, r, length = (float(v) for v in solution.p)
        side = float(np.sign(np.median(beside[beyond])))
        handle = yaw + side * math.pi / 2
    if r < 0.006 or length < 2.1 * r:
        return None
    dx, dy = points[:, 0] - x, points[:, 1] - y
    along = math.cos(yaw) * dx + math.sin(yaw) * dy
    rho = np.hypot(math.cos(yaw) * dy - math.sin(yaw) * dx, points[:, 2] - r)
    hollow = _open_end(points, along, rho, r, length, math.cos(yaw) * (eye[0] - x) + math.sin(yaw) * (eye[1] - y))
    radii = np.minimum(_medians(rho[body], along[body] / length + 0.5, r), 1.1 * r)
    steps = np.interp(along / length + 0.5, (np.arange(SLICES) + 0.5) / SLICES, radii)
    beyond_end = np.abs(along) - length / 2
    # The end that faces the camera is flat, or open.
    end = np.minimum(np.abs(beyond_end), primitives.INNER)
    off = np.where(rho < steps, np.minimum(steps - rho, end), np.hypot(rho - steps, np.maximum(beyond_end, 0.0)))
    off = np.where(body & ~(hollow & (rho < steps - primitives.INNER)), off, np.minimum(off, noise))
    flip = _top_is_behind(
        radii, hollow, not math.isnan(handle), math.cos(yaw) * (eye[0] - x) + math.sin(yaw) * (eye[1] - y)
    )
    if flip:
        radii, yaw = radii[::-1], yaw + math.pi
    shape: ShapeFamily = "long" if length > LONG * 2 * r else "round"
    return Measurement(
        shape, x, y, yaw, (length, 2 * r, 2 * r), float(np.minimum(off, 0.02).mean()), spread(solution, slice(0, 4)),
        tilt=LEVEL, profile=tuple(round(float(v) / r, 2) for v in radii), hollow=hollow, handle=handle, free=6,
        credit=SQUARE,
    )  # fmt: skip


def _open_end(points: Array, along: Array, rho: Array, r: float, length: float, camera_along: float) -> bool:
    """Points inside the wall, well behind the end that faces the camera: it is open."""
    depth = length / 2 - along * math.copysign(1.0, camera_along)
    inside = (rho < r - primitives.INNER) & (depth > 0.02) & (depth < length)
    return bool(np.count_nonzero(inside) > CAVITY * len(points))


def _top_is_behind(radii: Array, hollow: bool, handle: bool, camera_along: float) -> bool:
    """Whether the axis must be turned round to point to the top: the open end, or the narrow one."""
    if hollow:
        return camera_along < 0
    if handle:
        return camera_along > 0
    return bool(radii[:2].mean() < 0.8 * radii[-2:].mean())
