"""What the robot measures of its world: wheels, joints and lidar, as their drivers publish it."""

import math

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from common.robot.model import ARM, BASE
from services.sim.body import Body
from services.sim.config import SimConfig
from services.sim.lidar import RANGE_MAX, RANGE_MIN, RAYS, Lidar
from services.sim.odometry import WheelOdometry
from services.sim.proprioception import Proprioception

_NAMES = [*BASE, *ARM, "gripper"]


class Sensors:
    """`odometry` knows where the wheels believe the base to be."""

    def __init__(self, body: Body, seed: int, config: SimConfig, io: Io, start: Pose2) -> None:
        self._body, self._io = body, io
        self.odometry = WheelOdometry(start, config, seed)
        bought = config.sensors == "bought"
        largest = body.model.actuator_forcerange[body.ctrl_at[3:], 1]
        self._felt = Proprioception(seed, largest) if bought else None
        noise, missing = (config.lidar_noise, config.lidar_missing) if bought else (0.0, 0.0)
        self._lidar = Lidar(body.names, body.lidar_site, noise, missing, io.rng)

    def feel(self, t: float) -> None:
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
                name=_NAMES,
                position=[x, y, yaw, *angles, width],
                velocity=[*velocity, body.width_rate()],
                effort=[*efforts, finger],
            ),
        )

    def scan(self, t: float) -> None:
        """One turn of the lidar."""
        ranges = self._lidar.scan(self._body.model, self._body.data)
        scan = m.LaserScan(
            t=t, ranges=ranges.tobytes(), angle_increment=2 * math.pi / RAYS, range_min=RANGE_MIN, range_max=RANGE_MAX
        )
        self._io.publish(topics.SCAN, scan)
