"""The robot's coordinate frames over time, from its own messages, for gateways to tools that draw it."""

from collections.abc import Callable
from math import inf
from typing import Generic, TypeVar

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.gateway import due
from common.robot.frames import BaseFrames, FramePose
from common.robot.link_frames import LinkFrames

D = TypeVar("D")


class MovingFrames(Generic[D]):
    """Frames of base and links by the newest messages; `read`: what else the gateway computes from the robot's MJCF.

    A description is read in the worker. One that `read` refuses (ValueError, KeyError) is counted.
    """

    def __init__(self, io: Io, read: Callable[[str], D]) -> None:
        self._io, self._read = io, read
        self._base = BaseFrames()
        self._links: LinkFrames | None = None
        self._joints: m.JointStates | None = None
        self._mjcf = ""
        self._reading: Job[tuple[LinkFrames, D]] | None = None
        self._told = -inf

    def take(self, message: m.Message) -> None:
        """Take a message; those without the robot's pose, joints or description are ignored."""
        if isinstance(message, m.Odometry):
            self._base.odometry(message)
        elif isinstance(message, m.PoseEstimate):
            self._base.estimate(message)
        elif isinstance(message, m.JointStates):
            self._joints = message
        elif isinstance(message, m.RobotDescription) and message.mjcf != self._mjcf:
            self._mjcf = message.mjcf
            self._reading = self._io.submit(self._described, message.mjcf)

    def _described(self, mjcf: str) -> tuple[LinkFrames, D]:
        return LinkFrames(mjcf), self._read(mjcf)

    def described(self, now: float) -> D | None:
        """The result of `read` for a new description, once; None while there is none."""
        if self._reading is None or not self._reading.poll(now):
            return None
        job, self._reading = self._reading, None
        try:
            self._links, found = job.result()
        except (ValueError, KeyError) as error:
            self._io.count_drop(topics.ROBOT_DESCRIPTION.key, str(error))
            return None
        return found

    def poses(self, now: float, rate: float) -> list[FramePose]:
        """The moving frames, when they are due at `rate` [Hz]; empty in between and before the first odometry."""
        if not due(rate, now - self._told):
            return []
        self._told = now
        links = self._links.poses(self._joints) if self._links is not None and self._joints is not None else []
        return self._base.poses() + links
