"""The hand lets go of what stands, and leaves it standing there."""

from collections.abc import Sequence

import numpy as np

from common.geometry import Array
from services.manipulation.arm.touch import Reaction
from services.manipulation.arm.trajectory import back_along, parallel
from services.manipulation.execution.robot import Failure, Robot, Steps, planner_of
from services.manipulation.grasps.grasped_object import PLAY, GraspedObject

STUCK = "STUCK"
"""Code: what is held did not come off the fingers; it is held still."""
FIRST = 0.008
"""Way [m] off what was let go after which it is weighed. Chosen: less than the centimetre of fall that counts as
dropped."""
GENTLY = 0.1
"""Share of the joint speed on that way: what hangs on a finger shall not swing off it."""
HANGS = 2.0
"""Force [N] by which the hand has become heavier on it when something hangs on it: four times the noise of the torques
over the readings of a rest, the weight of a small toy."""


def let_go(robot: Robot, retreat: Sequence[Array], held: GraspedObject) -> Steps[None]:
    """Open the fingers and leave by a path (7,) of the joints; what comes along is put back, and left with the fingers
    opened less, which may have spread something from within.

    Raises:
        Failure: STUCK, the fingers do not open, or it hangs on the hand; as `Robot.follow`.
    """
    hand = planner_of(robot).arm.hand
    narrow = hand.share(held.width + PLAY)
    openings = (narrow, 0.0) if held.opening is not None else (0.0, narrow)
    robot.phase = "release"
    for opening in openings:
        yield from robot.move_gripper(opening)
        if robot.grip.width < min(planner_of(robot).arm.widest, held.width) + 0.004:
            # GraspedObject as before, for whoever tries again.
            raise Failure(STUCK, f"the gripper opened to {robot.grip.width * 1000:.0f} mm only")
        stands = yield from robot.lifted()
        way = parallel(retreat, robot.joints)
        first = _first(planner_of(robot).reaction, way)
        yield from robot.follow(first, robot.config.joint_speed * GENTLY)
        more = (yield from robot.lifted()) - stands
        if more <= HANGS:
            robot.phase = "retract"
            yield from robot.follow([first[-1], *way[1:]], robot.config.joint_speed * 0.5)
            return
        robot.io.log.warning("taken along", object=held.label, newton=round(more, 1))
        yield from robot.follow(back_along(first, robot.joints), robot.config.joint_speed * GENTLY)
    raise Failure(STUCK, f"the {held.label} hangs on the open hand with {more:.0f} N")


def _first(reaction: Reaction, way: Sequence[Array]) -> list[Array]:
    """The first bit of a way off."""
    length = float(np.linalg.norm(reaction.position(way[1]) - reaction.position(way[0])))
    return [way[0], way[0] + (way[1] - way[0]) * min(1.0, FIRST / max(length, FIRST))]
