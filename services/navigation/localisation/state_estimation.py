"""State estimation: odometry and lidar in; pose in the map, costmap and moving obstacles out."""

import math

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Array, Pose2, compose, transformed
from common.robot.lidar import sane
from services.navigation.config import NavigationConfig
from services.navigation.localisation.distance_field import distance_field
from services.navigation.localisation.global_localiser import GlobalLocaliser
from services.navigation.localisation.live_map import LiveMap
from services.navigation.localisation.localise import Localiser
from services.navigation.localisation.map_fit import MapFit
from services.navigation.localisation.scan import Scan, scan_of
from services.navigation.motion.obstacle_tracker import ObstacleTracker
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.obstacle_layer import in_discs

NEAR = 4.0
"""Range up to which lidar points are braked for and tracked [m]; chosen: beyond what the robot reaches in 5 s."""
EXPLAINED = 0.15
"""Distance from the map's walls and furniture within which they explain a point [m]; chosen: five times its noise."""
AROUND = 0.15
"""How far beyond a person's radius points are still theirs [m]: a stride, and the error of the track."""
FOUND = (0.1, 0.1, 0.05)
"""Standard deviation of a pose found anew [m, m, rad]; chosen: finer than the grid of its search."""
ANYWHERE = (10.0, 10.0, math.pi)
"""Standard deviation of the pose of a robot that is lost [m, m, rad]; chosen: as wide as a home."""


class StateEstimator:
    """Estimates `pose` [map], None before the first odometry; `points` (n, 2) [map] is what the lidar saw last near by.

    `unmapped` (n, 2) [map] are those of the points that the map does not explain; `odometry` is the pose by the wheels
    alone, `fresh`: a scan arrived in this step."""

    def __init__(self, config: NavigationConfig, io: Io, costmap: Costmap) -> None:
        self._io, self._map = io, costmap
        self.field = distance_field(io.household, config.lidar_height)
        home = io.household.home
        self.localiser = Localiser(self.field, (home.x, home.y, home.theta))
        self.everywhere = GlobalLocaliser(
            io, self.field, known=config.initial_pose == "home" or config.map == "mapping"
        )
        self.tracker = ObstacleTracker()
        self.map_fit = MapFit()
        self._live = LiveMap(io, costmap) if config.map == "mapping" else None
        self.pose: Pose2 | None = None
        self.odometry: Pose2 = (0.0, 0.0, 0.0)
        self.scan: Scan | None = None
        self.points: Array | None = None
        self.unmapped: Array = np.empty((0, 2))
        self.fresh = False
        self.robots: list[tuple[float, float, float]] = []
        """Circles (x, y, radius) [map, m] in which points are other robots' own."""
        self._odometry: m.Odometry | None = None
        self._measured = self._scanned = 0.0

    @property
    def lost(self) -> bool:
        """True while the robot does not know where it is: `pose` means nothing then, and `points` is in frame odom."""
        return self.everywhere.lost

    def step(self, now: float) -> None:
        """Take what wheels and lidar have reported, and publish the pose."""
        io = self._io
        for o in io.take_all(topics.ODOMETRY):
            if sane(o.t, o.x, o.y, o.theta, o.vx, o.vy, o.omega):
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
        self.odometry = believed
        measured = odometry.t if odometry is not None else now
        if self._live is None:
            self.pose = self.localiser.predict(believed, measured - self._measured)
        else:
            self._live.update()
            if self._live.odom is None:
                return
            self.pose = self.localiser.follow(believed, self._live.odom)
        self._measured = measured
        self.fresh = bool(scans)
        if scans:
            late = max(0.0, min(odometry.t - scans[-1].t, 0.1)) if odometry else 0.0
            self._take(scans[-1], odometry, late, now)
        x, y, theta = self.pose
        unsure = self.lost or self.everywhere.broken
        covariance = _diagonal(ANYWHERE) if unsure else self.localiser.covariance.ravel().tolist()
        io.publish(topics.POSE, m.PoseEstimate(t=measured, x=x, y=y, theta=theta, covariance=covariance))

    def age(self, now: float) -> float:
        """Age [s] of the measurement that `pose` rests on."""
        return now - self._measured

    def silence(self, now: float) -> float:
        """Time since the wheels last reported [s]."""
        return min(self._io.age(topics.ODOMETRY, now), self._io.age(topics.JOINT_STATES, now))

    def _take(self, message: m.LaserScan, odometry: m.Odometry | None, late: float, now: float) -> None:
        try:
            scan = scan_of(message)
        except ValueError as error:
            self._io.count_drop(topics.SCAN.key, str(error))
            return
        # The scan is older than the odometry by `late`: moved to where the robot is now.
        if late and odometry is not None:
            scan = scan.after((odometry.vx * late, odometry.vy * late, odometry.omega * late))
        self.scan = scan
        elapsed, self._scanned = self._measured - self._scanned, self._measured
        if self._live is not None:
            self._see(scan, now)
            return
        if not self.lost:
            self.localiser.correct(scan.points)
            self.pose = self.localiser.pose
            if self.everywhere.watch(self.localiser, scan.points, now):
                self._forget()
        else:
            found = self.everywhere.step(scan.points, self.odometry, elapsed, now)
            if found is not None:
                self._forget()
                self.localiser.place(found, FOUND)
                self.localiser.correct(scan.points)
                self.pose = self.localiser.pose
        self._see(scan, now)

    def _forget(self) -> None:
        """Forget what was seen so far: it was entered in another frame."""
        self._map.obstacles.forget()
        self.tracker = ObstacleTracker()

    def _see(self, scan: Scan, now: float) -> None:
        """Enter what the lidar sees, in the map or, around a robot that is lost, in frame odom."""
        frame = self.odometry if self.lost or self.pose is None else self.pose
        placed, near = transformed(frame, scan.points), scan.ranges < NEAR
        self.points = placed[near]
        if not self.lost:
            mapped = self.field.near if self._live is None else self._map.explains
            explained = mapped(placed, EXPLAINED) | in_discs(placed[:, 0], placed[:, 1], self.robots)
            left = self.unmapped = placed[near & ~explained]
            self.tracker.update(left, (frame[0], frame[1]), now, self._map.obstacles.stood_at(left, now))
            # A map in the making fits by itself.
            if len(placed) and not self.everywhere.broken and self._live is None:
                self.map_fit.see(frame, float(np.mean(explained | self._map.obstacles.lasting_at(placed))))
            self.mark(self._map, frame, now)

    def mark(self, costmap: Costmap, frame: Pose2, now: float) -> None:
        """Enter the newest scan in a costmap; `frame` is the base's pose in the costmap's frame."""
        if (scan := self.scan) is not None:
            around = self.tracker.people()
            people, moving = ([(o.x, o.y, o.radius + AROUND) for o in around if o.walked is w] for w in (True, False))
            eye, reach = compose(frame, (*scan.lidar, 0.0)), scan.reach
            if self.robots and not self.lost:
                angles = scan.angles + eye[2]
                ends = eye[:2] + reach[:, None] * np.stack((np.cos(angles), np.sin(angles)), axis=1)
                # What another robot holds up tells nothing, as what this one does.
                reach = np.where(in_discs(ends[:, 0], ends[:, 1], self.robots), 0.0, reach)
            costmap.obstacles.see(eye, scan.angles, reach, scan.range_max, now, people, moving)


def _diagonal(spread: tuple[float, float, float]) -> list[float]:
    """The covariance, row-major 3 x 3, of independent errors with these standard deviations."""
    x, y, theta = spread
    return [x * x, 0.0, 0.0, 0.0, y * y, 0.0, 0.0, 0.0, theta * theta]


def _from_joints(joints: m.JointStates | None) -> Pose2 | None:
    """The base pose of `joint_states`, for a robot without `base/odom`."""
    if joints is None:
        return None
    found = dict(zip(joints.name, joints.position, strict=False))
    try:
        pose = found["base_x"], found["base_y"], found["base_yaw"]
    except KeyError:
        return None
    return pose if sane(*pose) else None
