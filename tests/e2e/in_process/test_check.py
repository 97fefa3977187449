"""The robot checks its own work, judged by physics: things that lie on the tray before it."""

import math

import mujoco
import numpy as np
import pytest

from common import messages as m
from common import topics
from evaluation.stack import Stack

PATIENCE = 300.0
"""Robot seconds: three rounds of grasping, bringing and looking take about 130."""
UPRIGHT = 0.35
"""Tilt [rad] up to which a thing stands."""


def knocked_over(name: str, yaw: float) -> Stack:
    """A robot at home with the thing on its side on the tray, its upper end towards `yaw`."""
    robot = Stack("apartment", seed=3)
    robot.advance(2.0)
    physics, tray = robot.sim.physics, robot.scene.receptacle(robot.scene.delivery)
    spec = robot.scene.object(name)
    assert spec is not None and tray is not None
    joint = physics.model.joint(name.replace(" ", "_"))
    turn, lie, whole = np.zeros(4), np.zeros(4), np.zeros(4)
    mujoco.mju_axisAngle2Quat(turn, [0.0, 0.0, 1.0], yaw)
    mujoco.mju_axisAngle2Quat(lie, [0.0, 1.0, 0.0], math.pi / 2)
    mujoco.mju_mulQuat(whole, turn, lie)
    place = tray.center[0] - 0.02, 0.05, tray.center[2] + spec.size[0] / 2 + 0.001
    physics.data.qpos[joint.qposadr[0] : joint.qposadr[0] + 7] = (*place, *whole)
    physics.data.qvel[joint.dofadr[0] : joint.dofadr[0] + 6] = 0.0
    mujoco.mj_forward(physics.model, physics.data)
    robot.advance(2.0)
    assert tilt(robot, name) > 1.2, "it lies"
    return robot


def tilt(robot: Stack, name: str) -> float:
    _, x, y, _ = robot.truth()["objects"][name]["quaternion"]
    return math.acos(max(-1.0, min(1.0, 1 - 2 * (x * x + y * y))))


def bring(robot: Stack, name: str) -> m.MissionOutcome:
    robot.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text=f"bring me the {name}", confirmed=True))
    end = robot.now + PATIENCE
    while robot.now < end:
        robot.advance(0.5)
        last = robot.state().last
        if last is not None:
            return last
    raise AssertionError(f"no outcome after {PATIENCE} s: {robot.state()}")


@pytest.mark.slow
def test_a_can_that_lies_before_the_robot_is_found_and_set_upright() -> None:
    robot = knocked_over("green can", 2.2)
    last = bring(robot, "green can")
    assert last.outcome == "delivered", last.reason
    assert robot.truth()["objects"]["green can"]["on"] == robot.scene.delivery
    assert min(tilt(robot, "green can"), math.pi - tilt(robot, "green can")) < UPRIGHT, "either end may be up"
    robot.close()


@pytest.mark.slow
def test_a_mug_that_lies_before_the_robot_is_found_and_never_claimed_unless_it_stands() -> None:
    robot = knocked_over("red mug", 0.9)
    last = bring(robot, "red mug")
    assert "NOT_FOUND" not in last.reason
    stands = tilt(robot, "red mug") < UPRIGHT and robot.truth()["objects"]["red mug"]["on"] == robot.scene.delivery
    assert last.outcome != "delivered" or stands, last.reason
    robot.close()
