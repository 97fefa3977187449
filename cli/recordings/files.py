"""The files of one recording: one that grows, or the newest of several so that the disk does not fill."""

from collections import deque
from collections.abc import Callable
from pathlib import Path

from common.recording import Recorder

PARTS = 8
"""Files that share the space of a recording that keeps its newest part only; chosen: an eighth goes at a time."""


class RecordingFiles:
    """`recorder` writes the file at work. With `keep` [bytes], not 0, files `NAME.001.mcap` and so on are begun, and
    the oldest is deleted, so that all of them together stay below it."""

    def __init__(self, path: Path, keep: int = 0) -> None:
        self._path, self._keep, self._number = path, keep, 0
        self._written: deque[Path] = deque()
        self.recorder = self._begin()

    @property
    def full(self) -> bool:
        """The file at work has its share of the space."""
        return bool(self._keep) and self.recorder.size >= self._keep / PARTS

    def turn_over(self, finish: Callable[[Recorder], None]) -> Recorder:
        """Finish the file at work, begin another and delete what is too old.

        Raises:
            OSError: the disk refuses.
        """
        finish(self.recorder)
        self.recorder.close()
        while len(self._written) >= PARTS:
            self._written.popleft().unlink(missing_ok=True)
        self.recorder = self._begin()
        return self.recorder

    def _begin(self) -> Recorder:
        self._number += 1
        path = self._path
        if self._keep:
            path = path.with_name(f"{path.stem}.{self._number:03d}{path.suffix or '.mcap'}")
        self._written.append(path)
        return Recorder(path)
