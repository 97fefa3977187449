"""The official model's meshes as the robot's skin: they are drawn, while the primitives below them collide."""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from services.sim.menagerie import RobotError
from services.sim.robot import HULL_GROUP, MAST, ROBOT_GROUP
from services.sim.things.thinning import corners, decimated

THEIRS = {"base": "base_link", "arm_base": "gen3/base_link", "gripper": "base"}
"""Our bodies whose names are others there."""
MERGED = {"left_silicone_pad": "left_pad", "right_silicone_pad": "right_pad"}
"""Bodies without joint or mass, which only hold something to look at -> the body that they belong to."""
FACES = 1500
"""Triangles wanted of a mesh to look at: twenty such meshes cost a picture about as much as the flat does."""


def dress(root: ET.Element, path: Path) -> None:
    """Give the robot's MJCF the looks of the official model at `path`; what they cover is not drawn any more.

    Raises:
        RobotError: the model cannot be read, or has not the bodies of this robot.
    """
    try:
        model: Any = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise RobotError(f"{path}: MuJoCo cannot read it: {error}") from None
    bodies = {str(b.get("name")): b for b in root.iter("body")}
    assets = root.find("asset")
    assert assets is not None
    seen = [g for g in range(model.ngeom) if _is_look(model, g)]
    looks: dict[str, list[int]] = {}
    ours = {theirs: name for name, theirs in THEIRS.items()} | MERGED
    for g in seen:
        name = model.body(int(model.geom_bodyid[g])).name
        looks.setdefault(ours.get(name, name), []).append(g)
    bare = [THEIRS.get(name, name) for name in bodies if name not in looks]
    if bare or looks.keys() - bodies.keys():
        named = ", ".join([*bare, *sorted(looks.keys() - bodies.keys())])
        raise RobotError(f"{path} is not the robot of MuJoCo Menagerie: nothing to look at for body {named}")
    made: dict[int, str] = {}
    for name, geoms in looks.items():
        for covered in bodies[name].findall("geom"):
            if covered.get("name") not in MAST:
                covered.set("group", str(HULL_GROUP))
        for g in geoms:
            bodies[name].append(_look(model, g, assets, made))


def _is_look(model: Any, g: int) -> bool:
    touches = model.geom_contype[g] or model.geom_conaffinity[g]
    return bool(model.geom_type[g] == mujoco.mjtGeom.mjGEOM_MESH and not touches)


def _look(model: Any, g: int, assets: ET.Element, made: dict[int, str]) -> ET.Element:
    """The geom that shows geom `g` of `model`; its mesh is added to `assets` unless it is one of those `made`."""
    mesh = int(model.geom_dataid[g])
    if mesh not in made:
        made[mesh] = f"look_{len(made)}"
        vertices, faces = simplified(model, mesh)
        assets.append(
            ET.Element("mesh", name=made[mesh], vertex=_text(np.round(vertices, 5)), face=_text(faces), inertia="shell")
        )
    material = int(model.geom_matid[g])
    rgba = model.mat_rgba[material] if material >= 0 else model.geom_rgba[g]
    return ET.Element(
        "geom", type="mesh", mesh=made[mesh], pos=_text(model.geom_pos[g]), quat=_text(model.geom_quat[g]),
        rgba=_text(rgba), group=str(ROBOT_GROUP), contype="0", conaffinity="0",
    )  # fmt: skip


def _text(values: Any) -> str:
    return " ".join(f"{v:.9g}" for v in np.ravel(values))


def simplified(model: Any, mesh: int) -> tuple[Array, NDArray[np.int64]]:
    """Corners (n, 3) [m] and triangles (k, 3) of a compiled mesh, decimated to at most `FACES` or little more."""
    vertices, triangles = corners(model, mesh)
    return (vertices, triangles) if len(triangles) <= FACES else decimated(vertices, triangles, FACES)
