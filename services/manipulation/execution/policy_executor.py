"""Plays a policy inside manipulation's limits; what it has grabbed is carried and claimed as anything else."""

from collections.abc import Callable
from typing import Any

import numpy as np

from common import messages as m
from common import topics
from common.demonstration import PictureTurns
from common.geometry import Array
from services.manipulation.arm.arm_model import ArmModel
from services.manipulation.arm.servo import Servo
from services.manipulation.arm.touch import TOUCHED
from services.manipulation.execution.policy import (
    MAX_AGE,
    Observation,
    Policy,
    PolicyError,
    act,
    guarded,
    observation,
    picture_of,
    state_of,
)  # fmt: skip
from services.manipulation.execution.recovery import retract_grasped
from services.manipulation.execution.robot import DT, GRIPPER_TICKS, Failure, Robot, Steps
from services.manipulation.execution.sighting import sighted
from services.manipulation.planning.planning_scene import obstacles, target_of

POLICY_ERROR, POLICY_LATE, NO_PICTURE = "POLICY_ERROR", "POLICY_LATE", "NO_PICTURE"
PICTURES = 3.0
"""How long the first pictures are waited for [s]; chosen: ten of the camera's periods on a busy machine."""
RENEW = 1.0
"""Time after which a picture that has not come is asked for again [s]; chosen."""
BLOCKED = 1.0
"""How long a policy may want what it must not [s]; chosen: time to correct itself."""
SETTLE = 0.3
"""How long the fingers are waited for when it is done [s]; chosen."""


class Eyes:
    """The pictures of a policy: asked for one at a time, so that the robot's own requests are served in between."""

    def __init__(self, robot: Robot) -> None:
        self._robot, self._cameras = robot, robot.config.policy_cameras
        self._turns = PictureTurns(self._cameras, RENEW)
        self.pictures: dict[str, Any] = {}
        self._seen: dict[str, float] = {}

    def open(self, wanted: bool = True) -> None:
        """Have pictures delivered, or no longer."""
        for name in self._cameras:
            self._robot.io.demand(topics.PICTURES[name], wanted)

    def step(self) -> None:
        """Take what has come and ask for the next one."""
        robot = self._robot
        for name in self._cameras:
            for message in robot.io.take_all(topics.PICTURES[name]):
                if (picture := picture_of(message)) is not None:
                    self.pictures[name], self._seen[name] = picture, message.t
                self._turns.came(message)
        if (request := self._turns.request(robot.now, lambda: robot.io.new_id("policy"))) is not None:
            robot.io.publish(topics.CAMERA_REQUEST, request)

    @property
    def missing(self) -> list[str]:
        """Cameras without a fresh picture."""
        now = self._robot.now
        return sorted(n for n in self._cameras if now - self._seen.get(n, float("-inf")) > MAX_AGE)


def grab_by_policy(
    robot: Robot, make: Callable[[], Policy], goal: m.ManipulationGoal, wanted: str, described: Callable[[], str]
) -> Steps[str]:
    """Have the policy grab what the goal is about, then lift and carry it as after any grasp; the evidence."""
    found = yield from sighted(robot, goal, wanted, robot.now - robot.config.fresh)
    robot.phase, mjcf = "reach", described()
    if robot.servo is None:
        arm = yield from robot.work(ArmModel, mjcf)
        config = robot.config
        robot.servo = Servo(arm, config.joint_speed, config.joint_acceleration, config.workspace, DT)
    around = obstacles(robot.io.household, robot.base, robot.source.objects(), without=found.label)
    robot.servo.begin(robot.joints, robot.torques, around)
    target = target_of(found, robot.base, robot.io.household)
    more = {
        "object": found.label, "object.position": target.position, "object.yaw": target.yaw,
        "object.size": target.size, "robot.mjcf": mjcf,
    }  # fmt: skip
    state = robot.io.latest(topics.BRAIN_STATE)
    task = state.command if state is not None and state.command else f"grab the {found.label}"
    eyes = Eyes(robot)
    eyes.open()
    try:
        yield from _first_pictures(robot, eyes)
        policy = yield from _made(robot, make)
        yield from _play(robot, policy, eyes, task, more)
    finally:
        eyes.open(False)
        robot.forget_command()
    if not robot.grip.holds():
        raise Failure("EMPTY_GRASP", f"the policy is done, width {robot.grip.width * 1000:.1f} mm: nothing is held")
    yield from retract_grasped(robot, m.ObjectRef(found.label, found.position, size=found.size, kind=found.kind))
    return f"{found.label} held: width {robot.grip.width * 1000:.1f} mm, force {robot.grip.force:.0f} N"


def _first_pictures(robot: Robot, eyes: Eyes) -> Steps[None]:
    begun = robot.now
    eyes.step()
    while eyes.missing:
        if robot.now - begun > PICTURES:
            raise Failure(NO_PICTURE, f"no picture of {' and '.join(eyes.missing)} for {PICTURES:.0f} s")
        yield
        eyes.step()


def _made(robot: Robot, make: Callable[[], Policy]) -> Steps[Policy]:
    """An episode's policy: one that loads weights may take its time."""
    job = robot.io.submit(guarded, make, seconds=robot.config.planning_seconds)
    while not job.poll(robot.now):
        yield
    try:
        policy: Policy = job.result()
    except PolicyError as error:
        raise Failure(POLICY_ERROR, str(error)) from None
    return policy


def _play(robot: Robot, policy: Policy, eyes: Eyes, task: str, more: dict[str, Any]) -> Steps[None]:
    """Until the policy is done; one call at a time, at `policy_rate` at most.

    Raises:
        Failure: what it wants is no action, too late, not allowed, or meets something.
    """
    config, servo, begun = robot.config, _servo(robot), robot.now
    period = 1.0 / config.policy_rate
    target: Array = servo.q
    closed, blocked, ticks = 0.0, 0.0, 0
    while True:
        job = robot.io.submit(act, policy, _seen(robot, eyes, task, more), seconds=period)
        asked = robot.now
        while not job.poll(robot.now) or robot.now - asked < period - DT / 2:
            late = robot.now - asked - period
            if late > config.policy_late:
                raise Failure(POLICY_LATE, f"no action for {late + period:.1f} s")
            if late > config.policy_patience:
                target = servo.q
            why = servo.rest() if late > config.policy_patience else servo.towards(target)
            blocked = blocked + DT if why else 0.0
            robot.stream(servo.q)
            if ticks % GRIPPER_TICKS == 0:
                command = m.GripperCommand(position=closed, max_effort=config.grip_effort)
                robot.io.publish(topics.GRIPPER_COMMAND, command)
            ticks += 1
            yield
            eyes.step()
            _check(robot, servo, blocked, why, begun)
        try:
            action = job.result()
        except PolicyError as error:
            raise Failure(POLICY_ERROR, str(error)) from None
        if action is None:
            break
        target, closed = action
    while not servo.still:
        servo.rest()
        robot.stream(servo.q)
        yield
    yield from robot.wait(SETTLE)


def _servo(robot: Robot) -> Servo:
    assert robot.servo is not None
    return robot.servo


def _seen(robot: Robot, eyes: Eyes, task: str, more: dict[str, Any]) -> Observation:
    joints = robot.io.latest(topics.JOINT_STATES)
    state = state_of(joints) if joints is not None else None
    if state is None:
        raise Failure(POLICY_ERROR, "joint_states lack a joint that demonstrations have")
    if eyes.missing:
        raise Failure(NO_PICTURE, f"no picture of {' and '.join(eyes.missing)} for {MAX_AGE:.0f} s")
    return observation(state, dict(eyes.pictures), task, more)


def _check(robot: Robot, servo: Servo, blocked: float, why: str, begun: float) -> None:
    """Raises `Failure` where the motion has to end: the arm then holds where it is."""
    force = servo.force(robot.joints, robot.torques)
    if force > robot.config.led_force:
        raise Failure(TOUCHED, f"{force:.0f} N on the hand")
    if np.abs(robot.joints - servo.q).max() > robot.config.blocked_error * 2:
        raise Failure("BLOCKED", "the joints do not follow")
    if blocked > BLOCKED:
        raise Failure(why, f"the policy wants where it must not go for {blocked:.1f} s")
    if robot.now - begun > robot.config.policy_seconds:
        raise Failure("TIMEOUT", f"the policy was not done after {robot.config.policy_seconds:.0f} s")
