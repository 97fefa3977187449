"""What the arm feels while the base drives: held out or with something long in the hand it may meet what no sensor sees
in the way of the base."""

import numpy as np

from common.geometry import Array
from common.messages import JointStates
from common.robot.joints import ARM

PRESSING = 8.0
"""Torque [Nm] of a joint beyond its usual one from which the arm presses on something: three times what setting out
and braking put on it with a mug in the hand."""
FORGETTING = 0.005
"""Share of the usual torque that is new in a step. Chosen: ten seconds, several times what it takes to back off."""
MOVED = 0.1
"""Angle [rad] from which on a joint was moved by its motor: 12 Nm bend it by less."""


class ArmLoad:
    """The usual torques (7,) [Nm] of an arm that is carried along, and whether it now presses on something."""

    def __init__(self) -> None:
        self._joints: Array | None = None
        self._usual: Array = np.zeros(len(ARM))

    def presses(self, states: JointStates | None) -> bool:
        """True while it does; call in each step, also while the base stands."""
        at = {name: n for n, name in enumerate(states.name)} if states is not None else {}
        if states is None or not at.keys() >= set(ARM) or len(states.effort) != len(states.name):
            return False
        joints, torques = (np.array([of[at[name]] for name in ARM]) for of in (states.position, states.effort))
        if self._joints is None or np.abs(joints - self._joints).max() > MOVED:
            self._joints, self._usual = joints, torques
        more = torques - self._usual
        self._usual = self._usual + FORGETTING * more
        return bool(np.abs(more).max() > PRESSING)
