"""The fingers close: in steps of their force, the hand giving way to what they press on."""

import numpy as np

from common.geometry import Array
from services.manipulation.arm.touch import BLOCKED, Guard
from services.manipulation.execution.robot import DT, Failure, Robot, Steps

EFFORTS = (8.0, 14.0)
"""Forces [N] with which the fingers come, and press, before they grip: slow enough that they do not knock (in
simulation 0.16 m/s each, three times what they do with the whole grip force), and in steps in which it is felt that
they press something down: on a slope of 60 degrees the whole of it at once comes to 86 N."""
STANDS = 4.0
"""Force [N] on the hand to which it does not give way. Chosen: the noise of the torques, and what slides a light
thing."""
GIVING, FASTEST = 0.001, 0.01
"""Speed [m/s] with which the hand gives way for a newton more, and at the most. Chosen: an arm bent by 3 mm under
20 N has given way in a third of a second."""
FARTHEST = 0.008
"""How far [m] the hand gives way. Chosen: the error of a sighting; more would leave the place of the grasp."""
SMOOTHING = 0.3
"""Share of a force that counts at once. Chosen: three steps, in which the noise of the torques averages."""


class Yielding:
    """Set-points (7,) of a hand that gives way to forces on it, near `at` (7,) [rad]; `guard`: what it feels with."""

    def __init__(self, guard: Guard, at: Array) -> None:
        self.at = at
        self._guard, self._moved, self._force = guard, np.zeros(3), np.zeros(3)

    def step(self, joints: Array, torques: Array) -> Array:
        """The next set-point, `DT` later."""
        felt = self._guard.reaction.force(joints, torques - self._guard.rest)
        self._force = self._force + SMOOTHING * (felt - self._force)
        pressed = float(np.linalg.norm(self._force))
        if pressed > STANDS:
            speed = min(GIVING * (pressed - STANDS), FASTEST)
            way = -self._force / pressed * speed * DT
            if float(np.linalg.norm(self._moved + way)) <= FARTHEST:
                self._moved = self._moved + way
                self.at = self.at + self._guard.reaction.moved(joints, way)
        return self.at


def close(robot: Robot, at: Array, guard: Guard | None) -> Steps[Array]:
    """Close on something that stands; returns the set-point (7,) at which the hand, that was at `at` (7,), holds it.

    A finger that comes first, or one that closes on a slope, would push the thing over or down: the hand follows the
    force instead, until both press alike.

    Raises:
        Failure: BLOCKED, it is pressed down with more than its surface should bear.
    """
    yielding = Yielding(guard, at) if guard is not None else None
    try:
        for effort in (*EFFORTS, 0.0):
            yield from robot.move_gripper(1.0, effort, guard, yielding)
    except Failure as failure:
        raise Failure(BLOCKED, f"the fingers press it down: {failure.detail}") from None
    return yielding.at if yielding is not None else at
