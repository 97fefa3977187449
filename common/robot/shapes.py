"""What a robot's description looks like in boxes, cylinders and spheres, for tools that cannot read MJCF."""

from typing import Any, Literal, NamedTuple

import mujoco

from common.geometry import quat_matrix
from common.messages.base import Quat, Vec3
from common.rendering.looks import HIDDEN_GROUP
from common.robot.joints import BASE_BODY
from common.robot.link_frames import link_name


class Shape(NamedTuple):
    """A solid of full extents `size` [m] in the frame of a link; a cylinder stands along its z. `colour` is rgba."""

    link: str
    form: Literal["box", "cylinder", "sphere"]
    position: Vec3
    orientation: Quat
    size: Vec3
    colour: tuple[float, float, float, float]


def shapes(model: Any) -> list[Shape]:
    """What is drawn of the body `base` and all it carries; a mesh is the box around it, a capsule a cylinder.

    Raises:
        KeyError: no body `base`.
    """
    base = model.body(BASE_BODY).id
    bodies = {b: link_name(model, b) for b in range(model.nbody) if model.body_rootid[b] == base}
    drawn = [g for g in range(model.ngeom) if model.geom_group[g] < HIDDEN_GROUP]
    return [_shape(model, g, bodies[owner]) for g in drawn if (owner := int(model.geom_bodyid[g])) in bodies]


def _shape(model: Any, g: int, link: str) -> Shape:
    kinds, kind, size = mujoco.mjtGeom, model.geom_type[g], model.geom_size[g]
    place = model.geom_pos[g].copy()
    form: Literal["box", "cylinder", "sphere"] = "box"
    if kind == kinds.mjGEOM_SPHERE:
        form, extents = "sphere", (2 * size[0],) * 3
    elif kind in (kinds.mjGEOM_CYLINDER, kinds.mjGEOM_CAPSULE):
        ends = size[0] if kind == kinds.mjGEOM_CAPSULE else 0.0
        form, extents = "cylinder", (2 * size[0], 2 * size[0], 2 * (size[1] + ends))
    else:
        around = model.geom_aabb[g]
        place += quat_matrix(tuple(model.geom_quat[g])) @ around[:3]
        extents = tuple(2 * around[3:])
    x, y, z = (float(v) for v in place)
    w, i, j, k = (float(v) for v in model.geom_quat[g])
    r, green, b, a = (float(v) for v in model.geom_rgba[g])
    length, width, height = (float(v) for v in extents)
    return Shape(link, form, (x, y, z), (w, i, j, k), (length, width, height), (r, green, b, a))
