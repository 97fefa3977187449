"""Pictures that missions rest on, as files beside the journal; the newest only."""

import contextlib
import re
from collections.abc import Callable
from pathlib import Path

import msgspec

from common.files import atomic_file
from services.brain.journal.records import Journal

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


# --- answers what people's tools ask about missions (`brain/missions`)
class MissionQueries:
    """The missions of a journal, and the pictures that they rest on."""

    def __init__(self, journal: Journal, pictures: Pictures) -> None:
        self._journal, self._pictures = journal, pictures

    def answer(self, payload: bytes) -> bytes:
        """All missions, the timeline of the one whose id is asked for, or a picture of it by name (base64), as JSON."""
        wanted = payload.decode().strip()
        if wanted.startswith("{"):
            asked = msgspec.json.decode(payload)
            if picture := asked.get("picture"):
                return msgspec.json.encode(self._pictures.load(str(picture)))
            wanted = str(asked.get("id", ""))
        missions = self._journal.missions()
        if wanted == "last":
            wanted = missions[-1].id if missions else wanted
        if wanted:
            return msgspec.json.encode(self._journal.mission(wanted))
        rows = [{k: v for k, v in msgspec.to_builtins(record).items() if k != "entries"} for record in missions]
        return msgspec.json.encode(rows)
