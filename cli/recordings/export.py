"""`tidybot replay --export`: a mission cut out of a recording, or its timeline with pictures."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from cli.errors import CliError, near
from cli.recordings.copies import copy
from common import topics
from common.mission_log.recorded import missions
from common.recording import Recording, Row

BEFORE, AFTER = 2.0, 2.0
"""Seconds that are kept on either side of a mission."""
PAGES = (".html", ".htm")


def mission_of(recording: Recording, wanted: str) -> dict[str, Any]:
    """The record of one mission: its id, or "last".

    Raises:
        CliError: there is no such mission in the recording.
    """
    told = missions(recording.rows)
    if not told:
        raise CliError(f"{recording.path}: there is no mission in it")
    found = next((record for record in told if record["id"] == wanted), None)
    if wanted == "last":
        found = told[-1]
    if found is None:
        known = [str(record["id"]) for record in told]
        raise CliError(f"no mission {wanted!r}{near(wanted, known)}; the recording has {', '.join(known)}")
    return found


def span_of(record: dict[str, Any]) -> tuple[float, float]:
    """Robot time from shortly before the mission to shortly after."""
    return float(record["started"]) - BEFORE, float(record["until"]) + AFTER


def cut(recording: Recording, begin: float, end: float) -> Iterator[Row]:
    """The rows from `begin` to `end`, after what was known then: the newest value of each topic, as of `begin`."""
    known: dict[str, Row] = {}
    for row in recording.rows:
        topic = topics.BY_KEY.get(row.key)
        if row.t >= begin or row.junk:
            continue
        if (topic is not None and topic.latched and not topic.command) or row.key.startswith("service/"):
            known[row.key] = row
    for row in sorted(known.values(), key=lambda r: r.t):
        yield Row(key=row.key, payload=row.payload, t=begin, wall=row.wall, tick=row.tick)
    yield from (row for row in recording.rows if begin <= row.t <= end)


def export(path: Path, target: Path, wanted: str) -> None:
    """Write one mission as what the name of `target` says.

    Raises:
        CliError: an unknown kind of file, no such mission.
        RecordingError: the recording cannot be read.
    """
    kinds = (".mcap", *PAGES)
    if target.suffix not in kinds:
        raise CliError(f"{target}: what kind of file? It may end in {', '.join(kinds)}")
    recording = Recording(path)
    record = mission_of(recording, wanted)
    begin, end = span_of(record)
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.suffix in PAGES:
        # The renderer and the templates are not for every command to load.
        from cli.recordings.key_frames import key_frames
        from common.mission_log.timeline import page

        seen = key_frames(recording, record) if recording.of(topics.SIM_STATE.key) else []
        target.write_text(page(record, seen), encoding="utf-8")
    else:
        _write(recording, target, begin, end)
    print(f"{target}  mission {record['id']} “{record['command']}”  {target.stat().st_size / 1e6:.1f} MB")


def _write(recording: Recording, target: Path, begin: float, end: float) -> None:
    if target.resolve() == recording.path.resolve():
        raise CliError(f"{target} is the recording itself")
    copy(recording, target, (row for row in cut(recording, begin, end) if not row.junk))
