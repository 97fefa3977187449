"""Where the robot's parts are, as trees of frames are told to other tools: map, odom, base_link, and its links.

Names by REP 105 (https://www.ros.org/reps/rep-0105.html); the link `base_link` is the body `base` of the description.
"""

from collections import deque
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from common import messages as m
from common.geometry import IDENTITY_POSE, Pose2, compose, inverse, yaw_quat
from common.messages.base import Quat, Vec3
from common.robot.model import ARM, RobotKinematics

MAP, ODOM, BASE_LINK, LIDAR = "map", "odom", "base_link", "lidar"
BASE_BODY = "base"
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
        """Take what the wheels report."""
        if self._odometry and message.t < self._odometry[-1][0]:
            self._odometry.clear()  # another world, whose time began anew
        self._odometry.append((message.t, (message.x, message.y, message.theta)))

    def estimate(self, message: m.PoseEstimate) -> None:
        """Take where navigation believes the base is; without odometry of about that time it says nothing."""
        if self._odometry:
            _, odometry = min(self._odometry, key=lambda sample: abs(sample[0] - message.t))
            self._correction = compose((message.x, message.y, message.theta), inverse(odometry))

    def poses(self) -> list[FramePose]:
        """Both frames at the time of the newest odometry; none before the first."""
        if not self._odometry:
            return []
        t, odometry = self._odometry[-1]
        return [planar(MAP, ODOM, self._correction, t), planar(ODOM, BASE_LINK, odometry, t)]


class LinkFrames:
    """The links of a robot's description, each in its parent, by its joints' positions.

    Raises:
        ValueError: not a model.
        KeyError: not of this robot's build.
    """

    def __init__(self, mjcf: str) -> None:
        self._kinematics = RobotKinematics(mjcf)
        model = self._kinematics.model
        base = model.body(BASE_BODY).id
        self._bodies = [b for b in range(model.nbody) if model.body_rootid[b] == base and b != base]
        self._parents = [int(model.body_parentid[b]) for b in self._bodies]
        self._names = [
            (link_name(model, p), link_name(model, b)) for b, p in zip(self._bodies, self._parents, strict=True)
        ]

    def hand(self, width: float) -> dict[str, float]:
        """Positions of the gripper's joints at a width [m] between its pads."""
        return self._kinematics.hand_joints(width)

    def poses(self, joints: m.JointStates) -> list[FramePose]:
        """Every link but the base in the link that carries it; none where an arm joint is not reported."""
        q = dict(zip(joints.name, joints.position, strict=False))
        if not all(name in q for name in ARM):
            return []
        self._kinematics.pose(np.array([q[name] for name in ARM]), q.get("gripper", self._kinematics.open))
        data = self._kinematics.data
        return list(self._relative(data, joints.t))

    def _relative(self, data: Any, t: float) -> Iterator[FramePose]:
        for body, parent, (above, name) in zip(self._bodies, self._parents, self._names, strict=True):
            turn = data.xmat[parent].reshape(3, 3).T
            x, y, z = (float(v) for v in turn @ (data.xpos[body] - data.xpos[parent]))
            yield FramePose(above, name, (x, y, z), _between(data.xquat[parent], data.xquat[body]), t)


def link_name(model: Any, body: int) -> str:
    """The frame of a body."""
    name = str(model.body(body).name)
    return BASE_LINK if name == BASE_BODY else name or f"body_{body}"


def _between(a: Any, b: Any) -> Quat:
    """Rotation b in the frame of rotation a: the product of a's conjugate and b."""
    w, x, y, z = float(a[0]), -float(a[1]), -float(a[2]), -float(a[3])
    bw, bx, by, bz = (float(v) for v in b)
    return (
        w * bw - x * bx - y * by - z * bz,
        w * bx + x * bw + y * bz - z * by,
        w * by - x * bz + y * bw + z * bx,
        w * bz + x * by - y * bx + z * bw,
    )


def camera_pose(picture: m.Rgbd) -> FramePose:
    """The optical frame of a picture in the base."""
    return FramePose(BASE_LINK, optical_frame(picture.camera), picture.position, picture.orientation, picture.t)


def lidar_pose(scan: m.LaserScan) -> FramePose:
    """The lidar in the base, at the height that the scan does not tell: on the floor."""
    return planar(BASE_LINK, LIDAR, (scan.x, scan.y, 0.0), scan.t)
