"""What the drivers and localisation tell of the robot: its description, joints, gripper and base."""

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.geometry import Pose2
from common.robot.grip import Grip
from common.robot.joints import ARM
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution.robot import Robot
from services.manipulation.planning.motion_planner import Planner

LOADING = 0.5
"""Robot time [s] that loading the arm's model takes, where time is the simulation's. Chosen: what it takes here."""


class Feedback:
    """Keeps a `Robot` as it is told to be."""

    def __init__(self, config: ManipulationConfig, io: Io, robot: Robot) -> None:
        self._config, self._io, self._robot = config, io, robot
        self._loading: Job[Planner] | None = None
        self._description: m.RobotDescription | None = None
        self._indices: tuple[list[str], list[int], int] | None = None

    def update(self, now: float) -> None:
        """Take in what came until robot time `now` [s]."""
        robot, io = self._robot, self._io
        if robot.planner is None:
            self._load(now)
        states = io.latest(topics.JOINT_STATES)
        if states is not None:
            self._read_joints(states)
        robot.base = self._base(now)
        robot.source.update(io.latest(topics.WORLD_OBJECTS))

    @property
    def begun(self) -> bool:
        """The joints were told at least once."""
        return self._indices is not None

    @property
    def mjcf(self) -> str:
        """The robot's description, "" before it has come."""
        return self._description.mjcf if self._description is not None else ""

    def _load(self, now: float) -> None:
        description = self._io.latest(topics.ROBOT_DESCRIPTION)
        if description is not None and self._loading is None and description is not self._description:
            self._description = description
            self._loading = self._io.submit(Planner, description.mjcf, self._io.seed, seconds=LOADING)
        if self._loading is not None and self._loading.poll(now):
            loading, self._loading = self._loading, None
            try:
                self._robot.planner = loading.result()
            except (ValueError, KeyError) as error:
                self._io.count_drop(topics.ROBOT_DESCRIPTION.key, f"not a robot with our joints: {error}")

    def _read_joints(self, states: m.JointStates) -> None:
        if len(states.position) < len(states.name):
            return
        if self._indices is None or self._indices[0] != states.name:
            if not {*ARM, "gripper"} <= set(states.name):
                return
            order = {name: i for i, name in enumerate(states.name)}
            self._indices = states.name, [order[j] for j in ARM], order["gripper"]
        robot, (_, arm, gripper) = self._robot, self._indices
        robot.joints = np.array([states.position[i] for i in arm])
        effort = states.effort[gripper] if len(states.effort) > gripper else 0.0
        if len(states.effort) > max(arm):
            robot.torques = np.array([states.effort[i] for i in arm])
        robot.grip = Grip(states.position[gripper], effort)

    def _base(self, now: float) -> Pose2:
        pose = self._io.latest(topics.POSE)
        if pose is not None and self._io.age(topics.POSE, now) < self._config.state_timeout:
            return pose.x, pose.y, pose.theta
        odometry = self._io.latest(topics.ODOMETRY)
        return (odometry.x, odometry.y, odometry.theta) if odometry else self._robot.base
