"""`joint_states` as the heartbeat of the simulation or the hardware: nothing starts without it, and its loss stops."""

from common import topics
from common.bus.port import Io

MISSED = 200
"""Messages in a row whose absence means loss: 2.0 s at the declared 100 Hz, the silence after which the watchdog calls
a process frozen. A loaded host and a publisher of 1 Hz stay below it; base and arm hold after 0.25 s by themselves."""
LIMIT = MISSED / topics.JOINT_STATES.rate
"""Age [s] from which on joint states are stale."""


class Heartbeat:
    """Freshness of `joint_states` [s]. `stalled`: wall time for which robot time itself has stood still."""

    def __init__(self, io: Io) -> None:
        self._io = io
        self.stalled = 0.0

    def fresh(self, now: float) -> bool:
        """True while joint states arrive."""
        return max(self._io.age(topics.JOINT_STATES, now), self.stalled) <= LIMIT

    @property
    def paused(self) -> bool:
        """The simulation says that it pauses: it is not lost."""
        status = self._io.latest(topics.SIM_STATUS)
        return status is not None and status.state == "paused"
