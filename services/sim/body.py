"""One robot in a MuJoCo world: its joints, motors, fingers and contacts, with names resolved once."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.robot.joints import ARM, BASE
from common.robot.model import Hand, arm_limits, pads, subtree
from common.time.lockstep import DT
from services.sim.contacts import ContactLog
from services.sim.model import Robot

SPEED = 0.150
"""How fast the pads come together at most [m/s]: Robotiq 2F-85, closing speed 20 to 150 mm/s."""
COUNTS = 255
"""Steps in which the gripper tells where its motor stands (Robotiq 2F-85, register gPO)."""
AT_REST = 1e-3
"""Slower than this the pads stand still [m/s]."""


class Body:
    """The robot whose parts have their plain names in `names`, a description of the same world as `model`.

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
        self.contacts = ContactLog(names, self.robot_bodies, self.pads, objects)

    def at_home(self, pose: tuple[float, float, float]) -> None:
        """Put the robot at a pose (x, y, yaw) [map] with its arm in the carry pose."""
        home = (*pose, *self.home_arm)
        self.data.qpos[self.qpos_at] = home
        self.data.ctrl[self.ctrl_at] = home

    def grip(self, closed: float, effort: float) -> None:
        """Drive the fingers to `closed` (0..1) with at most `effort` newtons each."""
        self.fingers.close(closed)
        self.limit_effort(effort)

    def limit_effort(self, effort: float) -> None:
        """Limit each finger's force [N]; the limit is not part of MuJoCo's state."""
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


def view(array: Any, at: NDArray[np.int64]) -> NDArray[np.float64]:
    """The entries `at` of an array of MjData, which must lie side by side, as a view that stays current."""
    if (np.diff(at) != 1).any():
        raise ValueError("the robot's joints and actuators must come in order in the model, side by side")
    found: NDArray[np.float64] = array[at[0] : at[-1] + 1]
    return found


# --- the gripper as its driver knows it: width and speed of the pads, and what a newton at a finger is at the motor
class Fingers:
    """Fingers that a motor moves through a linkage: the motor's travel says how wide they are.

    `force` is the most that one presses [N], `per_newton` the motor's force at one newton of a finger.
    """

    def __init__(self, model: Any, data: Any) -> None:
        actuator = model.actuator("gripper").id
        self._ctrl = data.ctrl[actuator:]
        self._low, self._high = (float(v) for v in model.actuator_ctrlrange[actuator])
        self._length, self._speed = data.actuator_length[actuator:], data.actuator_velocity[actuator:]
        table = Hand(model).table
        if table is None:
            raise ValueError("the model's gripper was not measured: it has no table of widths")
        widths, lengths, _ = table
        order = np.argsort(lengths)
        self._shortest, self._longest = float(lengths.min()), float(lengths.max())
        counted = self._shortest + np.arange(COUNTS + 1) / COUNTS * (self._longest - self._shortest)
        self._widths: list[float] = np.interp(counted, lengths[order], widths[order]).tolist()
        self._slope = float((widths[-1] - widths[0]) / (lengths[-1] - lengths[0]))
        # Virtual work: what the motor does along its travel, both fingers do along half the width each.
        self.per_newton = abs(self._slope)
        self.force = float(model.actuator_forcerange[actuator, 1]) / self.per_newton
        self._most = SPEED * DT / (widths[0] - widths[-1]) * (self._high - self._low)
        self.hold()

    def close(self, share: float) -> None:
        """Set the goal to `share` of the way from open (0) to closed (1)."""
        self._goal = self._low + share * (self._high - self._low)

    @property
    def wanted(self) -> float:
        """The goal: 0 open, 1 closed."""
        return (self._goal - self._low) / (self._high - self._low)

    def hold(self) -> None:
        """Set the goal to the present set-point."""
        self._goal = float(self._ctrl[0])

    def advance(self) -> None:
        """Move the set-point towards the goal for 10 ms, no faster than the pads can follow."""
        now, short, long = float(self._ctrl[0]), self._shortest, self._longest
        stands = self._low + (float(self._length[0]) - short) / (long - short) * (self._high - self._low)
        if (now - stands) * (self._goal - stands) < 0:
            now = stands  # what it pressed with leads beyond what keeps the pads apart
        self._ctrl[0] = now + max(-self._most, min(self._most, self._goal - now))

    def width(self) -> float:
        """Distance between the pads [m], with the resolution of the motor's encoder."""
        short, long = self._shortest, self._longest
        count = round((float(self._length[0]) - short) / (long - short) * COUNTS)
        return self._widths[max(0, min(COUNTS, count))]

    def rate(self) -> float:
        """How fast the pads move apart [m/s]."""
        return float(self._speed[0]) * self._slope
