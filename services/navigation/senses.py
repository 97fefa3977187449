"""What navigation feels: odometry and lidar in, pose in the map and the live costmap out."""

import numpy as np

from common import messages as m
from common import topics
from common.geometry import Pose2, compose
from common.io import Io
from services.navigation.config import NavigationConfig
from services.navigation.costmap import Array, Costmap
from services.navigation.floorplan import distance_field
from services.navigation.localise import Localiser
from services.navigation.movers import Movers

NEAR = 4.0
EXPLAINED = 0.15
MAX_RANGE = 1000.0


class Senses:
    """`pose` is None before the first odometry, `points` (n, 2) [map] is what the lidar saw last."""

    def __init__(self, config: NavigationConfig, io: Io, costmap: Costmap) -> None:
        self._config, self._io, self._map = config, io, costmap
        self._field = distance_field(io.scene, config.lidar_height)
        self.localiser = Localiser(self._field)
        self.movers = Movers()
        self.pose: Pose2 | None = None
        self.points: Array | None = None
        self._angles: Array = np.empty(0)
        self._directions: Array = np.empty((0, 2))

    def step(self, now: float) -> None:
        io = self._io
        odometry = io.latest(topics.ODOMETRY)
        scans = io.drain(topics.SCAN)
        if odometry is not None:
            believed = (odometry.x, odometry.y, odometry.theta)
        else:
            joints = _from_joints(io.latest(topics.JOINT_STATES))
            if joints is None:
                return
            believed = joints
        self.pose = self.localiser.predict(believed)
        if scans:
            late = max(0.0, min(odometry.t - scans[-1].t, 0.1)) if odometry else 0.0
            self._look(scans[-1], odometry, late, now)
        x, y, theta = self.pose
        covariance = self.localiser.covariance.ravel().tolist()
        io.publish(topics.POSE, m.PoseEstimate(t=now, x=x, y=y, theta=theta, covariance=covariance))

    def silence(self, now: float) -> float:
        """Seconds since the wheels last reported."""
        return min(self._io.age(topics.ODOMETRY, now), self._io.age(topics.JOINT_STATES, now))

    def _look(self, scan: m.LaserScan, odometry: m.Odometry | None, late: float, now: float) -> None:
        if not scan.ranges or len(scan.ranges) % 4:
            self._io.count_drop(topics.SCAN.key, "ranges are 32 bit floats")
            return
        ranges = np.frombuffer(scan.ranges, "<f4").astype(np.float64)
        if not (np.abs(ranges) <= MAX_RANGE).all():
            self._io.count_drop(topics.SCAN.key, "ranges are finite and within a kilometre")
            return
        if len(self._angles) != len(ranges):
            self._angles = np.asarray(scan.angle_min + np.arange(len(ranges)) * scan.angle_increment, np.float64)
            self._directions = np.stack([np.cos(self._angles), np.sin(self._angles)], axis=1)
        hit = (ranges <= scan.range_max) & (ranges > scan.range_min)
        seen = self._directions[hit] * ranges[hit, None] + (scan.x, scan.y)
        # The scan is older than the odometry by `late`: moved to where the robot is now.
        if late and odometry is not None:
            back = (-odometry.vx * late, -odometry.vy * late, -odometry.omega * late)
            seen = _transformed(back, seen)
        self.localiser.correct(seen)
        self.pose = pose = self.localiser.pose
        placed = _transformed(pose, seen)
        near = ranges[hit] < NEAR
        unknown = near & ~self._field.near(placed, EXPLAINED)
        self.movers.update(placed[unknown], (pose[0], pose[1]), now)
        lidar = compose(pose, (scan.x, scan.y, 0.0))
        self._map.see(lidar, self._angles, ranges, scan.range_max, now)
        self.points = placed[near]


def _transformed(frame: Pose2, points: Array) -> Array:
    """Points (n, 2) of `frame` in its parent."""
    c, s = np.cos(frame[2]), np.sin(frame[2])
    moved: Array = points @ np.array([[c, s], [-s, c]]) + frame[:2]
    return moved


def _from_joints(joints: m.JointStates | None) -> Pose2 | None:
    """The base pose of `joint_states`, for a robot without `base/odom`."""
    if joints is None:
        return None
    found = dict(zip(joints.name, joints.position, strict=False))
    try:
        return found["base_x"], found["base_y"], found["base_yaw"]
    except KeyError:
        return None
