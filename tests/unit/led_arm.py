"""Manipulation with an arm that goes where it is told at once, for tests of who leads it."""

import numpy as np

from common import messages as m
from common import topics
from common.bus import codec
from common.geometry import Array
from common.household import load_household
from services.manipulation.arm.arm_model import ArmModel
from services.manipulation.config import ManipulationConfig
from services.manipulation.service import ManipulationService
from services.sim.model import own
from tests.node import Node
from tests.support import JOINT_NAMES

PERIOD = 0.02
HOME = load_household("minimal")


class LedArm(Node):
    """`press`: a force [N] on the hand along x, y, z as the motors feel it; `width`, `force` of the gripper."""

    def __init__(self, lockstep: bool = True, **config: object) -> None:
        self.config = ManipulationConfig(**config)  # type: ignore[arg-type]
        super().__init__(ManipulationService, self.config, HOME, lockstep=lockstep)
        self.model = ArmModel(own().mjcf)
        self.q: Array = self.model.home.copy()
        self.press = np.zeros(3)
        self.width, self.force = 0.085, 0.0
        self.followed: list[Array] = [self.q]
        self.follows = True
        self._commands = self.bus.tap(topics.ARM_COMMAND)
        self._taken = 0
        self.bus.send(topics.ROBOT_DESCRIPTION, m.RobotDescription(mjcf=own().mjcf))

    def feed(self) -> None:
        for payload in self._commands[self._taken :]:
            self.followed.append(np.array(codec.decode(topics.ARM_COMMAND, payload).position))
        self._taken = len(self._commands)
        if self.follows:
            self.q = self.followed[-1]
        effort = np.zeros(11)
        effort[3:10], effort[10] = self.torques(), self.force
        position = [0.0, 0.0, 0.0, *self.q.tolist(), self.width]
        state = m.JointStates(
            t=self.now, name=list(JOINT_NAMES), position=position, velocity=[0.0] * 11, effort=effort.tolist()
        )
        self.bus.send(topics.JOINT_STATES, state)
        self.bus.send(topics.POSE, m.PoseEstimate(t=self.now, x=0.0, y=0.0, theta=0.0))

    def torques(self) -> Array:
        """What the motors feel (7,) [Nm] of the force on the hand."""
        if not self.press.any():
            return np.zeros(7)
        import mujoco

        model, data, jacobian = self.model.model, self.model.data, np.zeros((3, self.model.model.nv))
        self.model.place(self.q)
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, jacobian, None, self.model.pinch)
        return np.asarray(jacobian[:, self.model.dof_at].T @ self.press)

    def hand(self) -> Array:
        """The pinch point (3,) in the base frame [m]."""
        return self.model.pose(self.q).position

    def rates(self) -> Array:
        """Speeds (n, 7) [rad/s] of the set-points."""
        return np.diff(np.array(self.followed), axis=0) / PERIOD

    def status(self) -> m.ManipulationStatus:
        return self.last(topics.MANIPULATION_STATUS)
