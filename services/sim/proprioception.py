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


class Proprioception:
    """The errors of one robot, drawn from `seed`; `efforts` (n,) is the largest effort of each joint."""

    def __init__(self, seed: int, efforts: Array) -> None:
        rng = self._rng = np.random.default_rng([seed, 13])
        self._zero: Array = rng.uniform(-ENCODER_ZERO, ENCODER_ZERO, len(efforts))
        self._torque: Array = TORQUE_NOISE * efforts
        self._play, self._width = float(rng.normal(0.0, PLAY)), 0.0

    def angles(self, true: Array) -> Array:
        """What the encoders say of joint angles (n,) [rad]."""
        return np.asarray(true + self._zero + self._rng.normal(0.0, ENCODER_NOISE, len(true)))

    def rates(self, true: Array) -> Array:
        """Joint speeds (n,) [rad/s] as the driver works them out."""
        return np.asarray(true + self._rng.normal(0.0, RATE_NOISE, len(true)))

    def efforts(self, true: Array) -> Array:
        """Joint torques (n,) [N m] as the motors' currents tell them."""
        return np.asarray(true + self._rng.normal(0.0, 1.0, len(true)) * self._torque)

    def finger(self, force: float) -> float:
        """Force of a finger [N] as its motor's current tells it; never less than none."""
        return force + float(self._rng.normal(0.0, FINGER_NOISE))

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
