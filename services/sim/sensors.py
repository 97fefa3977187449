"""The robot's sensors: odometry, joint states and lidar with their errors, as drivers publish them."""

import math

import numpy as np

from common import messages as m
from common import topics
from common.approach import WHEELS
from common.bus.port import Io
from common.geometry import IDENTITY_POSE, Array, Pose2, compose, inverse
from common.robot.joints import JOINTS
from services.sim.body import Body
from services.sim.config import SimConfig
from services.sim.lidar import RANGE_MAX, RANGE_MIN, RAYS, Lidar

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
SLIP = 0.1
"""Share of the way that the wheels miss while they slide (chosen: what an anti-lock brake of a car aims at)."""


class Sensors:
    """Sensors of one robot; `odometry` is what its wheels count."""

    def __init__(self, body: Body, seed: int, config: SimConfig, io: Io, start: Pose2) -> None:
        self._body, self._io = body, io
        self.odometry = WheelOdometry(start, config, seed)
        bought = config.sensors == "bought"
        largest = body.model.actuator_forcerange[body.ctrl_at[3:], 1]
        self._felt = Proprioception(seed, largest) if bought else None
        noise, missing = (config.lidar_noise, config.lidar_missing) if bought else (0.0, 0.0)
        self._lidar = Lidar(body.names, body.lidar_site, noise, missing, io.rng)

    def publish_state(self, t: float) -> None:
        """Publish odometry and joint states."""
        io, body = self._io, self._body
        arm = body.joints.tolist()
        actual = (arm[0], arm[1], arm[2])
        x, y, yaw = self.odometry.update(actual, body.sliding())
        cos, sin = math.cos(actual[2]), math.sin(actual[2])
        velocity = body.rates.tolist()
        vx, vy, omega = velocity[:3]
        odometry = m.Odometry(t=t, x=x, y=y, theta=yaw, vx=cos * vx + sin * vy, vy=cos * vy - sin * vx, omega=omega)
        io.publish(topics.ODOMETRY, odometry)
        efforts, finger, width = body.forces[:-1].tolist(), body.finger_force(), body.width()
        angles, felt = arm[3:], self._felt
        if felt is not None:
            # The base's own are in its odometry.
            read = felt.read(np.array([*angles, *velocity[3:], *efforts[3:], finger])).tolist()
            n = len(angles)
            angles, velocity[3:], efforts[3:], finger = read[:n], read[n : 2 * n], read[2 * n : 3 * n], read[-1]
            width = felt.width(width)
        io.publish(
            topics.JOINT_STATES,
            m.JointStates(
                t=t,
                name=list(JOINTS),
                position=[x, y, yaw, *angles, width],
                velocity=[*velocity, body.width_rate()],
                effort=[*efforts, finger],
            ),
        )

    def publish_scan(self, t: float) -> None:
        """Publish one scan of the lidar."""
        ranges = self._lidar.scan(self._body.model, self._body.data)
        scan = m.LaserScan(
            t=t, ranges=ranges.tobytes(), angle_increment=2 * math.pi / RAYS, range_min=RANGE_MIN, range_max=RANGE_MAX
        )
        self._io.publish(topics.SCAN, scan)


# --- wheel odometry: the true motion, integrated with a constant slip, a constant veer and random noise
class WheelOdometry:
    """Integrates `believed`, the pose by the wheels, from `start`, with errors by the seed; exact if all are 0."""

    def __init__(self, start: Pose2, config: SimConfig, seed: int) -> None:
        rng = self._rng = np.random.default_rng([seed, 11])
        self._true, self.believed = start, start
        self._noise = config.odometry_noise
        self._scale: list[float] = (1.0 + config.odometry_slip * rng.uniform(-1, 1, 3)).tolist()
        self._veer = config.odometry_veer * float(rng.uniform(-1, 1))
        self._frame = IDENTITY_POSE
        self._exact = not (config.odometry_slip or config.odometry_noise or config.odometry_veer)

    def resume(self, true: Pose2, believed: Pose2) -> None:
        """Go on from the true pose `true`, at which the wheels have counted `believed`."""
        self._true, self.believed = true, believed
        self._frame = compose(believed, inverse(true))

    def update(self, true: Pose2, sliding: bool = False) -> Pose2:
        """The pose by the wheels after the robot has moved to `true`; `sliding`: the wheels lost their grip."""
        if self._exact:
            self.believed = compose(self._frame, true)
            return self.believed
        dx, dy, turn = compose(inverse(self._true), true)
        self._true = true
        moved = math.hypot(dx, dy) + WHEELS * abs(turn)
        if moved < 1e-7:
            return self.believed
        ex, ey, eturn = self._rng.normal(0.0, self._noise * math.sqrt(moved), 3).tolist()
        a, b, c = (scale * (1.0 - SLIP * sliding) for scale in self._scale)
        step = dx * a + ex, dy * b + ey, turn * c + self._veer * moved + eturn
        self.believed = compose(self.believed, step)
        return self.believed


# --- what the arm and the hand feel of themselves: encoders, motor currents and the gripper's width, with their error
class Proprioception:
    """Errors of a robot's encoders and motor currents, by `seed`; `efforts` (n,): each joint's largest effort."""

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
        """Measured values (3 n + 1,) for true angles [rad], speeds [rad/s], torques [N m] and a finger's force [N]."""
        if self._at == len(self._errors):
            drawn = self._rng.standard_normal((BLOCK, len(self._mean)))
            self._errors, self._at = self._mean + self._deviation * drawn, 0
        self._at += 1
        return np.asarray(true + self._errors[self._at - 1])

    def width(self, told: float) -> float:
        """The measured width [m] of the gripper, for the one by its motor's travel.

        The play of the linkage changes only while the pads move, so a thing that is held keeps its width.
        """
        travel, self._width = abs(told - self._width), told
        if travel:
            keeps = math.exp(-travel / PLAY_TRAVEL)
            fresh = float(self._rng.normal(0.0, PLAY))
            self._play = keeps * self._play + math.sqrt(1.0 - keeps * keeps) * fresh
        return max(0.0, told + max(-PLAY_LIMIT, min(PLAY_LIMIT, self._play)))
