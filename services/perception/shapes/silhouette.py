"""Shapes from the outline alone: what the picture shows of an object of which there is no depth. Pure.

What stands on a surface of known height and is seen as a whole has only one size and place, of each shape, that gives
its outline. Outlines are compared by their support functions: how far they reach in each direction of the picture.
The shapes are convex, so that they reach as far as their corners do.
"""

import math
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from common.geometry import Array
from common.messages import ShapeFamily
from services.perception.shapes import primitives, solids
from services.perception.shapes.handle import parted
from services.perception.shapes.least_squares import solve
from services.perception.shapes.measurement import LEVEL, SLICES, Measurement
from services.perception.views.view import View

Pixels = tuple[NDArray[np.intp], NDArray[np.intp]]
DIRECTIONS = 32
"""Directions of the picture in which outlines are compared."""
BEYOND = 0.35
"""How far [pixels] an outline reaches beyond the middle of its outermost pixel: between none and a whole pixel's width,
less where it is mixed with what is bright behind it."""
SAMPLE, FEW = 80, 20
"""Points with depth that are used, and how many of them count half."""
KNOWN = 4.0
"""Weight of a height that was measured, in directions of the outline."""
ROBUST, TRIES, STEP = 0.003, 15, 1e-5
"""Distance [m] beyond which a direction counts less, steps of the solver, and difference [m, rad] for slopes."""
PIXELS_OFF, MOST_OFF = 0.7, 0.0025
"""Mean distance of the outlines, in pixels and in metres [m] beside, up to which a shape explains the outline."""
SOLID = 0.78
"""Least share of its convex hull that a shape's outline covers: bottles with their necks .8, all others .95."""
UPRIGHT = 1.0
"""Standard deviation [pixels] of the middles of its rows from a line up to which an outline is that of something
turned, as narrow as it may be between its ends."""
SHOWN = 1.5
"""How far [pixels] from where it ends in a direction an outline must not be hidden to be known there."""
LEAST_SHOWN = 0.5
"""Share of the directions in which an outline has to be known."""
FLARED = 1.3
"""Radius above by that below from which a vessel is a bowl; what is turned and closed above is hardly ever."""
SIMPLER = 0.06
"""What each free parameter of a shape costs, as a share of half a pixel."""
FREE = 0.0015
"""Standard deviation [m] of extents beside that of the outline: edges of a picture are a pixel wide."""
THETAS = np.arange(DIRECTIONS) * math.tau / DIRECTIONS
TURNS = np.stack([np.cos(THETAS), np.sin(THETAS)])


@dataclass(frozen=True)
class Outline:
    """How far [rad] the body of an object reaches in the picture (DIRECTIONS,); `pixel` [m]: the size of a pixel
    there; `handle`: the middle (2,) [rad] in the picture of what is thin beside the body, None without.

    `top`: the body's first row, `widths` (n,) [m]: how wide each is from there on; `solid`: share of its convex hull
    that the body covers; `turned`: it is alike to both sides of an upright axis; `shown` (DIRECTIONS,): whether nothing
    hides how far it reaches.
    """

    reach: Array
    distance: float
    pixel: float
    handle: Array | None
    top: int
    widths: Array
    solid: float
    turned: bool
    shown: NDArray[np.bool_]


def foot(view: View, pixels: Pixels, floor: float) -> Array | None:
    """Where (3,) [map] the lowest pixels of an object touch the surface of height `floor` [m]; None where they look
    past it."""
    lowest = pixels[0] == pixels[0].max()
    ray = _ray(view, float(pixels[1][lowest].mean()), float(pixels[0].max()) + 0.5)
    if ray[2] > -1e-3:
        return None
    return np.asarray(view.position + ray * ((floor - view.position[2]) / ray[2]))


def _ray(view: View, column: float, row: float) -> Array:
    return np.asarray(view.rotation @ np.append(_rays(view, np.array([row]), np.array([column])), 1.0))


def outline(view: View, pixels: Pixels, at: Array, hidden: NDArray[np.bool_] | None = None) -> Outline:
    """The outline of an object's body; `at` (3,) [map] is about where it stands. `hidden` (n,): at which of its pixels
    something nearer begins."""
    distance = float((at - view.position) @ view.rotation[:, 2])
    pixel = distance / view.focal[0]
    rows, columns = pixels
    parts = parted(rows, columns, pixel)
    own = parts.of_body(rows, columns)
    reaches = _rays(view, rows[own], columns[own]) @ TURNS
    reach = reaches.max(axis=0)
    shown = np.ones(DIRECTIONS, bool)
    if hidden is not None and hidden[own].any():
        shown = reaches[hidden[own]].max(axis=0) < reach - SHOWN / view.focal[0]
    of_handle = parts.of_handle(rows, columns)
    handle = _rays(view, rows[of_handle], columns[of_handle]).mean(axis=0) if of_handle.any() else None
    filled = np.flatnonzero(parts.body.any(axis=1))
    widths = np.count_nonzero(parts.body, axis=1)[filled[0] : filled[-1] + 1] * pixel
    squares = (np.argwhere(parts.body)[:, None] + [(0, 0), (0, 1), (1, 0), (1, 1)]).reshape(-1, 2)
    solid = float(np.count_nonzero(parts.body) / ConvexHull(squares).volume)
    body = parts.body[filled[0] : filled[-1] + 1]
    first, last = body.argmax(axis=1), body.shape[1] - 1 - body[:, ::-1].argmax(axis=1)
    turned = bool(body.sum() == (last - first + 1).sum() and _off_line(first + last) < 2 * UPRIGHT)
    row = parts.row + int(filled[0])
    return Outline(reach + BEYOND / view.focal[0], distance, pixel, handle, row, widths, solid, turned, shown)


def _off_line(values: Array) -> float:
    """Standard deviation of values (n,) from the line that fits them best."""
    at = np.arange(len(values))
    return float(np.std(values - np.polyval(np.polyfit(at, values, 1), at))) if len(values) > 1 else 0.0


def _rays(view: View, rows: NDArray[Any], columns: NDArray[Any]) -> Array:
    """Where (n, 2) [rad] pixels are in the picture."""
    u, v = (columns + 0.5 - view.middle[0]) / view.focal[0], (rows + 0.5 - view.middle[1]) / view.focal[1]
    return np.stack([u, v], axis=1)


def shape(view: View, seen: Outline, at: Array, floor: float, points: Array) -> Measurement | None:
    """The shape that explains an outline best, and points (n, 3) [map] if there are any; None when none does.

    `at` (3,) [map]: the nearest point of its foot.
    """
    half = seen.distance * float(seen.reach[0] + seen.reach[DIRECTIONS // 2]) / 2
    if np.mean(seen.shown) < LEAST_SHOWN:
        return None
    away = at[:2] - view.position[:2]
    away = away / max(1e-6, float(np.linalg.norm(away)))
    # The uppermost ray reaches the far side of the top.
    top = _upmost(view, seen, at[:2] + 1.6 * half * away)
    h = min(max(top - floor, 0.01), 0.35)
    ahead = math.atan2(away[1], away[0])
    tried = []
    for foot_share in (1.0, 0.5):
        middle = at[:2] + away * half * foot_share
        tried.append(_fit(view, seen, solids.turned(floor), np.array([*middle, half * foot_share, half, h]), "round"))
    if 0.6 < h / (2 * half) < 1.6:
        tried.append(_fit(view, seen, solids.ball(floor), np.array([*(at[:2] + away * 0.4 * half), half]), "ball"))
    used = points[:: max(1, len(points) // SAMPLE)] - (0.0, 0.0, floor)
    # What is lit from above shows how high it is; an outline alone is also that of a lower and deeper box.
    heights = [math.nan, *([primitives.quantile(used[:, 2], 0.9)] if len(used) > FEW else [])]
    if not seen.shown.all():
        # How deep it is nobody knows: as deep as it is wide.
        heights = []
    for height, (yaw, slim) in product(heights, ((0.0, 1.0), (0.5, 1.0), (1.0, 1.0), (0.5, 2.5), (-0.5, 2.5))):
        # As wide across the line of sight as it is seen.
        c, s = abs(math.cos(yaw)), abs(math.sin(yaw))
        side = 2 * half / (slim * s + c)
        middle = at[:2] + away * side * (s + slim * c) / 2
        start = np.array([*middle, ahead + yaw, slim * side, side, h if math.isnan(height) else height])
        tried.append(_fit(view, seen, solids.box(floor), start, "box", height))
    if half > 0.6 * h and heights:
        for turn in (math.pi / 2, math.pi / 4, -math.pi / 4):
            start = np.array([*(at[:2] + away * h / 2), ahead + turn, h / 2, 2 * half / abs(math.sin(turn))])
            tried.append(_fit(view, seen, solids.lying(floor), start, "long"))
    best = min(tried, key=lambda m: m.residual + SIMPLER * m.free * 0.5 * seen.pixel + _beyond(m, used))
    stems = seen.turned and best.family in ("round", "bowl") and not best.tilt
    if best.residual > PIXELS_OFF * seen.pixel + MOST_OFF or (seen.solid < SOLID and not stems):
        return None
    if best.family == "round" and not best.tilt:
        best = replace(best, profile=_profile(view, seen, best, floor))
    if seen.handle is not None and best.family in ("round", "bowl") and not best.tilt:
        best = replace(best, handle=_beside(view, seen, best))
    return best


def _beyond(m: Measurement, points: Array) -> float:
    """How far [m] points (n, 3) over the surface are from a shape, in the mean; little counts where they are few."""
    if not len(points):
        return 0.0
    if m.family == "box":
        p, distances = np.array([m.x, m.y, m.yaw, *m.size[:2]]), primitives.box(m.size[2])
    elif m.family == "ball":
        p, distances = np.array([m.x, m.y, m.size[0] / 2]), primitives.ball()
    elif m.tilt:
        p, distances = np.array([m.x, m.y, m.yaw, m.size[1] / 2, m.size[0]]), primitives.lying()
    else:
        low, high = (share * m.size[0] / 2 for share in (m.profile[0], m.profile[-1]))
        p, distances = np.array([m.x, m.y, (low + high) / 2, (high - low) / m.size[2]]), primitives.turned(m.size[2])
    apart = np.minimum(np.abs(distances(p[None], points)[0]), primitives.INNER)
    return float(apart.sum() / (len(points) + FEW))


def _profile(view: View, seen: Outline, body: Measurement, floor: float) -> tuple[float, ...]:
    """Radius (SLICES,) by the widest of what is turned, from the rows in which its axis is seen."""
    heights = floor + (np.arange(SLICES) + 0.5) * body.size[2] / SLICES
    axis = np.stack([np.full(SLICES, body.x), np.full(SLICES, body.y), heights], axis=1)
    rows = np.clip(np.round(view.project(axis)[:, 1] - 0.5).astype(int) - seen.top, 0, len(seen.widths) - 1)
    widths = seen.widths[rows] / max(float(seen.widths.max()), 1e-6)
    return tuple(round(float(w), 2) for w in widths)


def _upmost(view: View, seen: Outline, at: Array) -> float:
    """Height [m] over the floor of the map at which the uppermost ray passes over `at` (2,)."""
    ray = _ray(view, view.middle[0] - 0.5, -seen.reach[3 * DIRECTIONS // 4] * view.focal[1] + view.middle[1] - 0.5)
    flat = float(np.linalg.norm(ray[:2]))
    return float(view.position[2] + ray[2] / flat * np.linalg.norm(at - view.position[:2]))


def _beside(view: View, seen: Outline, body: Measurement) -> float:
    """Where a handle points [rad] that is seen beside a body: it is as far away as the body's axis."""
    assert seen.handle is not None
    ray = view.rotation @ np.array([*seen.handle, 1.0])
    to = np.array([body.x, body.y]) - view.position[:2]
    flat = ray[:2] / np.linalg.norm(ray[:2])
    there = view.position[:2] + flat * (float(to @ to) / float(flat @ to))
    return math.atan2(there[1] - body.y, there[0] - body.x)


def _fit(
    view: View,
    seen: Outline,
    corners: solids.Corners,
    start: Array,
    family: ShapeFamily,
    height: float = math.nan,
) -> Measurement:
    """The shape with the outline, from the parameters `start`; `height` [m]: the last of them, if it is known."""
    count = len(start)
    shifts = np.concatenate([np.zeros((1, count)), STEP * np.eye(count)])

    def off(p: Array) -> tuple[Array, Array]:
        apart = np.stack([seen.distance * (_reach(view, corners(q)) - seen.reach)[seen.shown] for q in p + shifts])
        if not math.isnan(height):
            apart = np.hstack([apart, KNOWN * ((p + shifts)[:, -1:] - height)])
        return apart[0], ((apart[1:] - apart[0]) / STEP).T

    p = solve(off, start, ROBUST, TRIES)[0]
    apart, slopes = off(p)
    noise = max(FREE, 0.4 * seen.pixel)
    information = slopes.T @ slopes / (noise * noise) + np.eye(count) * 25.0
    covariance = np.diag(np.linalg.inv(information))
    return _measurement(
        p, covariance, float(np.minimum(np.abs(apart[: np.count_nonzero(seen.shown)]), 0.02).mean()), family
    )


def _measurement(p: Array, variance: Array, residual: float, family: ShapeFamily) -> Measurement:
    extents = variance[[0, 1, *range(3 if family in ("box", "long") else 2, len(p))]]
    spread = float(np.sqrt(extents.max())) + FREE
    x, y = float(p[0]), float(p[1])
    if family == "ball":
        r = abs(float(p[2]))
        return Measurement("ball", x, y, 0.0, (2 * r, 2 * r, 2 * r), residual, spread, free=3)
    if family == "box":
        yaw, length, width, h = float(p[2]), *(max(0.006, abs(float(v))) for v in p[3:])
        if width > length:
            length, width, yaw = width, length, yaw + math.pi / 2
        return Measurement("box", x, y, math.remainder(yaw, math.pi), (length, width, h), residual, spread, free=6)
    if family == "long":
        r, length = (max(0.005, abs(float(v))) for v in p[3:])
        yaw = math.remainder(float(p[2]), math.pi)
        return Measurement("round", x, y, yaw, (length, 2 * r, 2 * r), residual, spread, tilt=LEVEL, free=5)
    low, high, h = (max(0.005, abs(float(v))) for v in p[2:])
    widest, flared = max(low, high), high > FLARED * low and h < 1.1 * 2 * high
    radii = np.interp((np.arange(SLICES) + 0.5) / SLICES, (0.0, 1.0), (low, high)) / widest
    return Measurement(
        "bowl" if flared else "round", x, y, 0.0, (2 * widest, 2 * widest, h), residual, spread,
        profile=tuple(round(float(v), 2) for v in radii), hollow=flared, free=5, end="open" if flared else "",
    )  # fmt: skip


def _reach(view: View, corners: Array) -> Array:
    """How far [rad] corners (n, 3) [map] reach in the picture (DIRECTIONS,)."""
    local = (corners - view.position) @ view.rotation
    plane = local[:, :2] / np.maximum(local[:, 2:], 0.02)
    return np.asarray((plane @ TURNS).max(axis=0))
