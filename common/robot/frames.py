"""Frames of the base and its sensors in the tree that other tools expect: map, odom, base_link.

Names by REP 105 (https://www.ros.org/reps/rep-0105.html).
"""

from collections import deque
from typing import NamedTuple

from common import messages as m
from common.geometry import IDENTITY_POSE, Pose2, compose, inverse, yaw_quat
from common.messages.base import Quat, Vec3

MAP, ODOM, BASE_LINK, LIDAR = "map", "odom", "base_link", "lidar"
HISTORY = 100
"""Samples of odometry that are remembered [count]: 1 s, more than an estimate of the pose is late."""


class FramePose(NamedTuple):
    """Frame `child` in frame `parent`: `position` [m], `orientation` (w, x, y, z), at robot time `t` [s]."""

    parent: str
    child: str
    position: Vec3
    orientation: Quat
    t: float


def planar(parent: str, child: str, pose: Pose2, t: float) -> FramePose:
    """A pose on the floor as a frame."""
    return FramePose(parent, child, (pose[0], pose[1], 0.0), yaw_quat(pose[2]), t)


def optical_frame(camera: str) -> str:
    """The frame of a camera's pictures: x right, y down, z forward (REP 103)."""
    return f"{camera}_camera_optical_frame"


class BaseFrames:
    """The base in the map by way of its odometry: map -> odom jumps with estimates, odom -> base_link is smooth."""

    def __init__(self) -> None:
        self._odometry: deque[tuple[float, Pose2]] = deque(maxlen=HISTORY)
        self._correction: Pose2 = IDENTITY_POSE

    def odometry(self, message: m.Odometry) -> None:
        """Take a message of odometry."""
        if self._odometry and message.t < self._odometry[-1][0]:
            self._odometry.clear()  # another world, whose time began anew
        self._odometry.append((message.t, (message.x, message.y, message.theta)))

    def estimate(self, message: m.PoseEstimate) -> None:
        """Take navigation's pose estimate; ignored without odometry of about the same time."""
        if self._odometry:
            _, odometry = min(self._odometry, key=lambda sample: abs(sample[0] - message.t))
            self._correction = compose((message.x, message.y, message.theta), inverse(odometry))

    def poses(self) -> list[FramePose]:
        """Both frames at the time of the newest odometry; none before the first."""
        if not self._odometry:
            return []
        t, odometry = self._odometry[-1]
        return [planar(MAP, ODOM, self._correction, t), planar(ODOM, BASE_LINK, odometry, t)]


def camera_pose(picture: m.Rgbd) -> FramePose:
    """The optical frame of a picture in the base."""
    return FramePose(BASE_LINK, optical_frame(picture.camera), picture.position, picture.orientation, picture.t)


def lidar_pose(scan: m.LaserScan) -> FramePose:
    """The lidar in the base, at the height that the scan does not tell: on the floor."""
    return planar(BASE_LINK, LIDAR, (scan.x, scan.y, 0.0), scan.t)
