"""The hand led by a person: while somebody holds on, slowly, within limits, and when nothing else moves it."""

from math import isfinite

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Job
from common.gateway import refusal
from common.geometry import Array
from services.manipulation.arm.arm_model import ArmModel
from services.manipulation.arm.servo import Servo
from services.manipulation.execution.feedback import LOADING
from services.manipulation.execution.robot import DT, Robot
from services.manipulation.planning.planning_scene import obstacles

SILENCE = 0.25
"""Age [s] of the newest word from which on the hand stops (dead-man switch): five words of 50 ms."""
SPEED, TURN = 0.12, 0.6
"""Greatest speed [m/s] and rate of turn [rad/s] of the hand, whatever is asked for; chosen: what a person follows."""
HOMING = 0.5
"""Share of the joints' speed on the way to the carry pose; chosen."""


class LedHand:
    """Idle until somebody leads; furniture and the robot itself are kept clear of, objects are there to be touched."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._loading: Job[ArmModel] | None = None
        self._servo: Servo | None = None
        self._moving = self._stopped = False
        self.left_out = False
        """The arm may be where a person has left it, and not at its carry pose."""

    def stop(self) -> None:
        """The brake: the hand moves again only after it has been let go of."""
        self._stopped, self._moving = True, False

    def step(self, mjcf: str, busy: bool) -> None:
        """Once a step; `busy`: a goal has the arm."""
        robot = self._robot
        io = robot.io
        wish = io.latest(topics.HAND_VELOCITY)
        silent = wish is None or io.age(topics.HAND_VELOCITY, robot.now) > SILENCE
        if silent:
            self._stopped = False
        fresh = bool(io.take_all(topics.HAND_VELOCITY))
        if busy or self._stopped or (silent and not self._moving) or not mjcf or refusal(io.latest(topics.BRAIN_STATE)):
            self._moving = False
            return
        servo = self._ready(mjcf)
        if servo is None or wish is None:
            return
        if not self._moving:
            around = obstacles(io.household, robot.base, [], without="", margin=0.0)
            servo.begin(robot.joints, robot.torques, around)
            self._moving = self.left_out = True
        if fresh and wish.fingers:
            closed = float(wish.fingers == "close")
            effort = robot.config.grip_effort
            io.publish(topics.GRIPPER_COMMAND, m.GripperCommand(position=closed, max_effort=effort))
        if np.abs(robot.joints - servo.q).max() > 2 * robot.config.blocked_error:
            self.stop()  # the brake is on, or something is in the way
            robot.forget_command()
            return
        self._lead(servo, wish, silent)
        robot.stream(servo.q)
        if silent and servo.still:
            self._moving = False
            robot.forget_command()

    def _lead(self, servo: Servo, wish: m.HandVelocity, silent: bool) -> None:
        robot = self._robot
        linear, angular = limited(wish.linear, SPEED), limited(wish.angular, TURN)
        if silent or linear is None or angular is None:
            servo.rest()
        elif wish.home:
            servo.towards(servo.q + np.clip(servo.arm.nearest_turn(servo.arm.home, servo.q) - servo.q, -HOMING, HOMING))
        else:
            if servo.force(robot.joints, robot.torques) > robot.config.led_force:
                servo.meet(linear)
            servo.hand(linear, angular)

    def _ready(self, mjcf: str) -> Servo | None:
        robot, config = self._robot, self._robot.config
        if self._servo is None and self._loading is None:
            self._loading = robot.io.submit(ArmModel, mjcf, seconds=LOADING)
        if self._loading is not None and self._loading.poll(robot.now):
            loading, self._loading = self._loading, None
            speed = config.joint_speed * HOMING
            self._servo = Servo(loading.result(), speed, config.joint_acceleration, config.workspace, DT)
        return self._servo


def limited(wish: tuple[float, float, float], most: float) -> Array | None:
    """The velocity (3,), no faster than `most`; None for one that is no number."""
    if not all(isfinite(v) for v in wish):
        return None
    velocity = np.array(wish)
    return velocity * min(1.0, most / max(float(np.linalg.norm(velocity)), 1e-9))
