"""The target poses of one goal: their ids, and which of them the base has reached."""

from common import messages as m
from common.geometry import Pose2
from services.navigation.ended import Ended


class Targets:
    """Makes the target poses of a goal: the goal itself has the id `name`, poses on the way `name#1`, `name#2`, ...

    `start` is where the goal was begun [map], None before. A base may report no motion, or have no odometry: then what
    it says that it has reached is where it is.
    """

    def __init__(self, name: str) -> None:
        self._name, self._count = name, 0
        self._sent: Pose2 | None = None
        self._assumed: Pose2 | None = None
        self.start: Pose2 | None = None

    def where(self, pose: Pose2 | None, reached: list[m.GoalReached]) -> Pose2 | None:
        """The base's pose: `pose` by odometry, or the target that the base has reached while odometry shows no motion.

        The base's word may be there before the odometry of the same motion: from the first motion on that is believed.

        Raises:
            Ended: arrived.
        """
        for answer in reached:
            if answer.reached and answer.target_id == self._name:
                raise Ended("arrived")
            still = pose is None or pose == self.start
            if answer.reached and answer.target_id == self._newest and still and self._sent is not None:
                self._assumed = self._sent
        if pose is not None and self.start is not None and pose != self.start:
            self._assumed = None
        return self._assumed or pose

    @property
    def _newest(self) -> str:
        return f"{self._name}#{self._count}"

    def goal(self, pose: Pose2) -> m.BaseTarget:
        """The target for the goal itself."""
        return m.BaseTarget(x=pose[0], y=pose[1], theta=pose[2], id=self._name)

    def next(self, pose: Pose2) -> m.BaseTarget:
        """A target for another pose on the way."""
        self._count += 1
        return m.BaseTarget(x=pose[0], y=pose[1], theta=pose[2], id=self._newest)

    def ahead(self, pose: Pose2, final: bool) -> m.BaseTarget:
        """The target for a pose on the path; `final`: it is the path's end."""
        self._sent = pose
        target = self.next(pose)
        return self.goal(pose) if final else target

    def aside(self, pose: Pose2) -> m.BaseTarget:
        """The target for a pose off the path; that the base reports it as reached is no evidence of where it is."""
        self._sent = None
        return self.next(pose)
