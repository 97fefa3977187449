"""A base whose odometry does not move, or that has none."""

from common.geometry import Pose2


class BlindBase:
    """A base that reports no motion: what it says that it has reached is where it is."""

    def __init__(self) -> None:
        self.sent: Pose2 | None = None
        self.start: Pose2 | None = None
        self._assumed: Pose2 | None = None

    def where(self, pose: Pose2 | None) -> Pose2 | None:
        """`pose` by odometry, or where the base says it is while odometry shows no motion.

        The base's word may be there before the odometry of the same motion: from the first motion on that is believed.
        """
        if pose is not None and self.start is not None and pose != self.start:
            self._assumed = None
        return self._assumed or pose

    def reached(self, pose: Pose2 | None) -> None:
        """The base reports that it is where it was sent; believed while odometry shows no motion."""
        still = pose is None or pose == self.start
        if still and self.sent is not None:
            self._assumed = self.sent
