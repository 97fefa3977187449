"""Calibration of the gripper's linkage on the model: width, posture and pinch point for the motor's travel."""

import xml.etree.ElementTree as ET
from typing import Any

import mujoco
import numpy as np

from common.geometry import Array
from common.robot.joints import ARM, BASE
from common.robot.model import (
    HAND_ADVANCES,
    HAND_JOINTS,
    HAND_LENGTHS,
    HAND_POSTURES,
    HAND_WIDTHS,
    home_arm,
    pads,
    subtree,
)  # fmt: skip

STEPS, SETTLE = 11, 500
"""Postures of the gripper that are measured, and steps of physics [2 ms] until it rests in each."""


def load(root: ET.Element) -> tuple[Any, Any]:
    """The model in its keyframe `home`."""
    model: Any = mujoco.MjModel.from_xml_string(ET.tostring(root, encoding="unicode"))
    data: Any = mujoco.MjData(model)
    data.qpos[[model.joint(j).qposadr[0] for j in ARM]] = home_arm(model)
    mujoco.mj_forward(model, data)
    return model, data


def measure_hand(root: ET.Element) -> None:
    """Close the gripper step by step, write widths and postures into the model, and place the site `pinch`."""
    model, data = load(root)
    model.opt.gravity[:] = 0.0
    model.opt.timestep, model.opt.integrator = 0.002, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.opt.cone, model.opt.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10
    for name in (*BASE, *ARM):
        data.ctrl[model.actuator(name).id] = data.qpos[model.joint(name).qposadr[0]]
    hand = subtree(model, "gripper")
    joints = [j for j in range(model.njnt) if int(model.jnt_bodyid[j]) in hand]
    gripper = model.actuator("gripper").id
    low, high = model.actuator_ctrlrange[gripper]
    widths, lengths, postures, places = [], [], [], []
    axis = np.zeros(3)
    for closed in np.linspace(0.0, 1.0, STEPS):
        data.ctrl[gripper] = low + closed * (high - low)
        mujoco.mj_step(model, data, SETTLE)
        mujoco.mj_kinematics(model, data)
        left, right = (np.mean([data.geom_xpos[g] for g in side], axis=0) for side in pads(model))
        if not axis.any():
            axis = (left - right) / np.linalg.norm(left - right)
        widths.append(max(0.0, _gap(model, data, axis)))
        lengths.append(float(data.actuator_length[gripper]))
        postures.append([float(data.qpos[model.jnt_qposadr[j]]) for j in joints])
        places.append((left + right) / 2)
    approach = _place_pinch(root, model, data, places[STEPS // 2], axis)
    advances = [float((place - places[STEPS // 2]) @ approach) for place in places]
    # Where nothing is left to close, more travel says nothing.
    keep = [0] + [i for i in range(1, STEPS) if widths[i] < widths[i - 1] - 1e-4]
    custom = ET.SubElement(root, "custom")
    table = ((HAND_WIDTHS, widths), (HAND_LENGTHS, lengths), (HAND_POSTURES, postures), (HAND_ADVANCES, advances))
    for name, values in table:
        flat = np.ravel([values[i] for i in keep])
        ET.SubElement(custom, "numeric", name=name, data=" ".join(f"{v:.6g}" for v in flat))
    ET.SubElement(custom, "text", name=HAND_JOINTS, data=" ".join(model.joint(j).name for j in joints))


def _gap(model: Any, data: Any, axis: Array) -> float:
    """Free space between the pads along `axis`, which points from right to left."""
    faces = []
    for side, sign in zip(pads(model), (1.0, -1.0), strict=True):
        ends = []
        for g in side:
            turn, box = data.geom_xmat[g].reshape(3, 3), model.geom_aabb[g]
            middle = data.geom_xpos[g] + turn @ box[:3]
            ends.append(sign * float(middle @ axis) - float(np.abs(turn.T @ axis) @ box[3:]))
        faces.append(sign * min(ends))
    return faces[0] - faces[1]


def _place_pinch(root: ET.Element, model: Any, data: Any, place: Array, closing: Array) -> Array:
    """The site's z along the approach as the model has it, y along the closing direction from right to left.

    Returns the approach (3,) in the world.
    """
    site = model.site("pinch")
    body = int(model.site_bodyid[site.id])
    turn = data.xmat[body].reshape(3, 3)
    z = data.site_xmat[site.id].reshape(3, 3)[:, 2]
    y = closing - (closing @ z) * z
    y /= np.linalg.norm(y)
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, (turn.T @ np.stack([np.cross(y, z), y, z], axis=1)).reshape(-1))
    element = next(e for e in root.iter("site") if e.get("name") == "pinch")
    element.set("pos", " ".join(f"{v:.9g}" for v in turn.T @ (place - data.xpos[body])))
    element.set("quat", " ".join(f"{v:.9g}" for v in quat))
    return np.asarray(z)
