"""A robot's MJCF as URDF, for tools that know no other: links, joints, limits, inertias and shapes.

Meshes become the boxes around them: URDF refers to files, and there are none. What turns about a point beside its
origin gets a link of its own there, `<link>_pivot`. http://wiki.ros.org/urdf/XML
"""

from typing import Any
from xml.etree import ElementTree as Xml

import mujoco
import numpy as np

from common.geometry import quat_matrix
from common.messages.base import IDENTITY
from common.robot.frames import FramePose
from common.robot.joints import BASE_BODY
from common.robot.link_frames import link_name
from common.robot.shapes import Shape, shapes

PIVOT = "_pivot"
_HINGE, _SLIDE = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)


def urdf(mjcf: str) -> str:
    """The robot below the body `base`, which is the root `base_link` and does not move.

    Raises:
        ValueError: not a model, or a link with several joints.
        KeyError: no body `base`.
    """
    model: Any = mujoco.MjModel.from_xml_string(mjcf)
    root = Xml.Element("robot", name="tidybot")
    base = model.body(BASE_BODY).id
    links: dict[str, Xml.Element] = {}
    for body in range(model.nbody):
        if model.body_rootid[body] != base:
            continue
        links[link_name(model, body)] = _link(root, model, body)
        if body != base:
            _joint(root, model, body)
    for number, shape in enumerate(shapes(model)):
        _visual(links[shape.link], shape, number)
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode", xml_declaration=True)


def pivots(mjcf: str) -> list[FramePose]:
    """The links that `urdf` adds, in the links that they carry; they do not move there."""
    model: Any = mujoco.MjModel.from_xml_string(mjcf)
    found = []
    for j in range(model.njnt):
        body = int(model.jnt_bodyid[j])
        if model.body(body).name != BASE_BODY and model.jnt_pos[j].any():
            name = link_name(model, body)
            x, y, z = (float(v) for v in model.jnt_pos[j])
            found.append(FramePose(name, name + PIVOT, (x, y, z), IDENTITY, 0.0))
    return found


def _link(root: Xml.Element, model: Any, body: int) -> Xml.Element:
    link = Xml.SubElement(root, "link", name=link_name(model, body))
    if model.body_mass[body] > 0:
        inertial = Xml.SubElement(link, "inertial")
        _origin(inertial, model.body_ipos[body], model.body_iquat[body])
        Xml.SubElement(inertial, "mass", value=_text(model.body_mass[body]))
        x, y, z = (_text(v) for v in model.body_inertia[body])
        Xml.SubElement(inertial, "inertia", ixx=x, iyy=y, izz=z, ixy="0", ixz="0", iyz="0")
    return link


def _visual(link: Xml.Element, shape: Shape, number: int) -> None:
    visual = Xml.SubElement(link, "visual")
    geometry = Xml.SubElement(visual, "geometry")
    length, _, height = shape.size
    if shape.form == "sphere":
        Xml.SubElement(geometry, "sphere", radius=_text(length / 2))
    elif shape.form == "cylinder":
        Xml.SubElement(geometry, "cylinder", radius=_text(length / 2), length=_text(height))
    else:
        Xml.SubElement(geometry, "box", size=" ".join(_text(v) for v in shape.size))
    _origin(visual, shape.position, shape.orientation)
    material = Xml.SubElement(visual, "material", name=f"shape_{number}")
    Xml.SubElement(material, "color", rgba=" ".join(_text(v) for v in shape.colour))


def _joint(root: Xml.Element, model: Any, body: int) -> None:
    """The joint that moves a link, or the fixed one that holds it."""
    name, parent = link_name(model, body), link_name(model, int(model.body_parentid[body]))
    place, turn = model.body_pos[body], model.body_quat[body]
    number, j = int(model.body_jntnum[body]), int(model.body_jntadr[body])
    if number > 1:
        raise ValueError(f"{name} has {number} joints; URDF knows links of one")
    if number == 0:
        _joined(root, f"{name}_fixed", "fixed", parent, name, place, turn)
        return
    anchor, limited = model.jnt_pos[j], bool(model.jnt_limited[j])
    kind = {_SLIDE: "prismatic", _HINGE: "revolute" if limited else "continuous"}.get(int(model.jnt_type[j]))
    if kind is None:
        raise ValueError(f"{name} has a joint that neither turns nor slides")
    moved = name
    if anchor.any():
        moved = name + PIVOT
        Xml.SubElement(root, "link", name=moved)
        place = place + quat_matrix(tuple(turn)) @ anchor
        _joined(root, f"{name}_fixed", "fixed", moved, name, -anchor, np.array(IDENTITY))
    joint = _joined(root, model.joint(j).name, kind, parent, moved, place, turn)
    Xml.SubElement(joint, "axis", xyz=" ".join(_text(v) for v in model.jnt_axis[j]))
    if kind != "continuous":
        low, high = model.jnt_range[j] if limited else (-np.pi, np.pi)
        # What limits its speed is the controller, which MJCF does not have: 0, as for what is not known.
        effort = model.jnt_actfrcrange[j][1] if model.jnt_actfrclimited[j] else 0.0
        Xml.SubElement(joint, "limit", lower=_text(low), upper=_text(high), effort=_text(effort), velocity="0")


def _joined(root: Xml.Element, name: str, kind: str, parent: str, child: str, place: Any, turn: Any) -> Xml.Element:
    joint = Xml.SubElement(root, "joint", name=name, type=kind)
    Xml.SubElement(joint, "parent", link=parent)
    Xml.SubElement(joint, "child", link=child)
    _origin(joint, place, turn)
    return joint


def _origin(element: Xml.Element, place: Any, turn: Any) -> None:
    """A place [m] and a quaternion (w, x, y, z) as URDF's fixed-axis roll, pitch and yaw."""
    angles = _roll_pitch_yaw(quat_matrix(tuple(turn)))
    Xml.SubElement(element, "origin", xyz=" ".join(_text(v) for v in place), rpy=" ".join(_text(v) for v in angles))


def _roll_pitch_yaw(r: Any) -> tuple[float, float, float]:
    """Angles about the fixed axes x, y and z, one after the other; roll is 0 where it cannot be told from yaw."""
    if abs(r[2, 0]) > 1 - 1e-9:
        return 0.0, -np.copysign(np.pi / 2, r[2, 0]), np.arctan2(-r[0, 1], r[1, 1])
    return np.arctan2(r[2, 1], r[2, 2]), np.arcsin(-r[2, 0]), np.arctan2(r[1, 0], r[0, 0])


def _text(value: Any) -> str:
    return f"{float(value):.9g}"
