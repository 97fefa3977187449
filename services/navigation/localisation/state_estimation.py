"""State estimation: odometry and lidar in; pose in the map, costmap and moving obstacles out."""

import numpy as np

from common import messages as m
from common import topics
from common.approach import HALF_WIDTH
from common.bus.port import Io, Job
from common.geometry import Pose2, compose, inverse
from services.navigation.config import NavigationConfig
from services.navigation.localisation.distance_field import distance_field
from services.navigation.localisation.localise import Localiser
from services.navigation.localisation.relocalise import relocalise
from services.navigation.motion.obstacle_tracker import ObstacleTracker
from services.navigation.planning.costmap import Array, Costmap

NEAR = 4.0
"""Range up to which lidar points are braked for and tracked [m]; chosen: beyond what the robot reaches in 5 s."""
EXPLAINED = 0.15
"""Distance from the map's walls and furniture within which they explain a point [m]; chosen: five times its noise."""
MAX_RANGE, MAX_VALUE = 1000.0, 1e9
"""What no lidar [m] and no odometry [m, m/s, rad] reports: a fault of its sender."""
BAD_FIT, GOOD_FIT, BETTER = 0.5, 0.6, 0.15
"""Shares of rays that the map explains [-]: below the first the pose is in doubt; a pose found anew needs the second,
and this much more than the old one. Chosen: people and boxes hide less than half of the walls."""
MIN_RAYS = 60
"""Rays without which nothing is found anew [count]; chosen: as many as relocalisation matches."""
DOUBT, MAX_DOUBT = 1.0, 16.0
"""Time of doubt before the robot counts as lost [s], doubled up to the second after a search that found nothing."""
FOUND = (0.1, 0.1, 0.05)
"""Standard deviation of a pose found anew [m, m, rad]; chosen: finer than the grid of its search."""


class StateEstimator:
    """`pose` [map] is None before the first odometry, `points` (n, 2) [map] is what the lidar saw last."""

    def __init__(self, config: NavigationConfig, io: Io, costmap: Costmap) -> None:
        self._config, self._io, self._map = config, io, costmap
        self._field = distance_field(io.household, config.lidar_height)
        home = io.household.home
        self.localiser = Localiser(self._field, (home.x, home.y, home.theta))
        self._good_at, self._doubt_after = 0.0, DOUBT
        self._asked: Job[tuple[Pose2, float]] | None = None
        self._asked_from: Pose2 = (0.0, 0.0, 0.0)
        self.tracker = ObstacleTracker()
        self.pose: Pose2 | None = None
        self._odometry: m.Odometry | None = None
        self._measured = 0.0
        self.points: Array | None = None
        self._layout = (0, 0.0, 0.0)
        self._angles: Array = np.empty(0)
        self._directions: Array = np.empty((0, 2))

    def step(self, now: float) -> None:
        """Take what wheels and lidar have reported, and publish the pose."""
        io = self._io
        for o in io.take_all(topics.ODOMETRY):
            if _sane(o.t, o.x, o.y, o.theta, o.vx, o.vy, o.omega):
                self._odometry = o
            else:
                io.count_drop(topics.ODOMETRY.key, "not a finite pose and velocity")
        scans, odometry = io.take_all(topics.SCAN), self._odometry
        if odometry is not None:
            believed: Pose2 | None = (odometry.x, odometry.y, odometry.theta)
        else:
            believed = _from_joints(io.latest(topics.JOINT_STATES))
        if believed is None:
            return
        measured = odometry.t if odometry is not None else now
        self.pose = self.localiser.predict(believed, measured - self._measured)
        self._measured = measured
        if scans:
            late = max(0.0, min(odometry.t - scans[-1].t, 0.1)) if odometry else 0.0
            self._look(scans[-1], odometry, late, now)
        x, y, theta = self.pose
        covariance = self.localiser.covariance.ravel().tolist()
        io.publish(topics.POSE, m.PoseEstimate(t=measured, x=x, y=y, theta=theta, covariance=covariance))

    def silence(self, now: float) -> float:
        """Time since the wheels last reported [s]."""
        return min(self._io.age(topics.ODOMETRY, now), self._io.age(topics.JOINT_STATES, now))

    def _look(self, scan: m.LaserScan, odometry: m.Odometry | None, late: float, now: float) -> None:
        if len(scan.ranges) < 8 or len(scan.ranges) % 4:
            self._io.count_drop(topics.SCAN.key, "ranges are at least two 32 bit floats")
            return
        with np.errstate(invalid="ignore"):
            ranges = np.frombuffer(scan.ranges, "<f4").astype(np.float64)
        described = _sane(scan.t, scan.x, scan.y, scan.angle_min, scan.range_min, scan.range_max)
        if not described or not 0.0 < scan.angle_increment < 1.0 or not (np.abs(ranges) <= MAX_RANGE).all():
            self._io.count_drop(topics.SCAN.key, "not the ranges of a lidar")
            return
        layout = len(ranges), scan.angle_min, scan.angle_increment
        if self._layout != layout:
            self._layout = layout
            self._angles = np.asarray(scan.angle_min + np.arange(len(ranges)) * scan.angle_increment, np.float64)
            self._directions = np.stack([np.cos(self._angles), np.sin(self._angles)], axis=1)
        ends = self._directions * ranges[:, None] + (scan.x, scan.y)
        own = np.abs(ends).max(axis=1) < HALF_WIDTH
        hit = (ranges <= scan.range_max) & (ranges > scan.range_min) & ~own
        seen = ends[hit]
        # The scan is older than the odometry by `late`: moved to where the robot is now.
        if late and odometry is not None:
            back = (-odometry.vx * late, -odometry.vy * late, -odometry.omega * late)
            seen = _transformed(back, seen)
        self.localiser.correct(seen)
        self._doubt(seen, now)
        self.pose = pose = self.localiser.pose
        placed = _transformed(pose, seen)
        near = ranges[hit] < NEAR
        unknown = near & ~self._field.near(placed, EXPLAINED)
        self.tracker.update(placed[unknown], (pose[0], pose[1]), now)
        lidar = compose(pose, (scan.x, scan.y, 0.0))
        self._map.see(lidar, self._angles, np.where(own, 0.0, ranges), scan.range_max, now)
        self.points = placed[near]

    # --- lost
    @property
    def lost(self) -> bool:
        """The scans have not fitted the map for a while; a better place is being looked for."""
        return self._asked is not None

    def _doubt(self, seen: Array, now: float) -> None:
        """When the scan fits badly for a while, look for a better pose in the whole map."""
        localiser, io = self.localiser, self._io
        if self._asked is not None:
            if not self._asked.poll(now):
                return
            pose, fit = self._asked.result()
            self._asked, self._good_at = None, now
            self._doubt_after = min(2 * self._doubt_after, MAX_DOUBT)
            if fit > max(GOOD_FIT, localiser.fit + BETTER):
                io.log.warning("localised anew", fit=round(fit, 2), before=round(localiser.fit, 2))
                # The robot may have moved since the scan was taken.
                localiser.place(compose(pose, compose(inverse(self._asked_from), localiser.pose)), FOUND)
                localiser.correct(seen)
        elif localiser.fit > BAD_FIT:
            self._good_at, self._doubt_after = now, DOUBT
        elif now - self._good_at > self._doubt_after and len(seen) > MIN_RAYS:
            io.log.warning("lost", fit=round(localiser.fit, 2))
            self._asked_from = localiser.pose
            self._asked = io.submit(relocalise, self._field, seen, io.household.low, io.household.high, seconds=0.3)


def _sane(*values: float) -> bool:
    return all(abs(v) <= MAX_VALUE for v in values)


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
        pose = found["base_x"], found["base_y"], found["base_yaw"]
    except KeyError:
        return None
    return pose if _sane(*pose) else None
