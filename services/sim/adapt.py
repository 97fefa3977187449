"""A robot of somebody else's MJCF brought into our terms: one self-contained text with our names.

Colliding meshes become their convex hulls, which is what MuJoCo collides; meshes to look at stay meshes of fewer
faces. So the text alone shows every process the same body. Mass, limits, gains and keyframes stay the model's own; head
camera, mast and lidar are added.
"""

import warnings
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import fast_simplification
import mujoco
import numpy as np

from services.sim import robot
from services.sim.calibrate import bounds
from services.sim.menagerie import Mapping, RobotError

FOREIGN = "their-"
HULL = 64
FACES = 1500
"""Triangles wanted of a mesh to look at: twenty such meshes cost a picture about as much as the flat does."""
CARE = 3
"""How hard fast_simplification may collapse edges: with its usual 7, corners of the arm's shells flew off by 5 cm."""
MAST = 0.022
PAD_TORSION = 0.02
"""Torsional friction [m] of a finger pad: without it objects slipped by up to 16 mm in the hand, with it by 2.5."""
HEAVY, GYRATION = 10.0, 0.02
"""Mass [kg] from which a radius of gyration below this [m] is a placeholder: the base of 60 kg had .001 kg m2."""
_MASTED = ("mast", "head")


def adapted(path: Path, names: Mapping, mapped_in: Path) -> ET.Element:
    """The model as MJCF without defaults, files and frames.

    Raises:
        RobotError: it cannot be read, or lacks something that we need.
    """
    try:
        theirs = mujoco.MjSpec.from_file(str(path))
        keys = theirs.compile()
    except (ValueError, OSError) as error:
        raise RobotError(f"{path}: MuJoCo cannot read it: {error}") from None
    _check(theirs, names, path, mapped_in)
    ours = mujoco.MjSpec()
    ours.option.integrator, ours.option.cone = theirs.option.integrator, theirs.option.cone
    ours.option.impratio, ours.option.timestep = theirs.option.impratio, theirs.option.timestep
    for mesh in theirs.meshes:
        mesh.maxhullvert = HULL
    with warnings.catch_warnings():
        # Options that differ: the world's count.
        warnings.simplefilter("ignore")
        ours.attach(theirs, prefix=FOREIGN, frame=ours.worldbody.add_frame())
        _strip(ours)
        model = ours.compile()
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        _shapes(ours, model, {FOREIGN + n for side in names.pads.values() for n in side})
        for body in ours.bodies[1:]:
            _fix_mass(body, model, data)
        _float_arm(ours, names)
        _sensors(ours, model, names)
        for kind in ("geoms", "joints", "sites", "cameras", "actuators", "equalities", "meshes"):
            for element in getattr(ours, kind):
                element.classname = ours.default
        ours.compile()
        root = ET.fromstring(ours.to_xml())
    _rename(root, names)
    for tag in ("default", "option", "compiler", "statistic", "visual", "size", "keyframe"):
        for element in root.findall(tag):
            root.remove(element)
    root.insert(0, ET.Element("compiler", angle="radian", autolimits="true"))
    keyframe = ET.SubElement(root, "keyframe")
    for number in range(keys.nkey):
        key = keys.key(number)
        ours_name = "home" if key.name == names.home else f"their_{key.name or number}"
        ET.SubElement(keyframe, "key", name=ours_name, qpos=" ".join(f"{v:.9g}" for v in key.qpos))
    return root


def _check(spec: Any, names: Mapping, path: Path, mapped_in: Path) -> None:
    wanted = {
        "body": names.bodies.values(), "joint": names.joints.values(), "actuator": names.actuators.values(),
        "site": names.sites.values(), "camera": names.cameras.values(), "key": [names.home],
        "geom": [n for side in names.pads.values() for n in side],
    }  # fmt: skip
    missing = [f"{kind} {n}" for kind, wants in wanted.items() for n in wants if getattr(spec, kind)(n) is None]
    if missing:
        raise RobotError(
            f"{path} lacks {', '.join(missing)}. Take the model of MuJoCo Menagerie as it is, or change the names "
            f"that are mapped in {mapped_in.parent.name}/{mapped_in.name}"
        )


def _strip(spec: Any) -> None:
    """What the world has already, or nobody needs."""
    for kind in ("lights", "sensors", "keys", "skins"):
        for element in list(getattr(spec, kind)):
            spec.delete(element)


def _shapes(spec: Any, model: Any, gripping: set[str]) -> None:
    """Make every mesh text: hulls to collide, hidden on bodies that have something to look at, and decimated looks."""
    seen = {g.parent.name for g in spec.geoms if not _collides(g)}
    meshes = _Meshes(spec, model)
    # The compiled model's numbers are taken first: an element that is deleted renumbers those behind it.
    for at, geom in [(g.id, g) for g in spec.geoms]:
        material = spec.material(geom.material) if geom.material else None
        geom.rgba, geom.material = np.array(material.rgba if material is not None else geom.rgba), ""
        geom.group = robot.ROBOT_GROUP
        if _collides(geom):
            geom.contype, geom.conaffinity = 2, 1
            geom.group = robot.HULL_GROUP if geom.parent.name in seen else robot.ROBOT_GROUP
        else:
            geom.contype = geom.conaffinity = 0
        if geom.name in gripping:
            # A pad of rubber also resists turning; with priority over the object's own it would cancel its torsion.
            geom.condim, geom.friction[1] = 4, PAD_TORSION
        if geom.meshname:
            geom.meshname = meshes.name(geom.meshname, int(model.geom_dataid[at]), hulled=_collides(geom))
            geom.pos, geom.quat = model.geom_pos[at], model.geom_quat[at]
    for mesh in list(spec.meshes):
        if mesh.name not in meshes.made:
            spec.delete(mesh)
    for element in [*spec.materials, *spec.textures]:
        spec.delete(element)


def _collides(geom: Any) -> bool:
    return bool(geom.contype or geom.conaffinity)


class _Meshes:
    """The meshes of the adapted model, each made once from a compiled one."""

    def __init__(self, spec: Any, model: Any) -> None:
        self._spec, self._model = spec, model
        self._names: dict[tuple[str, bool], str] = {}

    @property
    def made(self) -> set[str]:
        return set(self._names.values())

    def name(self, theirs: str, mesh: int, hulled: bool) -> str:
        key = theirs, hulled
        if key not in self._names:
            self._names[key] = f"{'hull' if hulled else 'look'}_{len(self._names)}"
            vertices, faces = hull(self._model, mesh) if hulled else look(self._model, mesh)
            self._spec.add_mesh(
                name=self._names[key], uservert=np.round(vertices, 5).reshape(-1), userface=faces.reshape(-1),
            )  # fmt: skip
        return self._names[key]


def look(model: Any, mesh: int) -> tuple[Any, Any]:
    """Corners (n, 3) and triangles (k, 3) of a compiled mesh, decimated to at most `FACES` or little more."""
    at, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    begin, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    vertices = np.array(model.mesh_vert[at : at + count], np.float64)
    triangles = np.array(model.mesh_face[begin : begin + faces])
    if faces <= FACES:
        return vertices, triangles
    fewer, left = fast_simplification.simplify(vertices, triangles, target_count=FACES, agg=CARE)
    # A corner where surfaces meet may be thrown beyond the body: it stays within its bounds.
    return np.clip(fewer, vertices.min(axis=0), vertices.max(axis=0)), left


def hull(model: Any, mesh: int) -> tuple[Any, Any]:
    """Corners (n, 3) and triangles (k, 3) of a compiled mesh's convex hull."""
    graph = model.mesh_graph[int(model.mesh_graphadr[mesh]) :]
    corners, triangles = int(graph[0]), int(graph[1])
    ids = graph[2 + corners : 2 + 2 * corners]
    begin = 2 + 3 * corners + 3 * triangles
    faces = graph[begin : begin + 3 * triangles].reshape(-1, 3)
    place = {int(v): i for i, v in enumerate(ids)}
    first = int(model.mesh_vertadr[mesh])
    return model.mesh_vert[first + ids], np.vectorize(place.__getitem__)(faces)


def _fix_mass(body: Any, model: Any, data: Any) -> None:
    """The inertia as it was compiled, whatever shapes are left out; a placeholder becomes that of a solid box."""
    at = body.id
    if model.body_mass[at] <= 0:
        return
    body.explicitinertial, body.mass = True, model.body_mass[at]
    body.ipos, body.iquat, body.inertia = model.body_ipos[at], model.body_iquat[at], model.body_inertia[at]
    body.fullinertia = np.full(6, np.nan)
    if body.mass > HEAVY and max(body.inertia) < body.mass * GYRATION**2:
        solid = [g for g in range(model.ngeom) if model.geom_bodyid[g] == at and model.geom_contype[g]]
        corners = np.array([bounds(model, data, g) for g in solid])
        square = (corners[:, 1].max(axis=0) - corners[:, 0].min(axis=0)) ** 2
        body.iquat, body.inertia = [1, 0, 0, 0], body.mass / 12 * (square.sum() - square)


def _float_arm(spec: Any, names: Mapping) -> None:
    """The arm's firmware compensates its weight."""
    first = spec.joint(FOREIGN + names.joints["joint_1"]).parent
    for body in [first, *first.find_all("body")]:
        body.gravcomp = 1.0


def _sensors(spec: Any, model: Any, names: Mapping) -> None:
    """Our mast with the head camera behind the body, and the lidar."""
    kept = [FOREIGN + n for n in names.cameras.values()]
    for camera in list(spec.cameras):
        if camera.name not in kept:
            spec.delete(camera)
    base = spec.body(FOREIGN + names.bodies["base"])
    at = model.body(base.name).id
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    solid = [g for g in range(model.ngeom) if model.geom_bodyid[g] == at and model.geom_contype[g]]
    low = np.min([bounds(model, data, g)[0] for g in solid], axis=0)
    high = np.max([bounds(model, data, g)[1] for g in solid], axis=0)
    height = robot.HEAD_CAMERA[2]
    x = float(low[0]) + MAST
    look = {"contype": 2, "conaffinity": 1, "group": robot.ROBOT_GROUP, "mass": 0.0}
    kinds = mujoco.mjtGeom
    base.add_geom(
        name=_MASTED[0], type=kinds.mjGEOM_CAPSULE, size=[MAST, 0, 0], rgba=[0.30, 0.31, 0.33, 1],
        fromto=[x, 0, float(high[2]), x, 0, height - 0.02], **look,
    )  # fmt: skip
    base.add_geom(
        name=_MASTED[1], type=kinds.mjGEOM_BOX, size=[0.035, 0.075, 0.03], pos=[x + 0.015, 0, height],
        rgba=[0.10, 0.11, 0.13, 1], **look,
    )  # fmt: skip
    s, c = np.sin(robot.HEAD_PITCH), np.cos(robot.HEAD_PITCH)
    turn = np.array([[0, s, -c], [-1, 0, 0], [0, c, s]])
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, turn.reshape(-1))
    base.add_camera(name="head", pos=[x + 0.05, 0, height], quat=quat, fovy=robot.HEAD_FOVY)
    base.add_site(name="lidar", pos=[0, 0, robot.LIDAR_HEIGHT], size=[0.01] * 3, group=4)


def _rename(root: ET.Element, names: Mapping) -> None:
    """Their names into ours, in definitions and references alike."""
    tables = {
        "body": {v: k for k, v in names.bodies.items()},
        "joint": {v: k for k, v in names.joints.items()},
        "actuator": {v: k for k, v in names.actuators.items()},
        "site": {v: k for k, v in names.sites.items()},
        "camera": {v: k for k, v in names.cameras.items()},
        "geom": {n: f"{side}_pad{i}" for side, pads in names.pads.items() for i, n in enumerate(pads)},
    }
    kinds = {**{f"body{i}": "body" for i in (1, 2)}, **{f"joint{i}": "joint" for i in (1, 2)}}
    kinds |= {f"site{i}": "site" for i in (1, 2)} | {"joint": "joint", "site": "site", "tendon": "tendon"}
    actuators = {id(e) for section in root.findall("actuator") for e in section}

    def ours(kind: str, name: str) -> str:
        if not name.startswith(FOREIGN):
            return name
        theirs = name.removeprefix(FOREIGN)
        table = tables.get(kind, {})
        renamed = table.get(theirs, theirs)
        # One of theirs that is called like one of ours.
        return f"{renamed}_" if theirs not in table and renamed in table.values() else renamed

    for element in root.iter():
        kind = "actuator" if id(element) in actuators else element.tag
        for key, value in element.attrib.items():
            if key == "name":
                element.set(key, ours(kind, value))
            elif key in kinds:
                element.set(key, ours(kinds[key], value))
            elif value.startswith(FOREIGN):
                element.set(key, value.removeprefix(FOREIGN))
        element.attrib.pop("class", None)
        element.attrib.pop("childclass", None)
