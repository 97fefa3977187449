"""The robot's drivers: from commands to base, arm and gripper to the set-points that their servos follow."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from common import topics
from common.bus.port import Io
from common.geometry import Array, Pose2
from common.time.lockstep import DT
from services.sim.base import BaseDriver
from services.sim.body import Body
from services.sim.checkpoint import Checkpoint
from services.sim.config import SimConfig

JUMP = 0.6
"""Largest way [rad] of a joint to its next set-point that is no mistake."""
BEGIN = 0.05
"""Largest way [rad] of a joint to the first set-point after silence: a stream begins where the arm is, or was told to
be. What went on while nobody heard it would be caught up with at full speed, past the path. Chosen: the arm's sag is
less."""
SPEED, ACCELERATION = np.array([1.39] * 4 + [1.22] * 3), np.array([5.2] * 4 + [10.0] * 3)
"""What the joints (7,) of a Kinova Gen3 can do [rad/s, rad/s^2] (user guide): so set-points that come late, or all at
once, are caught up with."""
HASTE, LEAST, FADES = 1.0, 0.1, 0.9
"""How much faster than its stream the arm catches up with it, as a share of the stream's speed, and at least [rad/s];
share of the speed that is remembered from one set-point to the next. Chosen: something in the hand that goes down at 6
cm/s, so that it may meet its surface, meets it at 12 at the most."""
LATE = 1.5
"""Periods without a set-point [count] from which the next one is late."""
MAX_DISTANCE = 50.0
"""Largest coordinate [m] or velocity [m/s, rad/s] that is no mistake: beyond the largest flat."""


class Drivers:
    """Drivers of base, arm and gripper; `on_brake(state, detail)` is called when the brake is applied or released."""

    def __init__(
        self, config: SimConfig, io: Io, body: Body, pose: Pose2, on_brake: Callable[[str, str], None]
    ) -> None:
        self._config, self._io, self._body, self._on_brake = config, io, body, on_brake
        self.setpoint: Array = np.array([*pose, *body.home_arm])
        self.base = BaseDriver(config, pose)
        self._arm = ArmDriver(np.array(body.home_arm), config.stream_timeout, body.arm_limits)
        self.effort = body.fingers.force
        body.grip(0.0, self.effort)

    def resume(self, state: Checkpoint) -> None:
        """Go on from a checkpoint: at rest where the robot was, with nothing commanded."""
        actual = self._body.joints
        self.put((float(actual[0]), float(actual[1]), float(actual[2])), stopped=state.stopped)
        self.setpoint[3:] = state.setpoint[3:]
        self._arm = ArmDriver(self.setpoint[3:], self._config.stream_timeout, self._body.arm_limits)
        self.effort = state.effort
        self._body.limit_effort(state.effort)

    def put(self, pose: Pose2, stopped: bool = False) -> None:
        """Set the base's set-point to a pose (x, y, yaw) [map], at rest."""
        self.base = BaseDriver(self._config, pose, stopped=stopped)
        self.setpoint[:3] = self._body.ctrl[:3] = pose

    def advance(self, believed: Pose2, now: float) -> tuple[Array, Array]:
        """Set-points (10,) of base and arm at the beginning and the end of a tick; `believed`: the pose by odometry."""
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
        """Take the commands since the last tick; those out of range are counted and not followed."""
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
            self._on_brake("running", "")
        if not stops:
            return
        actual = self._body.joints.copy()
        if not self.base.stopped:
            io.log.warning("stopped", reason=stops[-1].reason, by=stops[-1].source)
            self._on_brake("stopped", stops[-1].reason)
            self.setpoint = actual.copy()
        self.base.halt((float(actual[0]), float(actual[1]), float(actual[2])))
        self._arm.halt(actual[3:])


def _sane(value: float) -> bool:
    return math.isfinite(value) and abs(value) <= MAX_DISTANCE


# --- the arm's driver: follows a stream of joint set-points and holds when it falls silent
class ArmDriver:
    """Moves the set-point (7,) linearly to each commanded one within its period, or the time since the last one where
    that is late, as far as `SPEED` and `ACCELERATION` allow; `limits` lowest and highest angles.

    Behind a stream it catches up no faster than it can brake to the stream's own speed, nor than twice that speed: what
    is told to go slowly goes slowly.
    """

    def __init__(self, position: Array, timeout: float, limits: tuple[Array, Array]) -> None:
        self._low, self._high = limits
        self._position, self._goal = position.copy(), position.copy()
        self._velocity: Array = np.zeros(7)
        self._stream: Array = np.zeros(7)
        self._pace: Array = np.zeros(7)
        self._left, self._timeout, self._heard = 0.0, timeout, -math.inf
        self._rests = False

    def follow(self, position: list[float], period: float, now: float, actual: Array) -> str:
        """Take the next set-point, with the joints (7,) at `actual`; returns why it is refused, "" if it is not."""
        goal: Any = np.array(position)
        if goal.shape != (7,) or not np.isfinite(goal).all() or not 0 < period <= 1.0:
            return "a set-point is 7 finite angles and a period of at most 1 s"
        if (goal < self._low).any() or (goal > self._high).any():
            return "set-point beyond a joint limit"
        if np.abs(goal - self._position).max() > JUMP:
            return f"set-point jumps by more than {JUMP} rad"
        gap = now - self._heard
        if gap > self._timeout and min(np.abs(goal - at).max() for at in (self._position, actual)) > BEGIN:
            return f"the stream does not begin within {BEGIN} rad of where the arm is"
        # Where set-points come late it moves as long as they take: it would stop and start again at each of them.
        self._left = gap if LATE * period < gap < self._timeout else period
        self._stream = (goal - self._goal) / self._left if gap < self._timeout else np.zeros(7)
        self._pace = np.maximum(np.abs(self._stream), FADES * self._pace)
        self._goal, self._heard, self._rests = goal, now, False
        return ""

    def halt(self, actual: Array) -> None:
        """Hold the measured position."""
        self._position, self._goal, self._left = actual.copy(), actual.copy(), 0.0
        self._velocity, self._rests = np.zeros(7), False

    def advance(self, now: float, dt: float) -> Array:
        """The set-point after `dt` seconds."""
        if self._rests:
            return self._position
        if now - self._heard > self._timeout:
            self._left, self._goal = 0.0, self._position
        way = self._goal - self._position
        if self._left > 0:
            # Half of the acceleration brakes it to the speed of the stream, which may brake with the other half.
            room = np.minimum(np.sqrt(ACCELERATION * np.abs(way)), HASTE * self._pace + LEAST)
            wanted = _between(way / max(self._left, dt), self._stream - room, self._stream + room)
        else:
            # Nothing more was said: it comes to rest there.
            wanted = np.sign(way) * np.minimum(np.abs(way) / dt, np.sqrt(2 * ACCELERATION * np.abs(way)))
        most = ACCELERATION * dt
        change = _between(wanted - self._velocity, -most, most)
        self._velocity = _between(self._velocity + change, -SPEED, SPEED)
        self._position = _between(self._position + self._velocity * dt, self._low, self._high)
        self._left = max(0.0, self._left - dt)
        self._rests = not (self._left or self._velocity.any() or (self._goal != self._position).any())
        return self._position


def _between(values: Array, low: Array, high: Array) -> Array:
    """The values (n,) within their limits, as `np.clip` at a third of its time for so few."""
    bounded: Array = np.minimum(np.maximum(values, low), high)
    return bounded
