"""Reports of faults that took effect, by the injectors."""

from collections.abc import Callable
from pathlib import Path

import msgspec


class FaultReport(msgspec.Struct, frozen=True):
    """A fault took effect at robot time `t` [s]; `what` is what was seen of it."""

    t: float
    fault: str
    what: str


Reporter = Callable[[FaultReport], None]


def ignore(report: FaultReport) -> None:
    """Drop a report, in runs that do not collect them."""


class FaultReportFile:
    """A file of reports from several processes to one reader: a JSON record a line, appended in one write."""

    def __init__(self, path: Path) -> None:
        self._path, self._read = path, 0

    def report(self, report: FaultReport) -> None:
        with self._path.open("ab", buffering=0) as file:
            file.write(msgspec.json.encode(report) + b"\n")

    def news(self) -> list[FaultReport]:
        """The complete records since the last call."""
        try:
            size = self._path.stat().st_size
        except OSError:
            return []
        if size <= self._read:
            return []
        with self._path.open("rb") as file:
            file.seek(self._read)
            lines, _, _ = file.read().rpartition(b"\n")
        self._read += len(lines) + 1 if lines else 0
        return [msgspec.json.decode(line, type=FaultReport) for line in lines.splitlines()]
