"""Wheel odometry: the true motion, integrated with a constant slip, a constant veer and random noise."""

import math

import numpy as np

from common.geometry import IDENTITY_POSE, Pose2, compose, inverse
from services.sim.config import SimConfig

_TURN_RADIUS = 0.2
"""Distance of the wheels from the base's middle [m]: what turning on the spot rolls."""
SLIP = 0.1
"""Share of the way that the wheels miss while they slide (chosen: what an anti-lock brake of a car aims at)."""


class WheelOdometry:
    """Has `believed` the base at `start`; its errors are those of the seed. All three parameters 0: exact."""

    def __init__(self, start: Pose2, config: SimConfig, seed: int) -> None:
        rng = self._rng = np.random.default_rng([seed, 11])
        self._true, self.believed = start, start
        self._noise = config.odometry_noise
        self._scale = 1.0 + config.odometry_slip * rng.uniform(-1, 1, 3)
        self._veer = config.odometry_veer * float(rng.uniform(-1, 1))
        self._frame = IDENTITY_POSE
        self._exact = not (config.odometry_slip or config.odometry_noise or config.odometry_veer)

    def resume(self, true: Pose2, believed: Pose2) -> None:
        """Go on from a known pose with what was believed there."""
        self._true, self.believed = true, believed
        self._frame = compose(believed, inverse(true))

    def update(self, true: Pose2, sliding: bool = False) -> Pose2:
        """The believed pose after the robot has moved to `true`, on wheels at the end of their grip if `sliding`."""
        if self._exact:
            self.believed = compose(self._frame, true)
            return self.believed
        dx, dy, turn = compose(inverse(self._true), true)
        self._true = true
        moved = math.hypot(dx, dy) + _TURN_RADIUS * abs(turn)
        if moved < 1e-7:
            return self.believed
        ex, ey, eturn = self._rng.normal(0.0, self._noise * math.sqrt(moved), 3).tolist()
        a, b, c = (self._scale * (1.0 - SLIP * sliding)).tolist()
        step = dx * a + ex, dy * b + ey, turn * c + self._veer * moved + eturn
        self.believed = compose(self.believed, step)
        return self.believed
