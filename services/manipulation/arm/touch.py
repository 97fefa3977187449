"""What the hand meets, felt in the joints' torques: motions near things end when it is more than they should be."""

from dataclasses import dataclass
from typing import Any, Literal

import mujoco
import numpy as np

from services.manipulation.arm.arm_model import ArmModel, Array

TOUCHED = "TOUCHED"
TOO_HEAVY = "TOO_HEAVY"
Way = Literal["any", "up", "down"]
MET = 20.0
"""Force [N] on the hand from which it has met something: on its way without contact the arm's own inertia shows as at
most 9 N, and a finger slides an object of 1 kg aside with less than 10."""
GRIP_FRICTION = 0.6
"""Least friction of a pad that is counted on: rubber on smooth painted or plastic faces has 0.6 to 1."""


class Reaction:
    """The arm's Jacobian at the pinch point, on data of its own: the planner's model is busy in the worker."""

    def __init__(self, arm: ArmModel) -> None:
        self._model, self._data = arm.model, mujoco.MjData(arm.model)
        self._qpos, self._dofs, self._pinch = arm.qpos_at, arm.dof_at, arm.pinch
        self._jacobian = np.zeros((6, arm.model.nv))

    def force(self, joints: Array, torques: Array) -> Array:
        """Force (3,) [N] in the base frame with which the hand presses, by `torques` (7,) [Nm] at `joints` (7,)."""
        model, data, jacobian = self._model, self._data, self._jacobian
        self._place(joints)
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], self._pinch)
        # A force at the pinch point alone: with a moment beside it, 2 Nm of the arm's own inertia pass for 20 to 36 N.
        found: Any = np.linalg.lstsq(jacobian[:3, self._dofs].T, torques, rcond=None)[0]
        return np.asarray(found)

    def position(self, joints: Array) -> Array:
        """The pinch point (3,) in the base frame [m]."""
        self._place(joints)
        found: Array = self._data.site_xpos[self._pinch].copy()
        return found

    def _place(self, joints: Array) -> None:
        self._data.qpos[self._qpos] = joints
        mujoco.mj_kinematics(self._model, self._data)


def load_limit(grip_effort: float) -> float:
    """The weight [N] that two pads with `grip_effort` [N] each can be counted on to hold."""
    return 2 * grip_effort * GRIP_FRICTION


@dataclass(frozen=True)
class Guard:
    """Ends a motion by a force of the hand beyond `most` [N] in its `way`: upwards it is TOO_HEAVY, else TOUCHED.

    `rest` are the torques (7,) [Nm] of the arm before it met anything.
    """

    reaction: Reaction
    rest: Array
    most: float = MET
    way: Way = "any"

    def feel(self, joints: Array, torques: Array) -> tuple[str, float]:
        """The code of a motion that has to end here, "" if it may go on, and the force [N] that was felt."""
        force = self.reaction.force(joints, torques - self.rest)
        upward = float(force[2])
        felt = {"any": float(np.linalg.norm(force)), "up": upward, "down": -upward}[self.way]
        if felt <= self.most:
            return "", felt
        return (TOO_HEAVY if self.way == "up" else TOUCHED), felt
