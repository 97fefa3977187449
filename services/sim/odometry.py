"""Wheel odometry: the true motion, integrated with a constant slip and random noise."""

import math

import numpy as np

from common.geometry import Pose2, compose, inverse, wrap


class WheelOdometry:
    """`slip` is the spread of a constant scale error, `noise` a random walk [m per sqrt(m)]; both 0: exact."""

    def __init__(self, start: Pose2, slip: float, noise: float, rng: np.random.Generator) -> None:
        self._true, self._believed = start, start
        self._noise, self._rng = noise, rng
        self._scale = 1.0 + (rng.normal(0.0, slip, 3) if slip else np.zeros(3))
        self._exact = not slip and not noise

    def update(self, true: Pose2) -> Pose2:
        """The believed pose after the robot has moved to `true`."""
        if self._exact:
            return true[0], true[1], wrap(true[2])
        dx, dy, turn = compose(inverse(self._true), true)
        self._true = true
        moved = math.hypot(dx, dy) + 0.2 * abs(turn)
        error = self._rng.normal(0.0, self._noise * math.sqrt(moved), 3) if moved > 1e-6 else np.zeros(3)
        step = (
            dx * self._scale[0] + error[0],
            dy * self._scale[1] + error[1],
            turn * self._scale[2] + error[2],
        )
        x, y, yaw = compose(self._believed, step)
        self._believed = (float(x), float(y), float(yaw))
        return self._believed
