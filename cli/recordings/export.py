"""`tidybot replay --export`: a mission cut out of a recording."""

from collections.abc import Iterator
from pathlib import Path

import msgspec

from cli.errors import CliError, near
from cli.recordings.copies import copy
from common import topics
from common.bus import codec
from common.recording import Recording, Row

BEFORE, AFTER = 2.0, 2.0
"""Seconds that are kept on either side of a mission."""


class Span(msgspec.Struct):
    """A mission's command, and the robot times [s] at which it begins and at which the state tells of another one."""

    command: str
    begin: float
    end: float


def missions(recording: Recording) -> dict[str, Span]:
    """The missions of a recording by id, oldest first; a resumed mission counts once."""
    found: dict[str, Span] = {}
    at = ""
    for row in recording.of(topics.BRAIN_STATE.key):
        if row.junk:
            continue
        state = codec.decode(topics.BRAIN_STATE, row.payload)
        if at and state.mission_id != at:
            found[at].end = row.t
        at = state.mission_id
        if at:
            span = found.setdefault(at, Span(state.command, state.started or row.t, row.t))
            span.command, span.end = state.command or span.command, row.t
    if at:
        found[at].end = recording.rows[-1].t
    return found


def chosen(recording: Recording, wanted: str) -> tuple[str, Span]:
    """One mission with its id: `wanted`, or "last".

    Raises:
        CliError: there is no such mission in the recording.
    """
    told = missions(recording)
    if not told:
        raise CliError(f"{recording.path}: there is no mission in it")
    name = [*told][-1] if wanted == "last" else wanted
    if name not in told:
        raise CliError(f"no mission {wanted!r}{near(wanted, told)}; the recording has {', '.join(told)}")
    return name, told[name]


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
        yield msgspec.structs.replace(row, t=begin)
    yield from (row for row in recording.rows if begin <= row.t <= end and not row.junk)


def export(path: Path, target: Path, wanted: str) -> None:
    """Write one mission as a recording of its own.

    Raises:
        CliError: no such mission, or the target is the recording itself.
        RecordingError: the recording cannot be read.
    """
    recording = Recording(path)
    name, span = chosen(recording, wanted)
    if target.resolve() == path.resolve():
        raise CliError(f"{target} is the recording itself")
    target.parent.mkdir(parents=True, exist_ok=True)
    copy(recording, target, cut(recording, span.begin - BEFORE, span.end + AFTER))
    print(f"{target}  mission {name} “{span.command}”  {target.stat().st_size / 1e6:.1f} MB")
