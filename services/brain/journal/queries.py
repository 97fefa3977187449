"""Answers what people's tools ask about missions (`brain/missions`)."""

import msgspec

from services.brain.journal.pictures import Pictures
from services.brain.journal.records import Journal


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
