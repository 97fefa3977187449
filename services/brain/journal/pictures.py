"""Pictures that missions rest on, as files beside the journal; the newest only."""

import contextlib
import re
from collections.abc import Callable
from pathlib import Path

from common.files import atomic_file

KEPT = 200
"""Files: at some 10 KB each 2 MB, a day of missions."""
LARGEST = 100_000
"""Bytes: ten times what perception sends; a larger one is not kept."""
START = b"\xff\xd8\xff"
"""What a JPEG begins with."""
_NAME = re.compile(r"[A-Za-z0-9._-]{1,80}\.jpg")


class Pictures:
    """The folder `directory`; None: nothing is kept."""

    def __init__(self, directory: Path | None, report: Callable[[str], None]) -> None:
        self._directory, self._report = directory, report

    def keep(self, mission_id: str, jpeg: bytes) -> str:
        """Write a picture; its name, "" when it was not kept."""
        if self._directory is None or not jpeg.startswith(START) or len(jpeg) > LARGEST:
            return ""
        try:
            self._directory.mkdir(parents=True, exist_ok=True)
            numbers = [int(p.name.partition("-")[0]) for p in self._directory.glob("*.jpg") if p.name[0].isdigit()]
            number = max(numbers, default=0) + 1
            name = f"{number:06d}-{re.sub(r'[^A-Za-z0-9._-]', '_', mission_id)[:60]}.jpg"
            why = atomic_file.replace(self._directory / name, jpeg)
            for old in sorted(self._directory.glob("*.jpg"))[:-KEPT]:
                old.unlink(missing_ok=True)
        except (OSError, ValueError) as error:
            why = str(error)
        if why:
            self._report(why)
            return ""
        return name

    def load(self, name: str) -> bytes | None:
        """A picture by the name that `keep` gave it."""
        if self._directory is None or not _NAME.fullmatch(name):
            return None
        with contextlib.suppress(OSError):
            return (self._directory / name).read_bytes()
        return None
