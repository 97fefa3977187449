"""An arm whose process died with the hand full: the next one lifts and folds it in before it says `done`."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import cast

import msgspec
import numpy as np
import pytest

from common import messages as m
from common import topics
from common.robot.grip import Grip
from services.manipulation.execution import recovery
from services.manipulation.execution.recovery import at_carry
from services.manipulation.execution.robot import Failure, Steps
from services.manipulation.execution.robot import Robot as ExecutingRobot
from services.sim.physics import NOSLIP
from tests.mission import Robot
from tests.unit.test_manipulation_service import wait

ITEM = "red mug"


def phase(robot: Robot) -> str:
    return msgspec.json.decode(robot.bus.last[topics.MANIPULATION_STATUS.key], type=m.ManipulationStatus).phase


def with_item_in_hand() -> Robot:
    robot = Robot("minimal", seed=4, settings=("camera.sensors=ideal",))
    robot.advance(0.5)
    robot.bus.put(topics.NAVIGATION_GOAL, f'{{"goal": "find {ITEM}", "id": "t.1"}}'.encode())
    wait(robot, topics.NAVIGATION_STATUS, "t.1", 30.0)
    robot.bus.put(topics.MANIPULATION_GOAL, b'{"goal": "grab", "id": "t.2"}')
    assert wait(robot, topics.MANIPULATION_STATUS, "t.2", 40.0)["status"] == "done"
    return robot


@pytest.mark.timeout(300)
@pytest.mark.slow
@pytest.mark.parametrize(("killed_in", "into"), [("grasp", 0.9), ("retract", 0.6)])
def test_a_full_hand_is_folded_in(killed_in: str, into: float) -> None:
    robot = Robot("minimal", seed=4)
    robot.advance(0.5)
    robot.bus.put(topics.NAVIGATION_GOAL, f'{{"goal": "find {ITEM}", "id": "t.1"}}'.encode())
    wait(robot, topics.NAVIGATION_STATUS, "t.1", 30.0)
    robot.bus.put(topics.MANIPULATION_GOAL, b'{"goal": "grab", "id": "t.2", "attempt": 1}')
    end = robot.now + 40.0
    while phase(robot) != killed_in:
        assert robot.now < end, phase(robot)
        robot.tick()
    robot.advance(into)
    robot.kill("manipulation")
    robot.advance(1.0)
    robot.start("manipulation")
    robot.advance(0.2)
    robot.bus.put(topics.MANIPULATION_GOAL, b'{"goal": "grab", "id": "t.2", "attempt": 2}')
    grabbed = wait(robot, topics.MANIPULATION_STATUS, "t.2", 40.0)
    assert grabbed["status"] == "done" and "already holding" in grabbed["detail"], grabbed
    assert robot.truth()["holding"] == ITEM
    arm = robot.members["manipulation"][0]._robot
    assert at_carry(arm.planner, arm.joints)
    robot.close()


@pytest.mark.parametrize(
    ("width", "force", "code", "back"),
    [(0.0, 0.0, "SLIPPED", ["empty"]), (0.066, 25.0, "BLOCKED", []), (0.0, 0.0, "STUCK", [])],
)
def test_an_arm_whose_placing_failed_is_taken_back_first(
    width: float, force: float, code: str, back: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    went: list[str] = []

    def way(name: str) -> Callable[..., Steps[None]]:
        def steps(*_: object) -> Steps[None]:
            yield
            went.append(name)

        return steps

    def placing() -> Steps[str]:
        yield
        raise Failure(code, "")

    monkeypatch.setattr(recovery, "retract_empty", way("empty"))
    with pytest.raises(Failure) as failed:
        list(recovery.brought_back(cast(ExecutingRobot, SimpleNamespace(grip=Grip(width, force))), placing()))
    assert (failed.value.code, went) == (code, back)


@pytest.mark.timeout(300)
@pytest.mark.slow
def test_what_is_lost_over_its_place_leaves_no_arm_held_out() -> None:
    robot = with_item_in_hand()
    arm = robot.members["manipulation"][0]._robot
    robot.bus.put(topics.MANIPULATION_GOAL, b'{"goal": "release", "id": "t.3"}')
    end = robot.now + 20.0
    while at_carry(arm.planner, arm.joints):
        assert robot.now < end
        robot.tick()
    robot.sim.physics.data.joint(ITEM.replace(" ", "_")).qpos[:3] = 3.0, 3.0, 0.1
    lost = wait(robot, topics.MANIPULATION_STATUS, "t.3", 40.0)
    assert (lost["status"], lost["code"]) == ("failed", "SLIPPED"), lost
    assert at_carry(arm.planner, arm.joints)
    robot.close()


@pytest.mark.timeout(300)
@pytest.mark.slow
def test_what_is_held_does_not_creep_out_of_the_hand() -> None:
    robot = with_item_in_hand()
    robot.advance(2.0)
    physics = robot.sim.physics
    held = physics.data.xpos[physics.bodies[ITEM]]
    before = held.copy()
    robot.advance(30.0)
    assert np.abs(held - before).max() < 0.0005
    assert physics.model.opt.noslip_iterations == NOSLIP
    robot.close()
