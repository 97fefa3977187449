"""What the gripper's width and force mean: empty, pressing or holding. One rule for all services."""

from typing import NamedTuple

from common.messages import JointStates
from common.robot.joints import GRIPPER

OPENING = 0.085
"""Width between the open pads [m]: the stroke of the Robotiq 2F-85 (data sheet)."""
EMPTY_WIDTH = 0.002
"""Width [m] up to which nothing is between closed fingers: less than a plate's wall leaves; the play is 0.3 mm."""
OPEN_PLAY = 0.005
"""How much narrower than open [m] fingers must stand to be kept apart by something: twice what open ones give way."""
HOLDING_FORCE = 3.0
"""Force of a finger [N] from which it presses on something: free fingers show less than 2 while they move."""


class Grip(NamedTuple):
    """`width` between the pads [m] and `force` with which a finger closes [N]."""

    width: float
    force: float

    @property
    def empty(self) -> bool:
        """True when the hand has closed on nothing."""
        return self.width <= EMPTY_WIDTH

    @property
    def pressing(self) -> bool:
        """True when the fingers press on something, or on each other."""
        return self.force > HOLDING_FORCE

    def holds(self, opening: float = OPENING) -> bool:
        """True when something keeps the fingers apart that close; `opening` [m] is the width of the open hand."""
        return EMPTY_WIDTH < self.width < opening - OPEN_PLAY and self.pressing


def grip_of(joints: JointStates | None) -> Grip | None:
    """The grip by joint states; None when they report no gripper."""
    if joints is None or GRIPPER not in joints.name:
        return None
    index = joints.name.index(GRIPPER)
    if index >= len(joints.position):
        return None
    return Grip(joints.position[index], abs(joints.effort[index]) if index < len(joints.effort) else 0.0)
