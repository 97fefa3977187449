"""One robot's part of a MuJoCo world: its joints, motors, fingers and contacts. Names are resolved once."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.robot.model import ARM, BASE, arm_limits, pads, subtree
from common.time.lockstep import DT
from services.sim.contacts import Contacts
from services.sim.fingers import Fingers, view
from services.sim.model import Robot

Array = NDArray[np.float64]
AT_REST = 1e-3
"""Slower than this the pads stand still [m/s]."""


class Body:
    """The robot whose parts bear their own names in `names`, a model of the same world as `model`.

    Where several robots are in one world, each has a description of its own that differs in names alone.
    """

    def __init__(self, names: Any, model: Any, data: Any, robot: Robot, objects: dict[str, int]) -> None:
        self.names, self.model, self.data, self.robot = names, model, data, robot
        joints = (*BASE, *ARM)
        self.qpos_at = np.array([names.joint(j).qposadr[0] for j in joints])
        self.qvel_at = np.array([names.joint(j).dofadr[0] for j in joints])
        self.ctrl_at = np.array([names.actuator(j).id for j in joints])
        self.gripper_ctrl = names.actuator("gripper").id
        # Live views: looking an array up on MjData and indexing it by a list cost more than a physics step.
        self.joints = view(data.qpos, self.qpos_at)
        self.rates = view(data.qvel, self.qvel_at)
        self.forces = view(data.actuator_force, np.append(self.ctrl_at, self.gripper_ctrl))
        self.ctrl = view(data.ctrl, self.ctrl_at)
        self.lead = servo_lead(model, self.ctrl_at, self.qvel_at) / DT
        self._grip_limit = 0.99 * float(model.actuator_forcerange[self.ctrl_at[0], 1])
        self.lidar_site = names.site("lidar").id
        self.pads = pads(names)
        self.fingers = Fingers(names, data)
        self.home_arm = robot.home
        self.arm_limits = arm_limits(names)
        self.gripper_bodies = subtree(names, "gripper")
        base = names.body("base").id
        self.robot_bodies = {b for b in range(model.nbody) if model.body_rootid[b] == model.body_rootid[base]}
        self.contacts = Contacts(names, self.robot_bodies, self.pads, objects)

    def at_home(self, pose: tuple[float, float, float]) -> None:
        """Put the robot at a pose (x, y, yaw) [map] with its arm as it is carried."""
        home = (*pose, *self.home_arm)
        self.data.qpos[self.qpos_at] = home
        self.data.ctrl[self.ctrl_at] = home

    def grip(self, closed: float, effort: float) -> None:
        """Drive the fingers to `closed` (0..1) with at most `effort` newtons each."""
        self.fingers.close(closed)
        self.limit_effort(effort)

    def limit_effort(self, effort: float) -> None:
        """The most that each finger presses [N]; not part of MuJoCo's state."""
        most = effort * self.fingers.per_newton
        self.model.actuator_forcerange[self.gripper_ctrl] = (-most, most)

    def sliding(self) -> bool:
        """True while the base's wheels push or brake with all that their tyres hold."""
        fx, fy, *_ = self.forces.tolist()
        return bool(max(abs(fx), abs(fy)) >= self._grip_limit)

    def width(self) -> float:
        """Distance between the pads [m]."""
        return self.fingers.width()

    def width_rate(self) -> float:
        """How fast the pads move apart [m/s]."""
        return self.fingers.rate()

    def finger_force(self) -> float:
        """Closing force of one finger [N]."""
        return float(self.forces[-1] / self.fingers.per_newton)

    def arm_rests(self, change: Array) -> bool:
        """True while arm and fingers rest; `change` (10,) of the set-points in this tick."""
        return not change[3:].any() and abs(self.fingers.rate()) < AT_REST


def servo_lead(model: Any, actuators: NDArray[np.int64], dofs: NDArray[np.int64]) -> Array:
    """Seconds (n,) by which a position servo trails a set-point that moves evenly: (kv + damping) / kp.

    A set-point that leads by as much, as the arm's own controller does by feeding the velocity forward, leaves no
    error but that of inertia.
    """
    gain, rate_gain = model.actuator_gainprm[actuators, 0], -model.actuator_biasprm[actuators, 2]
    return np.asarray((rate_gain + model.dof_damping[dofs]) / gain)
