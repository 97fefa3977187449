"""Where the robot's cameras sit, for its description."""

import math
from typing import Any

import mujoco
import numpy as np

from common.messages import CameraMount

BASE = "base"


def head_camera(model: Any) -> CameraMount | None:
    """The mount of camera `head`, read from a compiled model; None when the base carries no such camera."""
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, "head")
    if number < 0 or model.body(int(model.cam_bodyid[number])).name != BASE:
        return None
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.cam_quat[number])
    # A camera of MuJoCo looks along its own -z.
    forward, left, up = (float(v) for v in -turn.reshape(3, 3)[:, 2])
    x, y, z = (float(v) for v in model.cam_pos[number])
    return CameraMount(
        x=x,
        y=y,
        z=z,
        yaw=math.atan2(left, forward),
        pitch=-math.asin(max(-1.0, min(1.0, up))),
        fovy=math.radians(float(model.cam_fovy[number])),
    )
