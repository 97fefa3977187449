"""Something in the hand goes down to its surface: slowly where it may meet it."""

from collections.abc import Sequence

from services.manipulation.arm.arm_model import Array
from services.manipulation.arm.touch import TOUCHED, Guard
from services.manipulation.execution.robot import Failure, Robot, Steps, planner_of

SLOWLY = 0.055
"""Height [m] above the end of the way down from which it goes slowly: what is held may hang so much lower. Chosen: an
apple that had slid in the hand met the tray 49 mm early, with 82 N."""
SETTING_DOWN = 0.12
"""Speed of that, in joint speeds: some 6 cm/s of the hand. At 0.4 a bottle of 0.4 kg met the tray with 100 N."""

PROBING = 0.06
"""Speed of the way on down where nothing was felt, in joint speeds: some 3 cm/s of the hand."""
STANDING = 10.0
"""Force [N] on the hand, downwards, from which what it holds stands when it goes so slowly: its own inertia shows as at
most 4 N then, and the surface bears three times as much."""


def set_down(robot: Robot, path: Sequence[Array], guard: Guard | None, share: float) -> Steps[None]:
    """Follow a joint path downwards, with `share` of the joint speed above where it goes slowly.

    Raises:
        Failure: as `Robot.follow`.
    """
    speed, reaction = robot.config.joint_speed, planner_of(robot).reaction
    heights = [float(reaction.position(q)[2]) for q in path]
    near = next(n for n, height in enumerate(heights) if height <= heights[-1] + SLOWLY)
    if near:
        yield from robot.follow(path[: near + 1], speed * share, guard)
    yield from robot.follow(path[near:], speed * SETTING_DOWN, guard)


def probe(robot: Robot, path: Sequence[Array], rest: Array) -> Steps[bool]:
    """Follow a joint path downwards until what is held is felt to stand, and tell whether it was.

    `rest`: torques (7,) [Nm] of the arm with it in the air.

    Raises:
        Failure: as `Robot.follow`, but for TOUCHED.
    """
    if not path:
        return False
    try:
        yield from robot.follow(path, robot.config.joint_speed * PROBING, robot.guard(rest, STANDING, "down"))
    except Failure as failure:
        if failure.code != TOUCHED:
            raise
        return True
    return False
