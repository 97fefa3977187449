"""Compiled meshes with fewer triangles, and their pictures still in place. Pure."""

from typing import Any

import fast_simplification
import numpy as np
from numpy.typing import NDArray

from common import body_extent
from common.geometry import Array
from services.sim.things.mesh import Mesh

FACES = 2000
"""Triangles that all meshes to look at of one body may have; twelve such cost a picture about as much as the flat."""
REACH = 12.0
"""How far, in sides of an old triangle, its coordinates are taken to go on: a new one is some ten times as large."""
SAMPLES = 20_000
"""Points by which the old triangle at a place is found [count]: on a thing of 0.3 m they are 4 mm apart."""
FACING = 0.15
"""What it counts, in lengths of the mesh, that two triangles face ways a radian apart. Chosen: of a book the cover is
taken for no page though those are near and many."""
LEAST_FACES = 60
"""Triangles below which a mesh is left as it is."""
CARE = 3
"""How hard fast_simplification may collapse edges: with its usual 7, corners of the arm's shells flew off by 5 cm."""


def corners(model: Any, number: int) -> tuple[Array, NDArray[np.int64]]:
    """Corners (n, 3) [m] and triangles (k, 3) of a compiled mesh."""
    return np.array(body_extent.corners(model, number), np.float64), np.array(body_extent.triangles(model, number))


def decimated(vertices: Array, triangles: NDArray[np.int64], wanted: int) -> tuple[Array, NDArray[np.int64]]:
    """Corners (n, 3) and triangles (k, 3) of a mesh with about as few triangles as are `wanted`."""
    fewer, left = fast_simplification.simplify(vertices, triangles, target_count=wanted, agg=CARE)
    # A corner where surfaces meet may be thrown beyond the body: it stays within its bounds.
    return np.clip(fewer, vertices.min(axis=0), vertices.max(axis=0)), left


def simplified(model: Any, number: int, share: float) -> Mesh:
    """A compiled mesh with its texture coordinates, and about a `share` of its triangles."""
    vertices, faces = corners(model, number)
    begin, start = int(model.mesh_faceadr[number]), int(model.mesh_texcoordadr[number])
    if start < 0:
        uv = np.zeros((3 * len(faces), 2))
    else:
        uv = np.array(model.mesh_texcoord[start:][model.mesh_facetexcoord[begin : begin + len(faces)].ravel()])
    target = int(share * len(faces))
    if share == 1.0 or target < LEAST_FACES:
        return _shared(vertices[faces.ravel()], uv)
    # Along the seams of its picture a mesh is cut: sewn up first, or it would tear there.
    sewn, index = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    fewer, left = decimated(sewn, index.ravel()[faces], target)
    return _shared(fewer[left].reshape(-1, 3), mapped(vertices[faces], uv.reshape(-1, 3, 2), fewer[left]))


def mapped(old: Array, uv: Array, new: Array) -> Array:
    """Texture coordinates (3 k, 2) for triangles `new` (k, 3, 3) from triangles `old` (n, 3, 3) with `uv` (n, 3, 2).

    A new triangle lies on that old one which has a point near its middle and faces the same way: its corners get what
    the plane through the old one's coordinates has there, so that the picture runs on without a break within it.
    """
    from scipy.spatial import cKDTree

    points, of = _sampled(old)
    facing = FACING * np.ptp(old.reshape(-1, 3), axis=0).max()
    tree = cKDTree(np.concatenate([points, facing * _normals(old)[of]], 1))
    _, found_at = tree.query(np.concatenate([new.mean(axis=1), facing * _normals(new)], 1))
    nearest = of[found_at]
    a, b, c = (old[nearest, i] for i in range(3))
    e, f = b - a, c - a
    ee, ef, ff = (e * e).sum(1), (e * f).sum(1), (f * f).sum(1)
    det = np.maximum(ee * ff - ef * ef, 1e-18)
    offset = new - a[:, None]
    oe, of = (offset * e[:, None]).sum(2), (offset * f[:, None]).sum(2)
    s = np.clip((ff[:, None] * oe - ef[:, None] * of) / det[:, None], -REACH, REACH)
    t = np.clip((ee[:, None] * of - ef[:, None] * oe) / det[:, None], -REACH, REACH)
    base, along, across = uv[nearest, 0], uv[nearest, 1] - uv[nearest, 0], uv[nearest, 2] - uv[nearest, 0]
    found = base[:, None] + s[..., None] * along[:, None] + t[..., None] * across[:, None]
    return np.asarray(found.reshape(-1, 2))


def _sampled(triangles: Array) -> tuple[Array, NDArray[np.int64]]:
    """Points (n, 3) on triangles (k, 3, 3): the middle of each, and SAMPLES by area; and of which each is (n,)."""
    a, b, c = (triangles[:, i] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    # Along the way through all of them in steps of equal area, the same at every call.
    steps = (np.arange(SAMPLES) + 0.5) / SAMPLES * area.sum()
    of = np.minimum(np.searchsorted(np.cumsum(area), steps), len(area) - 1)
    u, v = np.random.default_rng(0).random((2, SAMPLES))
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u)[:, None], np.where(over, 1.0 - v, v)[:, None]
    points = a[of] + u * (b - a)[of] + v * (c - a)[of]
    return np.concatenate([triangles.mean(axis=1), points]), np.concatenate([np.arange(len(triangles)), of])


def _normals(triangles: Array) -> Array:
    """Unit normals (k, 3) of triangles (k, 3, 3)."""
    a, b, c = (triangles[:, i] for i in range(3))
    normal = np.cross(b - a, c - a)
    return np.asarray(normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-18)[:, None])


def _shared(corners: Array, uv: Array) -> Mesh:
    """Triangles of corners (3 k, 3) with coordinates (3 k, 2), with one vertex for all corners that are the same."""
    rows = np.concatenate([np.round(corners, 5), np.round(uv, 4)], 1)
    kept, index = np.unique(rows, axis=0, return_inverse=True)
    return Mesh(kept[:, :3], index.reshape(-1, 3), kept[:, 3:])
