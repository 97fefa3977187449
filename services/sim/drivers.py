"""The robot's drivers: what the base, the arm and the gripper are told, and the set-points their servos follow."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from common.time.lockstep import DT
from services.sim.arm import ArmDriver
from services.sim.base import BaseDriver
from services.sim.body import Body
from services.sim.checkpoint import Checkpoint
from services.sim.config import SimConfig

MAX_DISTANCE = 50.0
"""Largest coordinate [m] or velocity [m/s, rad/s] that is no mistake: beyond the largest flat."""
Array = NDArray[np.float64]


class Drivers:
    """Base, arm and gripper of the simulated robot. `told` hears of every stop and of the end of one: state, detail."""

    def __init__(self, config: SimConfig, io: Io, body: Body, pose: Pose2, told: Callable[[str, str], None]) -> None:
        self._config, self._io, self._body, self._told = config, io, body, told
        self.setpoint: Array = np.array([*pose, *body.home_arm])
        self.base = BaseDriver(config, pose)
        self._arm = ArmDriver(np.array(body.home_arm), config.stream_timeout, body.arm_limits)
        self.effort = body.fingers.force
        body.grip(0.0, self.effort)

    def resume(self, state: Checkpoint) -> None:
        """Stand at rest where another process left the robot, nothing commanded."""
        actual = self._body.joints
        self.put((float(actual[0]), float(actual[1]), float(actual[2])), stopped=state.stopped)
        self.setpoint[3:] = state.setpoint[3:]
        self._arm = ArmDriver(self.setpoint[3:], self._config.stream_timeout, self._body.arm_limits)
        self.effort = state.effort
        self._body.limit_effort(state.effort)

    def put(self, pose: Pose2, stopped: bool = False) -> None:
        """The base rests at a pose (x, y, yaw)."""
        self.base = BaseDriver(self._config, pose, stopped=stopped)
        self.setpoint[:3] = self._body.ctrl[:3] = pose

    def advance(self, believed: Pose2, now: float) -> tuple[Array, Array]:
        """Set-points (10,) of base, arm at the begin and at the end of a tick; `believed`: the odometry's pose."""
        x, y, yaw, *_ = self._body.joints.tolist()
        fx, fy, *_ = self._body.forces.tolist()
        after = np.empty(10)
        after[:3] = self.base.advance((x, y, yaw), believed, now, DT, (fx, fy))
        if self.base.yielding:
            self.setpoint[:3] = after[:3]
        after[3:] = self._arm.advance(now, DT)
        before, self.setpoint = self.setpoint, after
        return before, after

    def take_commands(self, now: float) -> None:
        """Hear what came since the last tick; what is out of range is counted and not followed."""
        io = self._io
        self._take_stops()
        for target in io.take_all(topics.BASE_TARGET):
            if not all(map(_sane, (target.x, target.y, target.theta))):
                io.count_drop(topics.BASE_TARGET.key, "not a finite pose near the apartment")
            elif not self.base.stopped:
                self.base.go_to(target.x, target.y, target.theta, target.id, now)
        for twist in io.take_all(topics.CMD_VEL):
            if not all(map(_sane, (twist.vx, twist.vy, twist.omega))):
                io.count_drop(topics.CMD_VEL.key, "not a finite velocity")
            elif not self.base.stopped:
                self.base.drive(twist.vx, twist.vy, twist.omega, now)
        arm = self._body.joints[3:]
        for command in io.take_all(topics.ARM_COMMAND):
            if self.base.stopped:
                continue
            if why := self._arm.follow(command.position, command.period, now, arm):
                io.count_drop(topics.ARM_COMMAND.key, why)
        for grip in io.take_all(topics.GRIPPER_COMMAND):
            if not (0.0 <= grip.position <= 1.0 and grip.max_effort > 0.0):
                io.count_drop(topics.GRIPPER_COMMAND.key, "position is 0..1, max_effort above 0")
            elif not self.base.stopped:
                self.effort = min(grip.max_effort, self._body.fingers.force)
                self._body.grip(grip.position, self.effort)

    def _take_stops(self) -> None:
        io = self._io
        stops, resumes = io.take_all(topics.ROBOT_STOP), io.take_all(topics.ROBOT_RESUME)
        if resumes and self.base.stopped:
            self.base.stopped = False
            io.log.info("resumed", by=resumes[-1].source)
            self._told("running", "")
        if not stops:
            return
        actual = self._body.joints.copy()
        if not self.base.stopped:
            io.log.warning("stopped", reason=stops[-1].reason, by=stops[-1].source)
            self._told("stopped", stops[-1].reason)
            self.setpoint = actual.copy()
        self.base.halt((float(actual[0]), float(actual[1]), float(actual[2])))
        self._arm.halt(actual[3:])


def _sane(value: float) -> bool:
    return math.isfinite(value) and abs(value) <= MAX_DISTANCE
