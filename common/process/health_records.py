"""Table of the services' states from their health records, for viewers."""

from collections.abc import Callable
from dataclasses import dataclass

from common import messages as m


@dataclass(frozen=True)
class ServiceRow:
    """One row of the table: a service's state, restarts and load."""

    name: str
    alive: bool
    restarts: int
    hz: float
    rss_mb: float
    drops: int
    uptime: float
    error: str


class HealthRecords:
    """Keeps the newest health record of each service; another epoch of the same name is a restart."""

    def __init__(self) -> None:
        self._last: dict[str, m.Health] = {}
        self._restarts: dict[str, int] = {}

    def take(self, health: m.Health) -> None:
        """Note a health record."""
        before = self._last.get(health.name)
        if before is not None and before.epoch != health.epoch:
            self._restarts[health.name] = self._restarts.get(health.name, 0) + 1
        self._last[health.name] = health

    def rows(self, alive: Callable[[str], bool]) -> list[ServiceRow]:
        """One row for every service ever heard of, by name."""
        return [
            ServiceRow(
                h.name, alive(h.name), self._restarts.get(h.name, 0), h.hz, h.rss_mb, h.drops, h.uptime, h.last_error
            )
            for h in sorted(self._last.values(), key=lambda one: one.name)
        ]
