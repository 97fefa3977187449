"""What the arm and the hand feel of themselves: encoders, motor currents and the gripper's width, with their errors."""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ENCODER_NOISE, ENCODER_ZERO = 2e-4, 5e-4
"""Standard deviation of an angle and most that a joint's zero is off [rad]; chosen: .01 and .03 degrees, a few tenths
of a millimetre at the hand."""
RATE_NOISE = 2e-3
"""Standard deviation of a joint's speed [rad/s]; chosen: the difference of two angles over a filter of .15 s."""
TORQUE_NOISE = 0.005
"""Standard deviation of an effort, as a share of its largest; chosen: .5 and .26 N m of the arm's joints."""
FINGER_NOISE = 0.4
"""Standard deviation of a finger's force [N], from the current of its motor, which the 2F-85 tells in steps of 10 mA
(instruction manual, register gCU); chosen: a step and a half."""
PLAY, PLAY_LIMIT = 0.0002, 0.00035
"""Standard deviation and most of what the linkage's play does to the width [m]: with the steps in which the motor's
travel is told, .5 mm in all."""
PLAY_TRAVEL = 0.002
"""Travel of the pads after which they lie in their play as if never seen before [m]; chosen."""
BLOCK = 500
"""Readings whose errors are drawn at once [count]: one by one they would cost more than the reading."""


class Proprioception:
    """The errors of one robot, drawn from `seed`; `efforts` (n,) is the largest effort of each joint."""

    def __init__(self, seed: int, efforts: Array) -> None:
        rng = self._rng = np.random.default_rng([seed, 13])
        count = len(efforts)
        zero: Array = rng.uniform(-ENCODER_ZERO, ENCODER_ZERO, count)
        self._mean = np.concatenate((zero, np.zeros(2 * count + 1)))
        alike = np.full(count, ENCODER_NOISE), np.full(count, RATE_NOISE)
        self._deviation = np.concatenate((*alike, TORQUE_NOISE * efforts, [FINGER_NOISE]))
        self._play, self._width = float(rng.normal(0.0, PLAY)), 0.0
        self._errors, self._at = np.empty((0, len(self._mean))), 0

    def read(self, true: Array) -> Array:
        """What is measured (3 n + 1,) of angles [rad], speeds [rad/s], torques [N m] and a finger's force [N]."""
        if self._at == len(self._errors):
            drawn = self._rng.standard_normal((BLOCK, len(self._mean)))
            self._errors, self._at = self._mean + self._deviation * drawn, 0
        self._at += 1
        return np.asarray(true + self._errors[self._at - 1])

    def width(self, told: float) -> float:
        """The width [m] that the gripper tells, from the one that its motor's travel stands for.

        The play of the linkage changes only while the pads move, so a thing that is held keeps its width.
        """
        travel, self._width = abs(told - self._width), told
        if travel:
            keeps = math.exp(-travel / PLAY_TRAVEL)
            fresh = float(self._rng.normal(0.0, PLAY))
            self._play = keeps * self._play + math.sqrt(1.0 - keeps * keeps) * fresh
        return max(0.0, told + max(-PLAY_LIMIT, min(PLAY_LIMIT, self._play)))
