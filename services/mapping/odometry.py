"""The wheels' pose at a stamp."""

from collections import deque
from collections.abc import Iterable

from common import messages as m
from common.geometry import Pose2, pose_at

MAX_VALUE = 1e6
"""What no odometry reports [s, m, rad, rad/s]: a fault of its sender."""
HISTORY = 300
"""Samples that are kept [count]: 3 s at 100 Hz."""
STALE = 0.5
"""Age [s] of the oldest sample before a stamp that still says where the base was."""


class OdometryBuffer:
    """The last seconds of `base/odom`; `turning` is how fast the base turns now [rad/s]."""

    def __init__(self) -> None:
        self._rows: deque[tuple[float, Pose2]] = deque(maxlen=HISTORY)
        self.turning = 0.0

    def take(self, messages: Iterable[m.Odometry]) -> None:
        """Keep new samples; those of a clock that went back begin anew."""
        for o in messages:
            if not all(abs(v) <= MAX_VALUE for v in (o.t, o.x, o.y, o.theta, o.omega)):
                continue
            if self._rows and o.t < self._rows[-1][0]:
                self._rows.clear()
            self._rows.append((o.t, (o.x, o.y, o.theta)))
            self.turning = o.omega

    @property
    def newest(self) -> Pose2 | None:
        """Where the wheels say that the base is; None before the first sample."""
        return self._rows[-1][1] if self._rows else None

    def at(self, t: float) -> Pose2 | None:
        """Between the two samples around `t` [s]; None when they do not reach so far back."""
        if not self._rows or t < self._rows[0][0] - STALE:
            return None
        return pose_at(self._rows, t)
