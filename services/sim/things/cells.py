"""A mesh taken apart by planes along its axes: quick, whatever its shape. Pure."""

import heapq
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from common.geometry import Array

Part = tuple[Array, NDArray[np.int64]]
STEPS = 48
"""Cubes along the longest side of a mesh, each of which gives a point: 2 mm on a mug."""
DEPTH = 0.002
"""How far [m] a part may fill what the mesh leaves open: no more than pads of rubber give way."""
THIN = 1e-4
"""Thickness [m] that a part without any gets, which no hull has otherwise."""


def parts(vertices: Array, faces: NDArray[np.int64], most: int) -> list[Part]:
    """Convex hulls of a closed mesh's pieces, at most so many: the one that fills the most is halved first."""
    step = float(np.ptp(vertices, axis=0).max()) / STEPS
    within, open_air = _grid(vertices[faces], step)
    points = np.concatenate([_surface(vertices[faces], step), within])
    found = [_piece(points, open_air, 0)]
    while len(found) < most and found[0][0] < 0:
        *_, piece = heapq.heappop(found)
        axis = int(np.argmax(np.ptp(piece.points, axis=0)))
        for side, half in enumerate(_halves(piece.points, axis, step)):
            heapq.heappush(found, _piece(half, open_air, 2 * len(found) + side))
    return [_part(hull) for *_, hull in found]


def _halves(points: Array, axis: int, step: float) -> list[Array]:
    """Points below and above the middle; those within half a step of it are in both, so that no gap is left."""
    beyond = points[:, axis] - (points[:, axis].min() + points[:, axis].max()) / 2
    return [points[beyond <= step / 2], points[beyond >= -step / 2]]


def _piece(points: Array, open_air: Array, number: int) -> tuple[int, int, Any]:
    """A row of the heap: minus the points outside the mesh (n, 3) that the points' hull fills, a number, the hull.

    A point counts that lies deeper within the hull than `DEPTH`. Each row has a number of its own, so that two that
    fill as much are not compared further.
    """
    hull = _hull(points)
    near = ((open_air > points.min(axis=0)) & (open_air < points.max(axis=0))).all(axis=1)
    beyond = (open_air[near] @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
    return -int(np.count_nonzero(beyond < -DEPTH)), number, hull


def _surface(triangles: Array, step: float) -> Array:
    """Points of triangles (n, 3, 3): their corners, and one in each cube of side `step` that they pass."""
    longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    made = []
    counts = np.maximum(1, np.ceil(longest / step)).astype(int)
    for count in np.unique(counts):
        u, v = (a.ravel() / count for a in np.meshgrid(np.arange(count + 1), np.arange(count + 1)))
        share = np.stack([u, v, 1 - u - v], axis=1)[u + v <= 1 + 1e-9]
        made.append(np.einsum("sk,nkd->nsd", share, triangles[counts == count]).reshape(-1, 3))
    points = np.concatenate(made)
    _, one = np.unique(np.floor(points / step), axis=0, return_index=True)
    return np.unique(np.concatenate([triangles.reshape(-1, 3), points[one]]).round(6), axis=0)


def _grid(triangles: Array, step: float) -> tuple[Array, Array]:
    """Points of a grid within a closed mesh, which are above an odd number of its triangles, and those outside."""
    low, high = triangles.reshape(-1, 3).min(axis=0), triangles.reshape(-1, 3).max(axis=0)
    # Off what is regular, where a mesh may well have an edge that a line along z would run through.
    xs, ys, zs = (np.arange(low[k] + off * step, high[k], step) for k, off in enumerate((0.3719, 0.4303, 0.2857)))
    a, b, c = triangles.transpose(1, 0, 2)
    (ux, uy, _), (vx, vy, _) = (b - a).T, (c - a).T
    area = ux * vy - uy * vx
    flat = np.abs(area) < 1e-14
    area = np.where(flat, np.inf, area)
    odd = np.zeros((len(xs), len(ys), len(zs)), bool)
    for column, x in enumerate(xs):
        dx, dy = x - a[:, 0], ys[:, None] - a[:, 1]
        s, t = (dx * vy - dy * vx) / area, (dy * ux - dx * uy) / area
        met = (s >= 0) & (t >= 0) & (s + t <= 1) & ~flat
        height = a[:, 2] + s * (b - a)[:, 2] + t * (c - a)[:, 2]
        for row in range(len(ys)):
            odd[column, row] = np.count_nonzero(height[row, met[row]][:, None] < zs, axis=0) % 2 == 1
    everywhere = np.stack(np.meshgrid(xs, ys, zs, indexing="ij"), axis=-1)
    return everywhere[odd], everywhere[~odd]


def _hull(points: Array) -> Any:
    """The convex hull; what lies in a plane or on a line gets some thickness."""
    try:
        return ConvexHull(points)
    except (QhullError, ValueError):
        return ConvexHull(np.concatenate([points + THIN * shift for shift in (*np.eye(3), *-np.eye(3))]))


def _part(hull: Any) -> Part:
    """The hull's corners and triangles."""
    corner = np.full(len(hull.points), -1)
    corner[hull.vertices] = np.arange(len(hull.vertices))
    return hull.points[hull.vertices], corner[hull.simplices]
