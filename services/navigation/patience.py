"""How long a way has been blocked; the time in which somebody may just be passing is not counted. Pure."""

import math
from collections.abc import Sequence

from services.navigation.movers import Mover
from services.navigation.planner import Point

NEAR = 3.0
"""Whoever moves within this of the robot may be who blocks the way [m]: as far as `avoid` looks."""
PASSING = 20.0
"""Time that a goal waits for those who pass before its waiting counts again [s]: several times what a person needs
to clear a door, and less than the margin of a goal's time limit, so that somebody who stays is reported as BLOCKED."""


class Patience:
    """Of one goal."""

    def __init__(self) -> None:
        self._since: float | None = None
        self._at = 0.0
        self._left = PASSING

    def blocked(self, here: Point, movers: Sequence[Mover], now: float) -> float:
        """Once a step while the way is blocked: for how long it has been [s]."""
        if self._since is None:
            self._since = self._at = now
        elif self._left > 0.0 and any(math.dist((m.x, m.y), here) < NEAR + m.radius for m in movers):
            self._left -= now - self._at
            self._since += now - self._at
        self._at = now
        return now - self._since

    def clear(self) -> None:
        """The way is free, or another one is tried."""
        self._since = None
