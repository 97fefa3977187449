"""Something in the hand goes down to its surface: slowly, since it may meet it anywhere."""

from collections.abc import Sequence

from common.geometry import Array
from services.manipulation.arm.touch import Guard
from services.manipulation.execution.robot import Robot, Steps

SETTING_DOWN = 0.12
"""Speed of the whole way down, in joint speeds: some 6 cm/s of the hand, 1.3 s for the 8 cm of a placement. Chosen: at
0.4 a bottle of 0.4 kg met the tray with 100 N, and what is held may hang lower by more than can be told: an apple met
it 49 mm early, a whisk and a tray that had swung farther than 55."""

PROBING = 0.06
"""Speed of the way on down where nothing was felt, in joint speeds: some 3 cm/s of the hand."""
STANDING = 10.0
"""Force [N] on the hand, downwards, from which what it holds stands when it goes so slowly: its own inertia shows as at
most 4 N then, and the surface bears three times as much."""

PRESSING, PRESSED = 0.03, 25.0
"""Speed of a way on down against what is met, in joint speeds: some 1.5 cm/s of the hand, 3 N more in each 20 ms; force
[N] on the hand at which it ends. Chosen: with 5 cm from the pads to where it is met, the most that turns in them."""


def set_down(robot: Robot, path: Sequence[Array], guard: Guard | None) -> Steps[None]:
    """Follow a joint path downwards.

    Raises:
        Failure: as `Robot.follow`.
    """
    yield from robot.follow(path, robot.config.joint_speed * SETTING_DOWN, guard)


def press_down(robot: Robot, path: Sequence[Array], rest: Array) -> Steps[None]:
    """Follow a joint path downwards with something that touches its surface already; `rest`: as in `probe`.

    Raises:
        Failure: as `Robot.follow`.
    """
    yield from robot.follow(path, robot.config.joint_speed * PRESSING, robot.guard(rest, PRESSED, "down"))


def probe(robot: Robot, path: Sequence[Array], rest: Array) -> Steps[None]:
    """Follow a joint path downwards until what is held is felt to stand.

    `rest`: torques (7,) [Nm] of the arm with it in the air.

    Raises:
        Failure: as `Robot.follow`; TOUCHED where it stands.
    """
    if path:
        yield from robot.follow(path, robot.config.joint_speed * PROBING, robot.guard(rest, STANDING, "down"))
