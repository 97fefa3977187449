"""Robot state at a stamp: pose of the base and joint angles when a picture was taken, and the model posed by them."""

import math
from collections import deque

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.geometry import Array, Pose2, pose_at, wrap
from common.robot.grip import Grip
from common.robot.joints import ARM
from services.perception.views.self_filter import RobotModel

HISTORY = 100
"""Poses that are kept: 5 s at 20 Hz, longer than a picture is under way."""
DRIVING = 0.1
"""Speed [m/s] above which the base drives. Chosen: above the noise of localisation over 0.15 s at rest."""


class StateBuffer:
    """Reads pose, joints and the robot's description; the model loads in the worker."""

    def __init__(self, io: Io) -> None:
        self._io = io
        self._model: Job[RobotModel] | None = None
        self._description: m.RobotDescription | None = None
        self._poses: deque[tuple[float, Pose2]] = deque(maxlen=HISTORY)
        self._joints: deque[tuple[float, Array, float]] = deque(maxlen=20)
        self._force = 0.0

    def update(self) -> bool:
        """Take in what was measured; True when the joints are known now."""
        io = self._io
        for pose in io.take_all(topics.POSE):
            if pose.lost:
                # What is seen meanwhile has no place in the map.
                self._poses.clear()
            else:
                self._poses.append((pose.t, (pose.x, pose.y, pose.theta)))
        description = io.latest(topics.ROBOT_DESCRIPTION)
        if self._model is None and description is not None and description is not self._description:
            self._description = description
            self._model = io.submit(RobotModel, description.mjcf, seconds=0.2)
        joints = io.latest(topics.JOINT_STATES)
        if (
            joints is None
            or not {*ARM, "gripper"} <= set(joints.name)
            or min(len(joints.position), len(joints.effort)) < len(joints.name)
        ):
            return False
        found = dict(zip(joints.name, zip(joints.position, joints.effort, strict=False), strict=False))
        width, self._force = found["gripper"]
        self._joints.append((joints.t, np.array([found[name][0] for name in ARM]), width))
        return True

    @property
    def base(self) -> Pose2 | None:
        """Where the base is in the map."""
        return self._poses[-1][1] if self._poses else None

    def base_at(self, t: float) -> Pose2 | None:
        """The base's pose at robot time `t`, between the two estimates around it."""
        return pose_at(self._poses, t) if self._poses else None

    def turning(self) -> float:
        """How fast the base turned over the last estimates [rad/s]."""
        if len(self._poses) < 4:
            return 0.0
        (t0, a), (t1, b) = self._poses[-4], self._poses[-1]
        return abs(wrap(b[2] - a[2])) / max(t1 - t0, 1e-3)

    def driving(self) -> bool:
        """True while the base moves over the floor, by the last estimates."""
        if len(self._poses) < 4:
            return False
        (t0, a), (t1, b) = self._poses[-4], self._poses[-1]
        return math.hypot(b[0] - a[0], b[1] - a[1]) > DRIVING * max(t1 - t0, 1e-3)

    def robot(self, now: float, t: float | None = None) -> RobotModel | None:
        """The robot's model with its arm as it is, or was at `t`; None while it loads or nothing was felt."""
        robot = self._loaded(now) if self._joints else None
        if robot is not None:
            newest = self._joints[-1]
            _, arm, width = newest if t is None else min(self._joints, key=lambda row: abs(row[0] - t))
            robot.pose(arm, width)
        return robot

    def holds(self, robot: RobotModel) -> bool:
        """True when the fingers press on something."""
        return Grip(self._joints[-1][2], abs(self._force)).holds(robot.open)

    def _loaded(self, now: float) -> RobotModel | None:
        if self._model is None or not self._model.poll(now):
            return None
        try:
            return self._model.result()
        except (ValueError, KeyError) as error:
            self._io.count_drop(topics.ROBOT_DESCRIPTION.key, f"not a robot with our joints: {error}")
            self._model = None
            return None
