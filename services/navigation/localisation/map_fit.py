"""A measure of how well the map still fits the home."""

import math

from common.geometry import Pose2

EVERY = 0.25
"""Way between two scans that count [m]: one that stands sees the same again and again."""
GAIN = 0.04
"""Share of a scan [-]: the last 6 m count most, a room and the way to the next."""


class MapFit:
    """`share` [0 to 1] of what the lidar has seen lately that the map, with its lasting changes, explains."""

    def __init__(self) -> None:
        self.share = 1.0
        self._at: Pose2 | None = None

    def see(self, pose: Pose2, explained: float) -> None:
        """Take a scan from `pose` [map] of which the map explains the given share of points."""
        if self._at is None or math.dist(self._at[:2], pose[:2]) >= EVERY:
            self._at = pose
            self.share += GAIN * (explained - self.share)
