"""The gripper as its driver knows it: width and speed of the pads, and what a newton at a finger is at the motor."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.robot import SIDES, Hand


def view(array: Any, at: NDArray[np.int64]) -> NDArray[np.float64]:
    """The entries `at` of an array of MjData, which must lie side by side, as a view that stays current."""
    if (np.diff(at) != 1).any():
        raise ValueError("the robot's joints and actuators must come in order in the model, side by side")
    found: NDArray[np.float64] = array[at[0] : at[-1] + 1]
    return found


class Slides:
    """Two fingers that slide together, the left one driven. `force` is the most that one presses [N]."""

    def __init__(self, model: Any, data: Any, hand: Hand) -> None:
        joints = [model.joint(f"{side}_finger") for side in SIDES]
        self._at = view(data.qpos, np.array([j.qposadr[0] for j in joints]))
        self._rates = view(data.qvel, np.array([j.dofadr[0] for j in joints]))
        self._open = hand.open
        self.per_newton = 2.0
        self.force = float(model.actuator("gripper").forcerange[1]) / self.per_newton

    def width(self) -> float:
        left, right = self._at.tolist()
        return float(self._open - left - right)

    def rate(self) -> float:
        left, right = self._rates.tolist()
        return float(-left - right)


class Linkage:
    """Fingers that a motor moves through a linkage: the motor's travel says how wide they are."""

    def __init__(self, model: Any, data: Any, table: tuple[NDArray[np.float64], ...]) -> None:
        actuator = model.actuator("gripper").id
        self._length, self._speed = data.actuator_length[actuator:], data.actuator_velocity[actuator:]
        widths, lengths, _ = table
        order = np.argsort(lengths)
        self._lengths, self._widths = lengths[order], widths[order]
        slope = (widths[-1] - widths[0]) / (lengths[-1] - lengths[0])
        self._slope = float(slope)
        # Virtual work: what the motor does along its travel, both fingers do along half the width each.
        self.per_newton = abs(self._slope)
        low, high = model.actuator_forcerange[actuator]
        limited = bool(model.actuator_forcelimited[actuator])
        self.force = float(max(-low, high)) / self.per_newton if limited else 40.0

    def width(self) -> float:
        return float(np.interp(self._length[0], self._lengths, self._widths))

    def rate(self) -> float:
        return float(self._speed[0]) * self._slope


def fingers(model: Any, data: Any) -> Slides | Linkage:
    """The driver that fits the model."""
    hand = Hand(model)
    return Slides(model, data, hand) if hand.table is None else Linkage(model, data, hand.table)
