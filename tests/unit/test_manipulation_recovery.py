"""An arm whose process died with the hand full: the next one lifts and folds it in before it says `done`."""

import msgspec
import pytest

from common import messages as m
from common import topics
from services.manipulation.execution.recovery import at_carry
from tests.mission import Robot
from tests.unit.test_manipulation_service import wait

ITEM = "red mug"


def phase(robot: Robot) -> str:
    return msgspec.json.decode(robot.bus.last[topics.MANIPULATION_STATUS.key], type=m.ManipulationStatus).phase


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
