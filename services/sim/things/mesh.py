"""Meshes to look at, made by our own code, with texture coordinates; they collide with nothing. Pure."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.kinds import Segment

AROUND = 40
"""Corners of a round outline: at 0.3 m a can of 70 mm deviates from a circle by less than a pixel."""
ROD = 12
"""The same of a rod [count], which is a tenth as thick."""


@dataclass(frozen=True)
class Mesh:
    """Corners (n, 3) [m], triangles (k, 3) and texture coordinates (n, 2) with (0, 0) at the picture's top left."""

    vertices: Array
    faces: NDArray[np.int64]
    uv: Array

    def moved(self, by: tuple[float, float, float]) -> "Mesh":
        """The mesh shifted `by` a vector [m]."""
        return Mesh(self.vertices + by, self.faces, self.uv)

    def painted(self, u: float, v: float) -> "Mesh":
        """The mesh in the one colour that its texture has at the point (u, v)."""
        return Mesh(self.vertices, self.faces, np.tile((u, v), (len(self.uv), 1)))


def joined(parts: list[Mesh]) -> Mesh:
    """Several meshes as one, with one texture."""
    starts = np.cumsum([0, *(len(p.vertices) for p in parts[:-1])])
    return Mesh(
        np.concatenate([p.vertices for p in parts]),
        np.concatenate([p.faces + start for p, start in zip(parts, starts, strict=True)]),
        np.concatenate([p.uv for p in parts]),
    )


def turned(outline: list[Segment], low: float, high: float, top: float) -> Mesh:
    """The solid of revolution of an outline of points (radius, height) [m] about z.

    The picture goes once around, and from `high` (v = `top`) down to `low` (v = 1); what is above or within has the
    colour of the picture's upper edge. A wall is seen from the side that is to the right of its direction.
    """
    return joined([_band(segment, low, high, top) for segment in outline])


def _band(segment: Segment, low: float, high: float, top: float) -> Mesh:
    angles = np.arange(AROUND + 1) * math.tau / AROUND
    rings, uvs = [], []
    for radius, height in segment:
        rings.append(np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(AROUND + 1, height)], 1))
        share = min(1.0, max(0.0, (high - height) / max(high - low, 1e-9)))
        uvs.append(np.stack([angles / math.tau, np.full(AROUND + 1, top + (1 - top) * share)], 1))
    a = np.arange(AROUND)
    b, c, d = a + 1, a + AROUND + 1, a + AROUND + 2
    faces = np.concatenate([np.stack([a, b, d], 1), np.stack([a, d, c], 1)])
    vertices = np.concatenate(rings)
    area = np.linalg.norm(
        np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]]), axis=1
    )
    return Mesh(vertices, faces[area > 1e-12], np.concatenate(uvs))


FACES = ("front", "right", "back", "left", "top", "bottom")
"""Sides of a box: the front looks along +x, the picture's columns are in this order, two rows of three."""


def box(size: tuple[float, float, float]) -> Mesh:
    """A box of full extents (x, y, z) [m]; each side has its own sixth of the picture (`FACES`, three in a row)."""
    x, y, z = (v / 2 for v in size)
    # Of each side the corners that are seen at the top left, bottom left, bottom right and top right.
    corners = (
        ((x, -y, z), (x, -y, -z), (x, y, -z), (x, y, z)), ((x, y, z), (x, y, -z), (-x, y, -z), (-x, y, z)),
        ((-x, y, z), (-x, y, -z), (-x, -y, -z), (-x, -y, z)), ((-x, -y, z), (-x, -y, -z), (x, -y, -z), (x, -y, z)),
        ((-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)), ((x, -y, -z), (-x, -y, -z), (-x, y, -z), (x, y, -z)),
    )  # fmt: skip
    vertices, faces, uv = [], [], []
    for n, side in enumerate(corners):
        left, above = (n % 3) / 3, (n // 3) / 2
        e = 0.004  # Not the neighbour's colour at the seam.
        vertices += list(side)
        faces += [(4 * n, 4 * n + 1, 4 * n + 2), (4 * n, 4 * n + 2, 4 * n + 3)]
        right, below = left + 1 / 3 - e, above + 1 / 2 - e
        uv += [(left + e, above + e), (left + e, below), (right, below), (right, above + e)]
    return Mesh(np.array(vertices), np.array(faces), np.array(uv))


def tube(path: Array, radii: Array) -> Mesh:
    """A round rod along a plane path (n, 3) [m] in the xz plane with radii (n,); its ends are closed."""
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.array([0.0, 1.0, 0.0])
    up = np.cross(along, side)
    angles = np.arange(ROD + 1) * math.tau / ROD
    rings = path[:, None] + radii[:, None, None] * (
        np.cos(angles)[None, :, None] * side + np.sin(angles)[None, :, None] * up[:, None]
    )
    rings = np.concatenate([np.repeat(path[:1, None], ROD + 1, 1), rings, np.repeat(path[-1:, None], ROD + 1, 1)])
    count, width = len(rings), ROD + 1
    grid = np.arange(count * width).reshape(count, width)
    a, b, c, d = grid[:-1, :-1].ravel(), grid[:-1, 1:].ravel(), grid[1:, :-1].ravel(), grid[1:, 1:].ravel()
    faces = np.concatenate([np.stack([a, c, d], 1), np.stack([a, d, b], 1)])
    u, v = np.meshgrid(angles / math.tau, np.linspace(0, 1, count))
    return Mesh(rings.reshape(-1, 3), faces, np.stack([u.ravel(), v.ravel()], 1))


def xml(name: str, mesh: Mesh) -> str:
    """MJCF of the asset of a mesh that is drawn and does not collide."""
    return (
        f'<mesh name="{name}" inertia="shell" vertex="{_text(mesh.vertices, 5)}" face="{_text(mesh.faces)}" '
        f'texcoord="{_text(mesh.uv, 4)}"/>'
    )


def _text(values: NDArray[np.float64] | NDArray[np.int64], digits: int = 0) -> str:
    rounded = np.round(values, digits).ravel().tolist()
    return " ".join(f"{v:g}" for v in rounded) if digits else " ".join(map(str, values.ravel().tolist()))
