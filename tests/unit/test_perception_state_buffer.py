"""Where the robot knows its base and arm to be, now and when a picture was taken."""

import math
from typing import Any

import pytest

from common import messages as m
from common import topics
from common.household import load_household
from common.robot.joints import ARM
from services.perception.service import PerceptionService
from services.perception.views.state_buffer import StateBuffer
from services.sim.model import own
from tests.node import Node


class Feeling(PerceptionService):
    """Perception with its eyes shut."""

    def __init__(self, config: None, io: Any) -> None:
        self.state = StateBuffer(io)

    def step(self, now: float) -> None:
        self.felt = self.state.update()


class Robot(Node):
    """What the drivers and navigation say to perception."""

    def __init__(self) -> None:
        super().__init__(Feeling, None, load_household("minimal"))
        self.state: StateBuffer = self.service.state
        self.bus.send(topics.ROBOT_DESCRIPTION, m.RobotDescription(mjcf=own().mjcf))

    def feel(self, x: float, shoulder: float, width: float = 0.0, force: float = 0.0) -> bool:
        """A tenth of a second later the base is at `x`, heading at x rad, and the second joint at `shoulder`."""
        t, angles = self.later(), [0.0, shoulder, *[0.0] * 5]
        joints = m.JointStates(
            t=t, name=[*ARM, "gripper"], position=[*angles, width], velocity=[0.0] * 8, effort=[0.0] * 7 + [force]
        )
        self.bus.send(topics.JOINT_STATES, joints)
        self.bus.send(topics.POSE, m.PoseEstimate(t=t, x=x, y=0.0, theta=x))
        self.run()
        return bool(self.service.felt)

    def hand(self, t: float | None = None) -> tuple[float, float, float]:
        body = self.state.robot(self.now + 1.0, t)
        assert body is not None
        return body.hand((0.0, 0.0, 0.0))


@pytest.fixture
def robot() -> Robot:
    return Robot()


def test_the_arm_is_as_it_was_felt_last_or_when_a_picture_was_taken(robot: Robot) -> None:
    assert robot.state.robot(0.0) is None and robot.state.base is None
    seen = []
    for shoulder in (0.0, 0.5, 1.0):
        assert robot.feel(0.0, shoulder)
        seen.append(robot.hand())
    assert math.dist(seen[0], seen[2]) > 0.2
    assert [robot.hand(t) for t in (0.0, 0.21, 0.3)] == seen


def test_the_base_is_between_the_estimates_around_a_picture(robot: Robot) -> None:
    for x in (0.0, 0.1, 0.2, 0.4):
        robot.feel(x, 0.0)
    assert robot.state.base == (0.4, 0.0, 0.4)
    assert robot.state.base_at(0.35) == pytest.approx((0.3, 0.0, 0.3))
    assert robot.state.base_at(9.0) == (0.4, 0.0, 0.4) and robot.state.base_at(0.0) == (0.0, 0.0, 0.0)
    assert robot.state.turning() == pytest.approx(0.4 / 0.3)


@pytest.mark.parametrize(("width", "force", "holds"), [(0.05, 30.0, True), (0.05, 0.0, False), (0.001, 30.0, False)])
def test_fingers_hold_what_keeps_them_apart(robot: Robot, width: float, force: float, holds: bool) -> None:
    robot.feel(0.0, 0.0, width, force)
    body = robot.state.robot(1.0)
    assert body is not None and robot.state.holds(body) is holds


def test_joints_of_another_robot_are_none(robot: Robot) -> None:
    robot.bus.send(topics.JOINT_STATES, m.JointStates(t=0.0, name=["wheel"], position=[0.0], velocity=[], effort=[]))
    robot.step()
    assert not robot.service.felt and robot.state.robot(1.0) is None


def test_the_base_drives_when_it_moves_over_the_floor_not_when_its_estimate_shivers(robot: Robot) -> None:
    told = []
    for x in (0.0, 0.002, -0.001, 0.001, 0.0, 0.05, 0.10, 0.15, 0.15, 0.15, 0.15):
        robot.feel(x, 0.0)
        told.append(robot.state.driving())
    assert told == [False] * 5 + [True] * 5 + [False]
