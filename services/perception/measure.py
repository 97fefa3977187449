"""What an object that nobody listed is: shape family, pose and extents of one segment, from its points alone. Pure.

Every primitive that its outline allows is fitted with free parameters; the one that explains points and silhouette
best is the shape. What no primitive explains is `irregular`: its oriented extents are reported.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Array
from common.messages import ShapeFamily
from services.perception import primitives
from services.perception.primitives import Silhouette, Solution

SAMPLE = 180
"""Points of a segment that are used, evenly spread. Chosen: more only takes longer."""
SLICES = 8
"""Pieces of the height in which the radius of a turned shape is read off."""
LEVEL = math.pi / 2
"""Tilt [rad] of what lies on its side."""
IRREGULAR, IRREGULAR_NOISE = 0.003, 0.8
"""Mean distance [m], plus that of noise, from which on no primitive explains the points."""
LONG = 1.6
"""Length by width from which what lies is long. Chosen: cans on their side have 1.4 and more."""
CAVITY = 0.06
"""Share of the points that are seen through the plane of the rim, from which an object is hollow. Chosen: a mug at 2 m
shows three times as much."""
HANDLE = 0.012
"""Distance [m] beyond the wall from which points belong to a handle."""
SOLID, GAPS = 0.86, 0.02
"""Share of its convex hull that the outline of a convex shape covers at least, and the distance [m] that what is
missing counts as. Chosen: boxes and balls have .90 and more, crossed arms half."""
COMPLEX = 0.06
"""What each free parameter costs, as a share of the residual: the simpler of two equal shapes is taken."""


@dataclass(frozen=True)
class Measurement:
    """Pose and extents [m] of a segment. `x`, `y`: the middle; `size`: own extents, of what lies the first along `yaw`.

    `tilt` [rad] as in `WorldObject`; `residual` [m]: mean distance of the points; `spread` [m]: standard deviation of
    extents and position. `profile` (SLICES,): radius by the widest, from the foot up; `hollow`: it is open above;
    `handle`: yaw [rad] of one that was seen, nan without.
    """

    family: ShapeFamily
    x: float
    y: float
    yaw: float
    size: Vec3
    residual: float
    spread: float
    tilt: float = 0.0
    profile: tuple[float, ...] = ()
    hollow: bool = False
    handle: float = math.nan
    free: int = 4


def measure(
    points: Array, floor: float, camera: Array, seen: tuple[bool, bool], half_pixel: float, noise: float
) -> Measurement:
    """The shape of points (n, 3) [map] that stand on height `floor` and were seen from `camera` (3,).

    `seen`: its right and left end are in view; `half_pixel` [rad]; `noise`: standard deviation [m] of the points.
    """
    local = points - (0.0, 0.0, floor)
    used = local[:: max(1, len(local) // SAMPLE)]
    outline = primitives.silhouette(local, camera, seen, half_pixel)
    eye = camera - (0.0, 0.0, floor)
    steep = abs(eye[2] - local[:, 2].mean()) / max(1e-3, float(np.linalg.norm(eye - local.mean(axis=0))))
    h = max(0.008, primitives.top_of(local, noise * steep))
    shapes = [_box(used, h, outline, noise)]
    _, _, extents, _ = primitives.rectangle(used[:, :2], 12)[0]
    wide, narrow = float(extents.max()), float(extents.min())
    if narrow > 0.45 * wide or not all(seen):
        shapes.append(_turned(used, h, outline, eye, noise))
    if 0.6 < h / wide < 1.5:
        shapes.append(_ball(used, h, outline, noise))
    if wide > 1.15 * h:
        shapes += _lying(used, h, outline, noise)
    gaps = GAPS * max(0.0, SOLID - primitives.solidity(local, eye))
    shapes = [replace(s, residual=s.residual + gaps) if s.family != "round" or s.tilt else s for s in shapes]
    best = min(shapes, key=lambda s: s.residual + COMPLEX * s.free * (0.001 + 0.3 * noise))
    if best.residual > IRREGULAR + IRREGULAR_NOISE * noise:
        best = _irregular(used, h, noise, best.residual)
    return replace(best, yaw=math.remainder(best.yaw, math.tau))


def _spread(solution: Solution, entries: slice) -> float:
    return float(np.sqrt(np.diag(solution.covariance)[entries].mean()))


def _start(points: Array, outline: Silhouette) -> tuple[Array, float]:
    """Middle (2,) of the front of the points moved back by half their width, and that half [m]."""
    wide = outline.ends[1] - outline.ends[0]
    local = points[:, :2] - outline.camera
    across = np.array([-math.sin(outline.ahead), math.cos(outline.ahead)])
    r = float(np.ptp(local @ across)) / 2 if math.isnan(wide) else float(outline.distance * math.tan(wide / 2))
    r = max(r, 0.008)
    away = np.array([math.cos(outline.ahead), math.sin(outline.ahead)])
    depth = local @ away
    middle = points[:, :2].mean(axis=0)
    front = float(np.percentile(depth, 4))
    return middle + away * (front + r - float(depth.mean())), r


def _turned(points: Array, h: float, outline: Silhouette, eye: Array, noise: float) -> Measurement:
    (x, y), r = _start(points, outline)
    solution = primitives.fit(
        primitives.turned(h), primitives.round_ends(h / 2), np.array([x, y, r, 0.0]), points, outline, noise,
        (np.array([x, y, r, 0.0]), np.array([1.0, 1.0, 1.0, 0.5])),
    )  # fmt: skip
    x, y, r, grows = (float(v) for v in solution.p)
    rho = np.hypot(points[:, 0] - x, points[:, 1] - y)
    radii = _profile(points, rho, h, outline, x, y, r)
    widest = max(0.006, r + abs(grows) * h / 2)
    radii = np.minimum(radii, widest)
    level = np.clip((points[:, 2] / h * SLICES).astype(int), 0, SLICES - 1)
    hollow = _hollow(points, x, y, float(radii[-1]), h, eye, noise)
    deep = (rho < radii[level] - primitives.INNER) & (points[:, 2] < h - primitives.INNER)
    steps = np.interp(points[:, 2], (np.arange(SLICES) + 0.5) * h / SLICES, radii)
    wall = np.abs(rho - steps)
    # A shoulder is level: it lies between the radii of the slices that it parts.
    lower, upper = radii[np.maximum(level - 1, 0)], radii[np.minimum(level + 1, SLICES - 1)]
    shoulder = (rho < np.maximum(lower, steps)) & (rho > np.minimum(upper, steps))
    cap = np.abs(points[:, 2] - h)
    off = np.where(shoulder, np.minimum(wall, noise), wall)
    off = np.where(rho < steps, np.minimum(off, cap), off)
    off = np.where(deep, np.minimum(off, noise if hollow else 0.02), off)
    outside = (rho > steps + HANDLE) & (rho < steps + 0.045) & (points[:, 2] < 0.95 * h)
    handle = math.nan
    if np.count_nonzero(outside) >= max(5, 0.02 * len(points)) and np.count_nonzero(outside) < 0.25 * len(points):
        handle = math.atan2(float(points[outside, 1].mean()) - y, float(points[outside, 0].mean()) - x)
        off = np.where(outside, noise, off)
    size = (2 * widest, 2 * widest, h)
    flared = grows > 0.25 or radii[-1] > 1.25 * radii[1]
    bowl = hollow and (flared or h < 1.1 * widest)
    shape: ShapeFamily = "bowl" if bowl else "round"
    return Measurement(
        shape, x, y, 0.0 if math.isnan(handle) else handle, size, float(np.minimum(off, 0.02).mean()),
        _spread(solution, slice(0, 3)), profile=tuple(round(float(v) / widest, 2) for v in radii), hollow=hollow,
        handle=handle, free=5,
    )  # fmt: skip


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
    radii = np.full(SLICES, np.nan)
    for k in range(SLICES):
        few = rho[front & (points[:, 2] >= k * h / SLICES) & (points[:, 2] < (k + 1) * h / SLICES)]
        if len(few) >= 4:
            radii[k] = np.median(few)
    known = ~np.isnan(radii)
    if not known.any():
        return np.full(SLICES, r)
    at = np.arange(SLICES)
    return np.asarray(np.interp(at, at[known], radii[known]))


def _ball(points: Array, h: float, outline: Silhouette, noise: float) -> Measurement:
    (x, y), r = _start(points, outline)
    start = np.array([x, y, (r + h / 2) / 2])
    solution = primitives.fit(primitives.ball(), primitives.round_ends(0.0), start, points, outline, noise)
    x, y, r = (float(v) for v in solution.p)
    off = solution.residual + 0.3 * max(0.0, abs(2 * r - h) - 0.004 - noise)
    return Measurement("ball", x, y, 0.0, (2 * r, 2 * r, 2 * r), off, _spread(solution, slice(0, 3)), free=3)


def _box(points: Array, h: float, outline: Silhouette, noise: float) -> Measurement:
    away = np.array([math.cos(outline.ahead), math.sin(outline.ahead)])
    tried, ends = [], primitives.corner_ends(lies=False)
    for _, yaw, extents, middle in primitives.rectangle(points[:, :2], 12)[:2]:
        # Of what shows one face only the depth is a guess: as deep as it is wide, moved back.
        length, width = (max(float(e), 0.01) for e in extents)
        start = np.array([*middle, yaw, length, width])
        wide = np.array([1.0, 1.0, 1.0, 0.3, 0.3])
        if min(length, width) < 0.35 * max(length, width) and h > 0.06 and _front_only(points, h):
            thin = 4 if width < length else 3
            guess = 0.7 * max(length, width)
            start[:2] += away * (guess - start[thin]) / 2
            start[thin], wide[thin] = guess, 0.02
        tried.append(primitives.fit(primitives.box(h), ends, start, points, outline, noise, (start, wide)))
    solution = min(tried, key=lambda s: s.residual)
    x, y, yaw, length, width = (float(v) for v in solution.p)
    length, width = max(0.008, abs(length)), max(0.008, abs(width))
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    yaw = math.remainder(yaw, math.pi)
    spread = float(np.sqrt(np.diag(solution.covariance)[[0, 1, 3, 4]].max()))
    unlikely = 0.0015 if width < 0.3 * min(length, h) else 0.0
    return Measurement("box", x, y, yaw, (length, width, h), solution.residual + unlikely, spread, free=5)


def _front_only(points: Array, h: float) -> bool:
    """Hardly any point is of the top."""
    return bool(np.mean(points[:, 2] > h - 0.01) < 0.08)


def _lying(points: Array, h: float, outline: Silhouette, noise: float) -> list[Measurement]:
    """Turned and on its side: along the longer side of its outline, which may begin at either end."""
    _, yaw, extents, middle = primitives.rectangle(points[:, :2], 24)[0]
    if extents[1] > extents[0]:
        yaw, extents = yaw + math.pi / 2, extents[::-1]
    start = np.array([*middle, yaw, h / 2, float(extents[0])])
    wide, ends = np.array([1.0, 1.0, 1.0, 0.004, 0.5]), primitives.corner_ends(lies=True)
    solution = primitives.fit(primitives.lying(), ends, start, points, outline, noise, (start, wide))
    x, y, yaw, r, length = (float(v) for v in solution.p)
    if r < 0.006 or length < LONG * 0.7 * 2 * r:
        return []
    c, s = math.cos(yaw), math.sin(yaw)
    dx, dy = points[:, 0] - x, points[:, 1] - y
    along, rho = c * dx + s * dy, np.hypot(c * dy - s * dx, points[:, 2] - r)
    radii = np.full(SLICES, np.nan)
    level = np.clip(((along / length + 0.5) * SLICES).astype(int), 0, SLICES - 1)
    for k in range(SLICES):
        if np.count_nonzero(level == k) >= 4:
            radii[k] = np.median(rho[level == k])
    known = ~np.isnan(radii)
    at = np.arange(SLICES)
    radii = np.interp(at, at[known], radii[known]) if known.any() else np.full(SLICES, r)
    if radii[:2].mean() < 0.8 * radii[-2:].mean():
        # The narrow end is the top, where the axis points to.
        radii, along, yaw = radii[::-1], -along, yaw + math.pi
    steps = np.interp(along / length + 0.5, (at + 0.5) / SLICES, radii)
    beyond = np.abs(along) - length / 2
    # The end that faces the camera is flat, or open.
    end = np.minimum(np.abs(beyond), primitives.INNER)
    off = np.where(rho < steps, np.minimum(steps - rho, end), np.hypot(rho - steps, np.maximum(beyond, 0.0)))
    r = float(radii.max())
    found = Measurement(
        "long" if length > LONG * 2 * r else "round", x, y, yaw, (length, 2 * r, 2 * r),
        float(np.minimum(off, 0.02).mean()), _spread(solution, slice(0, 4)), tilt=LEVEL,
        profile=tuple(round(float(v) / max(r, 1e-3), 2) for v in radii), free=6,
    )  # fmt: skip
    return [found]


def _irregular(points: Array, h: float, noise: float, residual: float) -> Measurement:
    """Oriented extents of what is no primitive: the best of these leaves `residual` [m]."""
    _, yaw, extents, middle = primitives.rectangle(points[:, :2], 12)[0]
    length, width = (max(float(e), 0.01) for e in extents)
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    x, y = (float(v) for v in middle)
    return Measurement("irregular", x, y, math.remainder(yaw, math.pi), (length, width, h), residual, 0.01 + noise)
