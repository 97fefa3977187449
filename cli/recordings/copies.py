"""Copies of recordings: a part of one, or what a torn one still holds."""

from collections.abc import Iterable
from pathlib import Path

from common.recording import Recorder, Recording, Row


def copy(source: Recording, target: Path, rows: Iterable[Row]) -> None:
    """Write rows of a recording, with its facts and files, into a file of their own.

    Raises:
        RecordingError: the file cannot be written.
    """
    writer = Recorder(target)
    try:
        for name, facts in source.facts.items():
            writer.note(name, facts)
        for name, data in source.files.items():
            writer.attach(name, data, 0.0)
        for row in rows:
            if row.key.endswith("/alive"):
                writer.presence(row.key.split("/")[1], b"true" in row.payload, row.t, row.wall)
            else:
                writer.write(row.key, row.payload, row.t, row.wall, row.tick)
    finally:
        writer.close()


def repair(source: Path, target: Path) -> int:
    """Copy what a torn file still holds into a whole one; the number of messages."""
    torn = Recording(source)
    copy(torn, target, torn.rows)
    return len(torn.rows)
