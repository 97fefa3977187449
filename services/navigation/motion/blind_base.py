"""A base whose odometry does not move, or that has none."""

from common.geometry import Pose2


class BlindBase:
    """A base that reports no motion: what it says that it has reached is where it is."""

    def __init__(self) -> None:
        self.sent: Pose2 | None = None
        self.start: Pose2 | None = None
        self.assumed: Pose2 | None = None

    def reached(self, pose: Pose2 | None) -> None:
        """The base reports that it is where it was sent; believed while odometry shows no motion."""
        still = pose is None or pose == self.start
        if still and self.sent is not None:
            self.assumed = self.sent
