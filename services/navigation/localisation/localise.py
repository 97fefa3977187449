"""The robot's pose in the map: odometry predicts, the lidar corrects; an iterated Kalman filter over a distance field.

Each scan is matched to the static map by Gauss-Newton steps on the signed distance of its end points, with the
prediction as the prior and Tukey's weights, so that what the map does not have (people, boxes) pulls at nothing.
"""

import math

import numpy as np
from numpy.typing import NDArray

from common.approach import WHEELS
from common.geometry import Array, Pose2, compose, inverse, wrap
from services.navigation.localisation.distance_field import DistanceField

SHARE, WALK = 0.03, 0.01
"""Error of odometry: a share of the motion [-] and a random walk [m or rad per sqrt(m)]; chosen: on the safe side."""
SIGMA = 0.03
"""Standard deviation of one end point [m]: more than its noise, since neighbours err together."""
STEPS = 6
"""Gauss-Newton steps per scan [count]; chosen: the weights narrow in four."""
JUMP, TOP_SPEED = 0.1, 1.0
"""Farther than this [m] beyond what this speed [m/s] allows, odometry has not moved but started anew."""
START, UNKNOWN = (0.02, 0.02, 0.02), (0.3, 0.3, 0.2)
"""Standard deviation of the first pose [m, m, rad]: at home, and elsewhere."""
FLOOR = np.square([0.001, 0.001, 0.0007])
"""Variance added before every scan [m2, m2, rad2], so that the filter never stops to correct."""
INLIER = 0.10
"""Distance from the map within which it explains an end point [m]; chosen: three SIGMA."""
MIN_POINTS = 20
"""End points without which a scan corrects nothing [count]."""
WIDEST, NARROWEST = 0.5, 0.10
"""Width of Tukey's weights in the first step at most, and in the last [m]; chosen: for a bad prior, and INLIER."""
CONVERGED = 2e-4
"""Step that ends the iteration [m or rad]; chosen: far below the lidar's noise."""


class Localiser:
    """Keeps pose, covariance (3, 3) and how well the last scan fits (`fit`, the share of rays on the map)."""

    def __init__(self, field: DistanceField, home: Pose2 = (0.0, 0.0, 0.0)) -> None:
        self._field, self._home = field, home
        self._odometry: Pose2 | None = None
        self.pose: Pose2 = (0.0, 0.0, 0.0)
        self.covariance: Array = np.diag(np.square(START))
        self.fit = 1.0

    def place(self, pose: Pose2, spread: tuple[float, float, float]) -> None:
        """Start anew from a guessed pose [map]."""
        self.pose, self.covariance = pose, np.diag(np.square(spread))

    def anchor(self, odometry: Pose2) -> None:
        """Set the odometry that belongs to the current pose: the next prediction starts from it."""
        self._odometry = odometry

    def predict(self, odometry: Pose2, elapsed: float = 1.0) -> Pose2:
        """Predict the pose from odometry; odometry that jumps has restarted and is taken as a new guess in the map.

        `elapsed` is what the odometry's own clock says has passed [s].
        """
        if self._odometry is None:
            self._odometry = odometry
            at_home = math.dist(odometry[:2], self._home[:2]) < START[0]
            self.place(odometry, START if at_home else UNKNOWN)
            return self.pose
        if odometry == self._odometry:
            return self.pose
        dx, dy, turn = compose(inverse(self._odometry), odometry)
        self._odometry = odometry
        if elapsed < 0.0 or math.hypot(dx, dy) > JUMP + TOP_SPEED * elapsed:
            self.place(odometry, UNKNOWN)
            return self.pose
        c, s = math.cos(self.pose[2]), math.sin(self.pose[2])
        f = np.array([[1, 0, -s * dx - c * dy], [0, 1, c * dx - s * dy], [0, 0, 1]])
        moved = math.hypot(dx, dy) + WHEELS * abs(turn)
        place = (SHARE * moved) ** 2 + WALK**2 * moved
        self.covariance = f @ self.covariance @ f.T + np.diag([place, place, place])
        self.pose = compose(self.pose, (dx, dy, turn))
        return self.pose

    def follow(self, odometry: Pose2, frame: Pose2) -> Pose2:
        """Take the pose from another localisation: `frame` is frame odom in its map, `odometry` the base in odom."""
        self._odometry, self.pose = odometry, compose(frame, odometry)
        return self.pose

    def correct(self, points: Array) -> float:
        """Match scan end points (n, 2) in the base frame; the share of them that the map explains."""
        if len(points) < MIN_POINTS:
            self.fit = 0.0
            return 0.0
        covariance = self.covariance + np.diag(FLOOR)
        prior = np.linalg.inv(covariance)
        spread = math.sqrt(max(covariance[0, 0], covariance[1, 1]) + 4.0 * covariance[2, 2])
        start = np.array(self.pose)
        x = start.copy()
        hessian = prior
        for step in range(STEPS):
            width = max(NARROWEST, min(WIDEST, 3.0 * spread) * 0.5**step)
            r, j = self._residuals(x, points)
            weight = np.square(1.0 - np.minimum(np.square(r / width), 1.0)) / SIGMA**2
            weighted = j * weight
            hessian = weighted @ j.T + prior
            move = np.linalg.solve(hessian, -(weighted @ r) - prior @ (x - start))
            x += move
            if width == NARROWEST and abs(move).max() < CONVERGED:
                break
        fit = float(np.mean(np.abs(r) < INLIER))
        self.fit = fit
        self.pose = float(x[0]), float(x[1]), wrap(float(x[2]))
        self.covariance = np.linalg.inv(hessian)
        return fit

    def _residuals(self, x: Array, points: Array) -> tuple[Array, NDArray[np.float64]]:
        """Distances (n,) and their derivatives (3, n) by x, y and heading."""
        c, s = math.cos(x[2]), math.sin(x[2])
        turned = points @ np.array([[c, s], [-s, c]])
        r, gx, gy = self._field.at(turned + x[:2])
        return r, np.stack([gx, gy, gy * turned[:, 0] - gx * turned[:, 1]])

    def to_odometry(self, target: Pose2) -> Pose2:
        """A pose [map] in frame odom."""
        if self._odometry is None:
            return target
        return compose(self._odometry, compose(inverse(self.pose), target))
