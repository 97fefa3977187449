"""Interpolation of odometry at the time of a scan or picture."""

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
    """Keeps the last seconds of odometry; `turning` is the newest rate of turn [rad/s]."""

    def __init__(self) -> None:
        self._rows: deque[tuple[float, Pose2]] = deque(maxlen=HISTORY)
        self.turning = 0.0

    def take(self, messages: Iterable[m.Odometry]) -> None:
        """Add samples; when the clock has gone back, older ones are dropped."""
        for o in messages:
            if not all(abs(v) <= MAX_VALUE for v in (o.t, o.x, o.y, o.theta, o.omega)):
                continue
            if self._rows and o.t < self._rows[-1][0]:
                self._rows.clear()
            self._rows.append((o.t, (o.x, o.y, o.theta)))
            self.turning = o.omega

    @property
    def newest(self) -> Pose2 | None:
        """The newest pose [odom]; None before the first sample."""
        return self._rows[-1][1] if self._rows else None

    def at(self, t: float) -> Pose2 | None:
        """The pose [odom] at time `t` [s], interpolated; None when the samples do not reach so far back."""
        if not self._rows or t < self._rows[0][0] - STALE:
            return None
        return pose_at(self._rows, t)
