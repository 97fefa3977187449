"""The gripper as its driver knows it: width and speed of the pads, and what a newton at a finger is at the motor."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.robot.model import Hand
from common.time.lockstep import DT

SPEED = 0.150
"""How fast the pads come together at most [m/s]: Robotiq 2F-85, closing speed 20 to 150 mm/s."""
COUNTS = 255
"""Steps in which the gripper tells where its motor stands (Robotiq 2F-85, register gPO)."""


def view(array: Any, at: NDArray[np.int64]) -> NDArray[np.float64]:
    """The entries `at` of an array of MjData, which must lie side by side, as a view that stays current."""
    if (np.diff(at) != 1).any():
        raise ValueError("the robot's joints and actuators must come in order in the model, side by side")
    found: NDArray[np.float64] = array[at[0] : at[-1] + 1]
    return found


class Fingers:
    """Fingers that a motor moves through a linkage: the motor's travel says how wide they are.

    `force` is the most that one presses [N], `per_newton` the motor's force at one newton of a finger.
    """

    def __init__(self, model: Any, data: Any) -> None:
        actuator = model.actuator("gripper").id
        self._ctrl = data.ctrl[actuator:]
        self._low, self._high = (float(v) for v in model.actuator_ctrlrange[actuator])
        self._length, self._speed = data.actuator_length[actuator:], data.actuator_velocity[actuator:]
        table = Hand(model).table
        if table is None:
            raise ValueError("the model's gripper was not measured: it has no table of widths")
        widths, lengths, _ = table
        order = np.argsort(lengths)
        self._lengths, self._widths = lengths[order], widths[order]
        self._slope = float((widths[-1] - widths[0]) / (lengths[-1] - lengths[0]))
        # Virtual work: what the motor does along its travel, both fingers do along half the width each.
        self.per_newton = abs(self._slope)
        self.force = float(model.actuator_forcerange[actuator, 1]) / self.per_newton
        self._most = SPEED * DT / (widths[0] - widths[-1]) * (self._high - self._low)
        self.hold()

    def close(self, share: float) -> None:
        """Go to `share` of the way from open (0) to closed (1)."""
        self._goal = self._low + share * (self._high - self._low)

    @property
    def wanted(self) -> float:
        """Where they were told to go: 0 open, 1 closed."""
        return (self._goal - self._low) / (self._high - self._low)

    def hold(self) -> None:
        """Stay where the set-point is."""
        self._goal = float(self._ctrl[0])

    def advance(self) -> None:
        """Move the set-point on by 10 ms, no faster than the pads can."""
        now, low, high = float(self._ctrl[0]), self._lengths[0], self._lengths[-1]
        stands = self._low + (float(self._length[0]) - low) / (high - low) * (self._high - self._low)
        if (now - stands) * (self._goal - stands) < 0:
            now = stands  # what it pressed with leads beyond what keeps the pads apart
        self._ctrl[0] = now + max(-self._most, min(self._most, self._goal - now))

    def width(self) -> float:
        """Distance between the pads [m], as fine as the gripper tells where its motor stands."""
        low, high = self._lengths[0], self._lengths[-1]
        count = round((self._length[0] - low) / (high - low) * COUNTS)
        return float(np.interp(low + count / COUNTS * (high - low), self._lengths, self._widths))

    def rate(self) -> float:
        """How fast the pads move apart [m/s]."""
        return float(self._speed[0]) * self._slope
