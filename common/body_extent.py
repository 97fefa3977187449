"""Compiled bodies: corners and triangles of a mesh, bounds of a geom, and how low what collides reaches."""

import math
from typing import Any

import mujoco
import numpy as np

from common.geometry import Array

_TYPE = mujoco.mjtGeom


def corners(model: Any, mesh: int) -> Any:
    """Corners (n, 3) [m] of a compiled mesh, in its own frame."""
    begin = int(model.mesh_vertadr[mesh])
    return model.mesh_vert[begin : begin + int(model.mesh_vertnum[mesh])]


def triangles(model: Any, mesh: int) -> Any:
    """Triangles (k, 3) of a compiled mesh, by their corners' numbers."""
    begin = int(model.mesh_faceadr[mesh])
    return model.mesh_face[begin : begin + int(model.mesh_facenum[mesh])]


def bounds(model: Any, geom: int, turn: Array, place: Array) -> tuple[Array, Array]:
    """Lowest and highest corner (3,) [m] of a geom with its origin at `place` (3,), turned by the matrix `turn` (3, 3).

    A mesh's own box lies along its principal axes, which may be askew: its turned corners would be far too wide.
    """
    if model.geom_type[geom] == _TYPE.mjGEOM_MESH:
        points = place + corners(model, int(model.geom_dataid[geom])) @ turn.T
        return points.min(axis=0), points.max(axis=0)
    box = model.geom_aabb[geom]
    middle, half = place + turn @ box[:3], np.abs(turn) @ box[3:]
    return middle - half, middle + half


def lowest(model: Any, data: Any, body: int) -> float:
    """Height [m] of the lowest point of a body as it is placed in `data`: what leans rests on a corner or a spout."""
    first = int(model.body_geomadr[body])
    geoms = [g for g in range(first, first + int(model.body_geomnum[body])) if model.geom_contype[g]]
    return min(float(data.geom_xpos[g][2]) - _below(model, int(g), data.geom_xmat[g][6:]) for g in geoms)


def _below(model: Any, g: int, up: Any) -> float:
    """How far [m] a geom reaches below its origin; `up` (3,): the vertical in its own frame."""
    kind, size = model.geom_type[g], model.geom_size[g]
    if kind == _TYPE.mjGEOM_MESH:
        return -float((corners(model, int(model.geom_dataid[g])) @ up).min())
    if kind == _TYPE.mjGEOM_ELLIPSOID:
        return float(math.hypot(*(size * up)))
    if kind == _TYPE.mjGEOM_BOX:
        return float(abs(size * up).sum())
    upright = abs(float(up[2]))
    if kind == _TYPE.mjGEOM_CYLINDER:
        return float(size[1] * upright + size[0] * math.sqrt(max(0.0, 1.0 - upright * upright)))
    return float(size[0] + (size[1] * upright if kind == _TYPE.mjGEOM_CAPSULE else 0.0))
