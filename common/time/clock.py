"""Clocks. The only reader of the operating system's clock."""

import time
from typing import Protocol


class Clock(Protocol):
    def now(self) -> float:
        """Robot time [s]."""


class WallClock:
    """Unix time that never steps back: read once, then advanced by the monotonic clock."""

    def __init__(self) -> None:
        self._offset = time.time() - time.monotonic()

    def now(self) -> float:
        return time.monotonic() + self._offset


class ManualClock:
    """A clock that a test sets."""

    def __init__(self, start: float = 0.0) -> None:
        self._now = start

    def now(self) -> float:
        return self._now

    def advance(self, seconds: float) -> float:
        self._now += seconds
        return self._now


class SimClock:
    """Follows `sim/clock`."""

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        return self._now

    def set(self, now: float) -> None:
        self._now = now


class Pacer:
    """Releases ticks at `speed` times real time; after a stall it resumes the pace instead of racing."""

    MAX_LAG = 0.25
    """Lateness [s] from which time is let go instead of being caught up with; chosen: 25 ticks."""

    def __init__(self, dt: float, speed: float) -> None:
        self._period = dt / speed
        self._due = time.monotonic()

    def wait(self) -> None:
        self._due += self._period
        late = time.monotonic() - self._due
        if late < 0:
            time.sleep(-late)
        elif late > self.MAX_LAG:
            self._due += late


def monotonic() -> float:
    """Seconds on the host's steady clock, for supervision and wall-clock limits."""
    return time.monotonic()


def unix_time() -> float:
    """Seconds since 1970 on the host's clock."""
    return time.time()


def sleep(seconds: float) -> None:
    """Let the host rest; for tools and loops, never for services."""
    time.sleep(seconds)
