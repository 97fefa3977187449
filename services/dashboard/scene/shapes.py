"""Shapes for objects that no model shows."""

import numpy as np

from common.kinds import kind_of
from common.naming.colours import COLOURS, UNKNOWN_COLOUR
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
    rgb = np.array(COLOURS.get(colour, UNKNOWN_COLOUR))
    return Mesh(vertices, np.asarray(shape.faces, dtype=np.int64), np.tile(rgb, (len(vertices), 1)))
