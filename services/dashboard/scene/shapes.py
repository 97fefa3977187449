"""Shapes for objects that no model shows."""

import numpy as np

from common.kinds import kind_of
from services.dashboard.scene.drawing import Mesh


def fallback(kind: str, size: tuple[float, float, float], colour: str) -> Mesh:
    """An object that no model shows: a shape of its kind, size and colour."""
    import trimesh

    x, y, z = (max(s, 0.02) for s in size)
    solid = kind_of(kind).shape
    if solid == "sphere":
        shape = trimesh.creation.icosphere(subdivisions=2)
        shape.apply_scale([x / 2, y / 2, z / 2])
    elif solid == "turned":
        shape = trimesh.creation.cylinder(radius=(x + y) / 4, height=z, sections=24)
    else:
        shape = trimesh.creation.box(extents=[x, y, z])
    vertices = np.asarray(shape.vertices, dtype=np.float64)
    rgb = np.array(COLOURS.get(colour, (0.6, 0.6, 0.62)))
    return Mesh(vertices, np.asarray(shape.faces, dtype=np.int64), np.tile(rgb, (len(vertices), 1)))


COLOURS = {
    "red": (0.80, 0.12, 0.12),
    "green": (0.12, 0.55, 0.20),
    "blue": (0.15, 0.30, 0.80),
    "yellow": (0.92, 0.78, 0.12),
    "orange": (0.95, 0.50, 0.10),
    "white": (0.92, 0.92, 0.90),
    "black": (0.10, 0.10, 0.11),
    "brown": (0.45, 0.30, 0.18),
    "grey": (0.55, 0.55, 0.57),
    "purple": (0.50, 0.25, 0.60),
    "pink": (0.92, 0.55, 0.66),
}
