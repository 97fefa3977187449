"""What the hand meets, felt in the joints' torques: motions near things end when it is more than they should be."""

from dataclasses import dataclass
from typing import Any, Literal, Protocol

import mujoco
import numpy as np

from common.geometry import Array
from services.manipulation.arm.arm_model import ArmModel

TOUCHED = "TOUCHED"
TOO_HEAVY = "TOO_HEAVY"
BLOCKED = "BLOCKED"
Way = Literal["any", "up", "down"]
MET = 20.0
"""Force [N] on the hand from which it has met something: on its way without contact the arm's own inertia shows as at
most 9 N, and a finger slides an object of 1 kg aside with less than 10."""
HIT, STRAIN = 30.0, 12.0
"""Force [N] on the hand, or torque [Nm] of a joint, from which the arm has met something in free motion: at full speed
its own inertia shows as at most 18 N and 7 Nm, and a light touch there is no reason to stop."""
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
        # A force at the pinch point alone: with a moment beside it, 2 Nm of the arm's own inertia pass for 20 to 36 N.
        found: Any = np.linalg.lstsq(self._lever(joints), torques, rcond=None)[0]
        return np.asarray(found)

    def torques(self, joints: Array, force: Array) -> Array:
        """Torques (7,) [Nm] with which the hand presses with `force` (3,) [N]."""
        return np.asarray(self._lever(joints) @ force)

    def moved(self, joints: Array, way: Array) -> Array:
        """Change of the joints (7,) [rad] that moves the hand by `way` (3,) [m] without turning it."""
        self._lever(joints)
        found: Any = np.linalg.lstsq(self._jacobian[:, self._dofs], np.concatenate([way, np.zeros(3)]), rcond=None)[0]
        return np.asarray(found)

    def weight(self, joints: Array) -> Array:
        """Torques (7,) [Nm] that hold the arm's own weight."""
        self._place(joints)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_comVel(self._model, self._data)
        mujoco.mj_rne(self._model, self._data, 0, bias := np.zeros(self._model.nv))
        return np.asarray(bias[self._dofs])

    def _lever(self, joints: Array) -> Array:
        """(7, 3): torques by force on the hand."""
        self._place(joints)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_jacSite(self._model, self._data, self._jacobian[:3], self._jacobian[3:], self._pinch)
        return np.asarray(self._jacobian[:3, self._dofs].T)

    def position(self, joints: Array) -> Array:
        """The pinch point (3,) in the base frame [m]."""
        self._place(joints)
        found: Array = self._data.site_xpos[self._pinch].copy()
        return found

    def _place(self, joints: Array) -> None:
        self._data.qpos[self._qpos] = joints
        mujoco.mj_kinematics(self._model, self._data)


class Compliance(Protocol):
    """Moves the hand by what it feels: set-points (7,) [rad] from joints (7,) [rad] and torques (7,) [Nm]."""

    def step(self, joints: Array, torques: Array) -> Array: ...


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


@dataclass(frozen=True)
class Watch:
    """Ends a free motion, with BLOCKED, where the arm meets what it was planned to pass.

    `load` (3,) [N] is the force of the hand that carries what it holds; `weighs`: the torques tell the arm's own weight
    too, which some drivers take off. `most`: force [N] on the hand from which it has met something.
    """

    reaction: Reaction
    load: Array
    weighs: bool
    most: float = HIT

    def feel(self, joints: Array, torques: Array) -> tuple[str, float]:
        """BLOCKED, or "" where the motion may go on, and the force [N] on the hand that was felt."""
        extra = torques - self.reaction.torques(joints, self.load)
        if self.weighs:
            extra = extra - self.reaction.weight(joints)
        felt = float(np.linalg.norm(self.reaction.force(joints, extra)))
        # What hangs beside the pinch point, and swings, shows as up to a half of its weight, at half a metre.
        more = float(self.load[2]) / 2
        met = felt > self.most + more or float(np.abs(extra).max()) > STRAIN + more / 2
        return (BLOCKED if met else ""), felt


def watch(reaction: Reaction, joints: Array, torques: Array, holds: bool, weighs: bool, most: float = HIT) -> Watch:
    """For a motion that begins at `joints` (7,) with `torques` (7,) [Nm]; what the hand `holds` hangs on it."""
    upward = 0.0
    if holds:
        upward = float(reaction.force(joints, torques - (reaction.weight(joints) if weighs else 0.0))[2])
    return Watch(reaction, np.array([0.0, 0.0, max(0.0, upward)]), weighs, most)


def tells_weight(reaction: Reaction, joints: Array, torques: Array) -> bool:
    """Whether the torques (7,) [Nm] of an arm with an empty hand tell its own weight."""
    return bool(np.linalg.norm(torques - reaction.weight(joints)) < np.linalg.norm(torques))
