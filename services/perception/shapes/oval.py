"""Oval shapes with a free profile that stand upright, as bottles of shampoo do, fitted to the points of one view."""

import math

import numpy as np

from common.geometry import Array
from services.perception.shapes import primitives
from services.perception.shapes.measurement import SLICES, Measurement
from services.perception.shapes.primitives import Distances, Ends, Silhouette
from services.perception.shapes.turned import filled, profile, start

FLAT, FLAT_SPREAD, LENGTH_SPREAD = 0.6, 0.08, 0.25
"""Width by length of what only shows its front, its standard deviation, and that of the length by how wide it looks, as
one point counts. Chosen: bottles have .45 to .8."""
FLATTEST, ROUNDEST = 0.3, 0.85
"""Width by length from which it is rather a box or a disc, and from which it is round."""
EXTENTS = [0, 1, 3, 4]
"""Parameters that are lengths."""
STARTS = ((0.0, FLAT), (0.7, FLAT), (-0.7, FLAT), (0.0, 1 / FLAT))
"""How far [rad] from across the line of sight a side is sought, and how deep it is by its width."""


def standing(points: Array, h: float, outline: Silhouette, noise: float) -> Measurement | None:
    """The upright shape of height `h` [m] with an elliptic section that explains points (n, 3); None if there is none.

    It is reported as a box around it, by which it is held; as something round it is one of its `rivals`.
    """
    (x, y), r = start(points, outline)
    doubt, tried = np.array([1.0, 1.0, 1.0, 2 * LENGTH_SPREAD * r, 2 * FLAT_SPREAD * r]), []
    for turn, deep in STARTS:
        # Its front is where the points are, whatever the depth that is not seen.
        front = (deep - 1) * r * np.array([math.cos(outline.ahead), math.sin(outline.ahead)])
        begin = np.array([x + front[0], y + front[1], outline.ahead + math.pi / 2 + turn, 2 * r, 2 * deep * r])
        tried.append(primitives.fit(elliptic(h), tangents(), begin, points, outline, noise, (begin, doubt)))
    solution = min(tried, key=lambda s: s.residual)
    x, y, yaw, length, width = (float(v) for v in solution.p)
    length, width = abs(length), abs(width)
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    if length < 0.02 or not FLATTEST < width / length < ROUNDEST:
        return None
    rho, scale = _scaled(np.array([[x, y, yaw, length, width]]), points)
    radii = np.minimum(filled(profile(rho[0], points[:, 2] / h, 0.5), 1.0), 1.0)
    steps = np.interp(points[:, 2], (np.arange(SLICES) + 0.5) * h / SLICES, radii)
    off = np.abs(rho[0] - steps) * scale[0]
    off = np.where(rho[0] < steps, np.minimum(off, np.abs(points[:, 2] - h)), off)
    # A shoulder is level: it lies between the radii of the slices that it parts.
    level = np.clip((points[:, 2] / h * SLICES).astype(int), 0, SLICES - 1)
    lower, upper = radii[np.maximum(level - 1, 0)], radii[np.minimum(level + 1, SLICES - 1)]
    off = np.where((rho[0] < lower) & (rho[0] > upper), np.minimum(off, noise), off)
    return Measurement(
        "box", x, y, math.remainder(yaw, math.pi), (length, width, h), float(np.minimum(off, 0.02).mean()),
        float(np.sqrt(np.diag(solution.covariance)[EXTENTS].max())),
        profile=tuple(round(float(v), 2) for v in radii), free=6,
    )  # fmt: skip


def elliptic(h: float) -> Distances:
    """An upright wall of elliptic section with a level top: p = (x, y, yaw, length, width)."""

    def distances(p: Array, points: Array) -> Array:
        rho, scale = _scaled(p, points)
        side, cap = (rho - 1.0) * scale, points[:, 2] - h
        inside = np.minimum(np.minimum(-side, np.abs(cap)), primitives.INNER)
        return np.where(side > 0, np.hypot(side, np.maximum(cap, 0.0)), inside)

    return distances


def tangents() -> Ends:
    """Where lines of sight touch an ellipse, p as in `elliptic`, seen from several times its length away."""

    def ends(outline: Silhouette, p: Array) -> Array:
        x, y, yaw, length, width = p.T
        dx, dy = x - outline.camera[0], y - outline.camera[1]
        turn = np.arctan2(dy, dx) - yaw
        half = np.hypot(length * np.sin(turn), width * np.cos(turn)) / 2
        angle = np.arcsin(np.clip(half / np.maximum(np.hypot(dx, dy), 1e-3), -0.99, 0.99))
        bearing = primitives.bearing_of(outline, x, y)
        return primitives.apart(outline, np.stack([bearing - angle, bearing + angle], axis=1))

    return ends


def _scaled(p: Array, points: Array) -> tuple[Array, Array]:
    """How far points (n, 3) are from the axes of ellipses (m, 5), 1 on their outlines (m, n), and what of that is a
    metre there (m, n)."""
    x, y, yaw, length, width = (p[:, i, None] for i in range(5))
    c, s = np.cos(yaw), np.sin(yaw)
    dx, dy = points[:, 0] - x, points[:, 1] - y
    a, b = np.maximum(np.abs(length), 0.01) / 2, np.maximum(np.abs(width), 0.01) / 2
    u, v = (c * dx + s * dy) / a, (c * dy - s * dx) / b
    rho = np.maximum(np.hypot(u, v), 1e-6)
    return rho, rho / np.maximum(np.hypot(u / a, v / b), 1e-6)
