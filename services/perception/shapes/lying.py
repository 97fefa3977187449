"""Turned shapes on their side, fitted to the points of one view, and which of their ends is the upper one. Pure."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.messages import End, ShapeFamily
from services.perception.shapes import primitives
from services.perception.shapes.measurement import LEVEL, SLICES, Measurement
from services.perception.shapes.primitives import Silhouette, Solution
from services.perception.shapes.turned import (
    BODY,
    HANDLE,
    HANDLE_REACH,
    HANDLE_SHARE,
    VESSEL,
    filled,
    profile,
    seen_ends,
    spread,
)

LONG = 1.6
"""Length by width from which what lies is long. Chosen: cans on their side have 1.4 and more."""
SHORTEST = 1.7
"""Least length by radius of what is taken to lie. Chosen: mugs have 1.9 and more, discs lie on their flat side."""
SQUARE = 0.12
"""Credit for a round thing on its side: a box would need two sides that are alike to look the same, and few have."""
OUTER = 0.8
"""Quantile of the points' distances from the axis that is the wall: the others are of an end, or of the inside."""
NECK = 0.8
"""Radius of one end by that of the other, below which it is the narrow end."""
RIM = 0.85
"""Share of the radius within which a line of sight goes through an end, and not past its rim."""
END_SEEN = 0.04
"""Least share of the points that are seen through an end, or on it, to tell whether it is open."""
OPEN, CLOSED = 0.6, 0.25
"""Share of these that lie behind the end: at least, of an open one; at most, of a closed one."""
DEEP = 0.015
"""How far [m] behind the end they do, beside the noise. Chosen: the lid of a can lies 5 mm below its rim."""
TOO_HIGH = 0.3
"""Residual [m] for each metre by which a shape is higher than what was seen of it, as for a ball."""


@dataclass(frozen=True)
class Axis:
    """A horizontal axis through (x, y) at height r [m], along `yaw`; points in its frame are (along, across, above)."""

    x: float
    y: float
    yaw: float
    r: float
    length: float

    def local(self, points: Array) -> Array:
        """Points (n, 3) along the axis, across it and above it [m], from its middle."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        dx, dy = points[:, 0] - self.x, points[:, 1] - self.y
        return np.stack([c * dx + s * dy, c * dy - s * dx, points[:, 2] - self.r], axis=1)


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
    solution, body, side = _fitted(points, h, outline, noise, begin)
    x, y, yaw, r, length = (float(v) for v in solution.p)
    if r < 0.006 or length < SHORTEST * r:
        return None
    axis = Axis(x, y, yaw, r, length)
    local, camera = axis.local(points), axis.local(eye[None])[0]
    along, rho = local[:, 0], np.hypot(local[:, 1], local[:, 2])
    measured = profile(rho[body], along[body] / length + 0.5, OUTER)
    radii = np.minimum(filled(measured, r), 1.1 * r)
    end = facing_end(local[body], camera, axis, noise)
    narrow = _narrow_end(measured)
    # What is seen behind a narrow end is the shoulder.
    hollow = end == "open" and not narrow
    steps = np.interp(along / length + 0.5, (np.arange(SLICES) + 0.5) / SLICES, radii)
    beyond_end = np.abs(along) - length / 2
    # The end that faces the camera is flat, or open.
    flat = np.minimum(np.abs(beyond_end), primitives.INNER)
    off = np.where(rho < steps, np.minimum(steps - rho, flat), np.hypot(rho - steps, np.maximum(beyond_end, 0.0)))
    inside = hollow & (rho < steps) & (beyond_end < 0)
    off = np.where(body & ~inside, off, np.minimum(off, noise))
    # No part of it is higher than what was seen.
    residual = float(np.minimum(off, 0.02).mean()) + TOO_HIGH * max(0.0, 2 * r - h - 0.004 - noise)
    # The closed end that faces the camera is the foot, as far as anything tells.
    towards = 1.0 if camera[0] > 0 else -1.0
    top = narrow or {"open": towards, "closed": -towards, "": 0.0}[end]
    if top < 0:
        radii, yaw = radii[::-1], yaw + math.pi
    shape: ShapeFamily = "long" if length > LONG * 2 * r else "round"
    return Measurement(
        shape, x, y, yaw, (length, 2 * r, 2 * r), residual, spread(solution, slice(0, 4)),
        tilt=LEVEL, profile=tuple(round(float(v) / r, 2) for v in radii), hollow=hollow, handle=side, free=6,
        credit=SQUARE, top_seen=bool(top), end="" if narrow else end,
    )  # fmt: skip


def _fitted(
    points: Array, h: float, outline: Silhouette, noise: float, begin: Array
) -> tuple[Solution, NDArray[np.bool_], float]:
    """The fit to points (n, 3), which of them (n,) are of the body, and where a handle beside it points [rad], or nan.

    A handle makes the silhouette wider: whether there is one is asked of a fit without it.
    """
    ends, prior = primitives.corner_ends(lies=True), (begin, np.array([1.0, 1.0, 1.0, 0.003, 0.5]))
    hidden = Silhouette(outline.camera, outline.ahead, np.full(2, np.nan), outline.distance)
    solution = primitives.fit(primitives.lying(), ends, begin, points, hidden, noise, prior)
    x, y, yaw, _, length = (float(v) for v in solution.p)
    beside = Axis(x, y, yaw, 0.0, length).local(points)[:, 1]
    far = np.abs(beside)
    beyond = (far > h / 2 + HANDLE) & (far < h / 2 + HANDLE_REACH + HANDLE)
    wall = far < h / 2 + HANDLE / 2
    has_handle = np.count_nonzero(wall) >= BODY and HANDLE_SHARE[0] < beyond.mean() < HANDLE_SHARE[1]
    if not (VESSEL[0] < length < VESSEL[1] and has_handle):
        solution = primitives.fit(primitives.lying(), ends, begin, points, outline, noise, prior)
        return solution, np.ones(len(points), bool), math.nan
    own = primitives.silhouette(points[wall], np.append(outline.camera, 0.0), seen_ends(outline), 0.0)
    solution = primitives.fit(primitives.lying(), ends, begin, points[wall], own, noise, prior)
    side = float(np.sign(np.median(beside[beyond])))
    return solution, wall, float(solution.p[2]) + side * math.pi / 2


def facing_end(local: Array, camera: Array, axis: Axis, noise: float) -> End:
    """Whether the end that faces the camera is open, by points (n, 3) in the axis' frame; "" when too little tells.

    Lines of sight that go through the end meet it where it is closed, and something behind it where it is open.
    """
    towards = 1.0 if camera[0] > 0 else -1.0
    along = towards * local[:, 0]
    # Where the end really is, the fit may be a little off.
    end = min(axis.length / 2, primitives.quantile(along, 0.97)) if len(along) else 0.0
    ahead = towards * float(camera[0]) - end
    if ahead < DEEP:
        return ""
    share = ahead / np.maximum(towards * float(camera[0]) - along, 1e-6)
    crossing = camera[1:] + share[:, None] * (local[:, 1:] - camera[1:])
    through = np.hypot(crossing[:, 0], crossing[:, 1]) < RIM * axis.r
    behind = end - along[through]
    if len(behind) < max(5, END_SEEN * len(local)):
        return ""
    deep = float(np.mean(behind > DEEP + noise))
    return "open" if deep > OPEN else "closed" if deep < CLOSED else ""


def _narrow_end(radii: Array) -> float:
    """Which end (1 or -1) of a profile (SLICES,) is much narrower than the other; 0 if none is, or it is not known."""
    with np.errstate(invalid="ignore"):
        low, high = float(radii[:2].mean()), float(radii[-2:].mean())
    if high < NECK * low:
        return 1.0
    return -1.0 if low < NECK * high else 0.0
