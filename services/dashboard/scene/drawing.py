"""MJCF as meshes: the flat, the robot's links with the joints that move them, and the shapes of the objects.

MuJoCo and trimesh are imported when the first model is drawn: the page is open before that.
"""

from dataclasses import dataclass, field
from math import cos, sin, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, quat_matrix
from common.rendering.looks import HIDDEN_GROUP, geom_colours
from common.robot.joints import BASE_BODY

if TYPE_CHECKING:
    from common.robot.model import Hand

CUT = 1.0
"""Height [m] at which walls are cut off, so that one can look into the rooms."""
SEE_THROUGH = "wall"
_FREE, _HINGE = 0, 3
"""Kinds of joints [mjtJoint]."""


@dataclass(frozen=True)
class Mesh:
    """Triangles with a colour (0..1) for each vertex."""

    vertices: Array
    faces: NDArray[np.int64]
    colours: Array


@dataclass(frozen=True)
class Joint:
    """`kind` hinge or slide; `axis`, `anchor` in the body's frame."""

    name: str
    kind: str
    axis: Array
    anchor: Array


@dataclass(frozen=True)
class Link:
    """A body of the robot: where it stands in its parent with all joints at zero, and what it looks like."""

    name: str
    parent: str
    position: Array
    rotation: Array
    joints: tuple[Joint, ...]
    mesh: Mesh | None


@dataclass(frozen=True)
class Camera:
    """A camera's optical frame (x right, y down, z forward) in its link."""

    name: str
    link: str
    position: Array
    rotation: Array
    fovy: float


@dataclass(frozen=True)
class Drawing:
    """What a model looks like."""

    flat: Mesh | None
    walls: Mesh | None
    links: tuple[Link, ...] = ()
    cameras: tuple[Camera, ...] = ()
    objects: dict[str, Mesh] = field(default_factory=dict)
    hand: "Hand | None" = None


def draw(mjcf: str, files: dict[str, bytes] | None = None) -> Drawing:
    """The meshes of a model, without what moves by itself.

    Raises:
        ValueError: not a model.
    """
    import mujoco

    from common.robot.model import Hand

    model: Any = mujoco.MjModel.from_xml_string(mjcf, files or {})
    data: Any = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    colours = geom_colours(model)
    roots = [model.body(int(model.body_rootid[b])).name for b in range(model.nbody)]
    flat: list[Mesh] = []
    walls: list[Mesh] = []
    links: list[Link] = []
    objects: dict[str, Mesh] = {}
    for body in range(model.nbody):
        name = model.body(body).name
        geoms = [g for g in range(model.ngeom) if model.geom_bodyid[g] == body and model.geom_group[g] < HIDDEN_GROUP]
        if roots[body] == BASE_BODY:
            links.append(_link(model, body, joined([_geom(model, g, colours) for g in geoms])))
        elif _free(model, body):
            shape = joined([_geom(model, g, colours) for g in geoms])
            if shape is not None:
                objects[name.replace("_", " ")] = shape
        elif model.body_mocapid[model.body_rootid[body]] < 0:
            place, turn = data.xpos[body], data.xmat[body].reshape(3, 3)
            for g in geoms:
                see_through = model.geom(g).name.startswith(SEE_THROUGH)
                mesh = moved(_geom(model, g, colours), place, turn)
                (walls if see_through else flat).append(cut(mesh, CUT) if see_through else mesh)
    try:
        hand = Hand(model)
    except KeyError:
        hand = None
    return Drawing(joined(flat), joined(walls), tuple(links), tuple(_cameras(model, roots)), objects, hand)


def _free(model: Any, body: int) -> bool:
    root = int(model.body_rootid[body])
    first = int(model.body_jntadr[root])
    return first >= 0 and int(model.jnt_type[first]) == _FREE


def _link(model: Any, body: int, mesh: Mesh | None) -> Link:
    first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
    joints = []
    for j in range(first, first + count):
        kind = "hinge" if int(model.jnt_type[j]) == _HINGE else "slide"
        axis, anchor = model.jnt_axis[j].copy(), model.jnt_pos[j].copy()
        joints.append(Joint(model.joint(j).name, kind, axis, anchor))
    parent = "" if model.body(body).name == BASE_BODY else model.body(int(model.body_parentid[body])).name
    rotation = quat_matrix(tuple(model.body_quat[body]))
    return Link(model.body(body).name, parent, model.body_pos[body].copy(), rotation, tuple(joints), mesh)


def _cameras(model: Any, roots: list[str]) -> list[Camera]:
    found = []
    for c in range(model.ncam):
        body = int(model.cam_bodyid[c])
        if roots[body] != BASE_BODY:
            continue
        rotation = quat_matrix(tuple(model.cam_quat[c])) @ np.diag([1.0, -1.0, -1.0])
        fovy = float(np.radians(model.cam_fovy[c]))
        found.append(Camera(model.camera(c).name, model.body(body).name, model.cam_pos[c].copy(), rotation, fovy))
    return found


def _geom(model: Any, g: int, colours: Array) -> Mesh:
    """A geom in its body's frame."""
    import mujoco
    import trimesh

    from common.body_extent import corners, triangles

    kinds, size = mujoco.mjtGeom, model.geom_size[g]
    kind = kinds(int(model.geom_type[g]))
    if kind == kinds.mjGEOM_BOX:
        shape = trimesh.creation.box(extents=2 * size)
    elif kind in (kinds.mjGEOM_SPHERE, kinds.mjGEOM_ELLIPSOID):
        shape = trimesh.creation.icosphere(subdivisions=2)
        shape.apply_scale(size if kind == kinds.mjGEOM_ELLIPSOID else size[0])
    elif kind == kinds.mjGEOM_CYLINDER:
        shape = trimesh.creation.cylinder(radius=size[0], height=2 * size[1], sections=24)
    elif kind == kinds.mjGEOM_CAPSULE:
        shape = trimesh.creation.capsule(radius=size[0], height=2 * size[1], count=(12, 16))
        shape.apply_translation([0, 0, -shape.bounds.mean(axis=0)[2]])
    elif kind == kinds.mjGEOM_PLANE:
        half = np.where(size[:2] > 0, size[:2], 20.0)
        shape = trimesh.creation.box(extents=[2 * half[0], 2 * half[1], 0.01])
        shape.apply_translation([0, 0, -0.005])
    elif kind == kinds.mjGEOM_MESH:
        m = int(model.geom_dataid[g])
        shape = trimesh.Trimesh(corners(model, m), triangles(model, m), process=False)
    else:
        shape = trimesh.Trimesh()
    vertices = np.asarray(shape.vertices, dtype=np.float64)
    mesh = Mesh(vertices, np.asarray(shape.faces, dtype=np.int64), np.tile(colours[g], (len(vertices), 1)))
    return moved(mesh, model.geom_pos[g], quat_matrix(tuple(model.geom_quat[g])))


def moved(mesh: Mesh, place: Array, turn: Array) -> Mesh:
    """The mesh turned by the rotation matrix `turn` and shifted to `place` [m]."""
    return Mesh(mesh.vertices @ turn.T + place, mesh.faces, mesh.colours)


def cut(mesh: Mesh, height: float) -> Mesh:
    """The mesh of upright boxes, none of them higher than `height`."""
    vertices = mesh.vertices.copy()
    vertices[:, 2] = np.minimum(vertices[:, 2], height)
    return Mesh(vertices, mesh.faces, mesh.colours)


def joined(meshes: list[Mesh]) -> Mesh | None:
    """One mesh of several; None when there is nothing."""
    meshes = [m for m in meshes if len(m.faces)]
    if not meshes:
        return None
    starts = np.cumsum([0, *(len(m.vertices) for m in meshes[:-1])])
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.faces + start for m, start in zip(meshes, starts, strict=True)]),
        np.concatenate([m.colours for m in meshes]),
    )


def posture(link: Link, q: dict[str, float]) -> tuple[Array, Array]:
    """Position (3,) and rotation (3, 3) of a link in its parent with these joint positions; unknown ones are 0."""
    place, turn = link.position, link.rotation
    for joint in link.joints:
        value = q.get(joint.name, 0.0)
        if joint.kind == "slide":
            place = place + turn @ (joint.axis * value)
        else:
            spin = _about(joint.axis, value)
            place = place + turn @ (joint.anchor - spin @ joint.anchor)
            turn = turn @ spin
    return place, turn


def _about(axis: Array, angle: float) -> Array:
    """Rotation matrix (3, 3); Rodrigues, in plain numbers: it is asked for every joint of every frame."""
    x, y, z = axis.tolist()
    length = sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    s, c = sin(angle), cos(angle)
    d = 1 - c
    return np.array(
        [
            [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
            [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
            [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
        ]
    )
