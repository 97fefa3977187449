"""A policy in some eighty lines, `manipulation.policy = "examples.reach_policy:FromAbove"`: from above, close, lift.

It is called with what a demonstration's frame shows (docs/LEARNING.md) and answers as its action; a learned policy
would look at the pictures, this one at `object.position`, which the robot tells beside them.
"""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from common.robot.joints import ARM

Array = NDArray[np.float64]
ABOVE, LIFT = 0.06, 0.06
"""How far [m] above the object's top the pads begin, and how far they lift: much higher the wrist, with the hand
pointing down, is at its joint's limit."""
BEGIN = 0.135
"""How far [m] above the surface the pads begin at least: on their way there they pass its edge."""
DEPTH, PALM = 0.01, 0.035
"""How far [m] below the object's middle the pads close, and at most below its top, where the palm would meet it."""
CLEAR = 0.022
"""How far [m] above the surface the pads' middle stays: they come lower on their arc as they close."""
STEP = 0.04
"""Most that a joint moves from one action to the next [rad]: 0.8 rad/s at 20 Hz."""
NEAR = 0.004
"""Distance [m] at which a way point counts as reached."""
CLOSING = 25
"""Actions for which the fingers close before the hand lifts: more than a second."""


class FromAbove:
    """One episode; the base's part of the action is zero."""

    def __init__(self) -> None:
        self._model: Any = None
        self._closed = self._waited = 0

    def __call__(self, seen: dict[str, Any]) -> list[float] | None:
        """The next action, None when the object has been lifted."""
        joints = np.asarray(seen["observation.state"][3:10], float)
        if self._model is None:
            self._begin(seen, joints)
        at = self._ways[0]
        gap = self._step(at)
        if gap < NEAR and np.abs(joints - self._q).max() < 0.03:
            if len(self._ways) == 2 and self._waited < CLOSING:  # around the object
                self._closed, self._waited = 1, self._waited + 1
            elif len(self._ways) == 1:
                return None
            else:
                self._ways.pop(0)
        return [0.0, 0.0, 0.0, *self._q.tolist(), float(self._closed)]

    def _begin(self, seen: dict[str, Any], joints: Array) -> None:
        self._model = mujoco.MjModel.from_xml_string(seen["robot.mjcf"])
        self._data: Any = mujoco.MjData(self._model)
        self._q = joints
        self._at = [self._model.joint(j).qposadr[0] for j in ARM]
        self._dof = [self._model.joint(j).dofadr[0] for j in ARM]
        half = seen["object.size"][2] / 2
        depth = min(DEPTH, PALM - half, half - CLEAR)
        middle = np.array(seen["object.position"]) - [0.0, 0.0, depth]
        up = np.array([0.0, 0.0, 1.0])
        self._ways = [middle + (depth + max(half + ABOVE, BEGIN - half)) * up, middle, middle + LIFT * up]
        # The fingers close along the side of the object that is nearest to straight across.
        turn = (seen["object.yaw"] + np.pi / 4) % (np.pi / 2) - np.pi / 4
        across = np.array([-np.sin(turn), np.cos(turn), 0.0])
        self._turn = np.stack([np.cross(across, -up), across, -up], axis=1)

    def _step(self, where: Array) -> float:
        """Move the targets by one step of damped least squares; how far the hand is from there [m]."""
        model, data, jacobian = self._model, self._data, np.zeros((6, self._model.nv))
        data.qpos[self._at] = self._q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        site = model.site("pinch").id
        mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], site)
        off, error = np.empty(4), np.zeros(3)
        mujoco.mju_mat2Quat(off, (self._turn @ data.site_xmat[site].reshape(3, 3).T).reshape(-1))
        mujoco.mju_quat2Vel(error, off, 1.0)
        gap = where - data.site_xpos[site]
        own = jacobian[:, self._dof]
        twist = np.concatenate([np.clip(gap, -0.02, 0.02), np.clip(error, -0.15, 0.15)])
        step = own.T @ np.linalg.solve(own @ own.T + 1e-4 * np.eye(6), twist)
        self._q = self._q + step * min(1.0, STEP / max(float(np.abs(step).max()), 1e-9))
        return float(np.linalg.norm(gap) + 0.1 * np.linalg.norm(error))
