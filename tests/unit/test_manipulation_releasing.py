"""The hand opens and leaves: what comes along is felt, put back, and left otherwise or not at all."""

import numpy as np
import pytest

from common import topics
from common.robot.grip import Grip
from services.manipulation.execution.releasing import FIRST, HANGS, STUCK, let_go
from services.manipulation.execution.robot import Failure
from services.manipulation.grasps.grasped_object import PLAY, GraspedObject
from tests.unit.test_manipulation_touch import reaching

HELD, OFF = 0.02, 0.004
"""Width [m] of what is held; height [m] of the hand at which what hangs on it is off its surface."""


@pytest.mark.parametrize("part", [False, True])
@pytest.mark.parametrize(("hooked", "code"), [("never", ""), ("wide", ""), ("narrow", ""), ("always", STUCK)])
def test_what_hangs_on_a_finger_is_put_back_before_it_can_fall(part: bool, hooked: str, code: str) -> None:
    """`hooked`: with which openings of the fingers it comes along; `part`: a part of it was held."""
    node, robot, planner, above, top = reaching()
    up = planner.straight(top, above, above.moved(np.array([0.0, 0.0, 0.1])))
    assert up is not None
    held = GraspedObject("lantern", "", above.rotation, np.zeros(3), (0.1, 0.1, 0.2), HELD, 0.0, part=part)
    robot.joints, robot.grasped, ended, highest = top, held, "", 0.0
    try:
        for _ in let_go(robot, [top, *up], held):
            arm, fingers = node.sent(topics.ARM_COMMAND), node.sent(topics.GRIPPER_COMMAND)
            robot.joints = np.array(arm[-1].position) if arm else top
            hand = planner.arm.hand
            wide = fingers[-1].position < hand.share(HELD + 2 * PLAY)
            robot.grip = Grip(hand.open if wide else HELD + PLAY, 0.0)
            height = float(planner.reaction.position(robot.joints)[2] - above.position[2])
            hangs = height > OFF and hooked in ("always", "wide" if wide else "narrow")
            highest = max(highest, height) if hangs else highest
            robot.torques = planner.reaction.torques(robot.joints, np.array([0.0, 0.0, 2 * HANGS * hangs]))
    except Failure as failure:
        ended = failure.code
    assert ended == code
    assert highest < FIRST + 0.002, "it falls less than a centimetre"
    left = float(planner.reaction.position(robot.joints)[2] - above.position[2])
    assert left > 0.09 if not code else left < OFF
    first = node.sent(topics.GRIPPER_COMMAND)[0].position
    assert (first > 0.0) == part, "a finger that is within it does not spread it"
