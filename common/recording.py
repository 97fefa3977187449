"""Recordings of the bus as MCAP files: JSON channels with schemas, bulk as MessagePack, readable when torn.

`log_time` is robot time, `publish_time` the sender's wall clock [ns]. `sequence` is the lockstep tick of
publication plus one, 0 for a message that carries none. https://mcap.dev/spec
"""

import struct
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Any

import msgspec
from mcap.exceptions import McapError
from mcap.records import Attachment, Channel, Chunk, Message, Metadata, Schema, Statistics
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import CompressionType, Writer
from zstandard import ZstdError

from common import messages as m
from common import topics
from common.bus import codec
from common.schemas import schema_of

PROFILE = "tidybot"
MCAP0_MAGIC = b"\x89MCAP0\r\n"
CHUNK = 512 * 1024
"""Size from which a chunk is compressed and written [bytes]; chosen: what a crash loses at most."""
BULK = {t.key for t in topics.TABLE if t.bulk}
RAW = "#undecodable"
ALIVE_SCHEMA = b'{"title":"Alive","type":"object","properties":{"alive":{"type":"boolean"}}}'
NANO = 1_000_000_000
"""Nanoseconds in a second."""
_TORN = (EOFError, struct.error, zlib.error, ZstdError, McapError, ValueError, MemoryError)


class RecordingError(ValueError):
    """A file that is no recording, or cannot be written."""


class Row(msgspec.Struct, frozen=True):
    """One recorded message; `t` robot time [s], `wall` Unix time [s], `tick` of publication or None.

    `payload` is JSON, except on the bulk topics. `junk`: it was no message of its topic.
    """

    key: str
    payload: bytes
    t: float
    wall: float
    tick: int | None = None
    junk: bool = False


class Recorder:
    """Writes one file. Messages may come in any order of time; `close` makes the index, without it the file is torn."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.counts: dict[str, int] = {}
        self.first, self.last = float("inf"), 0.0
        self._channels: dict[str, int] = {}
        self._file: IO[bytes] = _opened(path, "wb")
        make: Any = Writer  # parts of mcap carry no types
        self._writer = make(self._file, chunk_size=CHUNK, compression=CompressionType.ZSTD)
        self._writer.start(profile=PROFILE, library="tidybot")
        self._writer.flush()

    @property
    def size(self) -> int:
        return self._file.tell()

    def write(self, key: str, payload: bytes, t: float, wall: float, tick: int | None = None) -> None:
        """One message as it came over the bus; what is no message of its topic goes to a channel of its own."""
        name, data = key, payload
        kind = topics.type_of(key)
        if key not in BULK:
            try:
                if kind is None:
                    raise codec.DecodeError("no topic of the table")
                topic = topics.BY_KEY.get(key)
                data = msgspec.json.encode(codec.decode_as(kind, payload, topic.text if topic else ""))
            except (codec.DecodeError, UnicodeEncodeError):
                name = key + RAW
        channel = self._channels.get(name)
        if channel is None:
            channel = self._channels[name] = self._register(name, key, kind)
        self._add(name, channel, data, t, wall, tick)

    def presence(self, name: str, alive: bool, t: float, wall: float) -> None:
        """A service's liveliness token came or went."""
        key = topics.ALIVE_KEY.format(name=name)
        channel = self._channels.get(key)
        if channel is None:
            schema = self._writer.register_schema("tidybot.Alive", "jsonschema", ALIVE_SCHEMA)
            channel = self._channels[key] = self._writer.register_channel(key, "json", schema)
        self._add(key, channel, msgspec.json.encode({"alive": alive}), t, wall, None)

    def _add(self, name: str, channel: int, data: bytes, t: float, wall: float, tick: int | None) -> None:
        self._writer.add_message(
            channel,
            log_time=max(0, round(t * NANO)),
            data=data,
            publish_time=round(wall * NANO),
            sequence=0 if tick is None else max(0, tick) + 1,
        )
        self.counts[name] = self.counts.get(name, 0) + 1
        self.first, self.last = min(self.first, t), max(self.last, t)

    def _register(self, name: str, key: str, kind: type[m.Message] | None) -> int:
        topic = topics.BY_KEY.get(key)
        about = {"type": kind.__name__ if kind else ""}
        if topic is not None:
            about |= {"writers": ",".join(topic.writers), "rate": f"{topic.rate:g}", "keep": topic.keep}
            about["wire"] = codec.encoding_of(topic)
        if name != key or kind is None:
            return int(self._writer.register_channel(name, "", 0, about))
        if key in BULK:
            fields = msgspec.json.encode(kind.__struct_fields__).decode()
            return int(self._writer.register_channel(name, "msgpack", 0, {**about, "fields": fields}))
        schema = self._writer.register_schema(f"tidybot.{kind.__name__}", "jsonschema", schema_of(kind))
        return int(self._writer.register_channel(name, "json", schema, about))

    def note(self, name: str, facts: dict[str, str]) -> None:
        """Facts about the run, as MCAP metadata."""
        self._writer.flush()
        self._writer.add_metadata(name, facts)

    def attach(self, name: str, data: bytes, wall: float) -> None:
        """A whole file, for example the household."""
        self._writer.flush()
        self._writer.add_attachment(round(wall * NANO), max(0, round(self.last * NANO)), name, "application/toml", data)

    def flush(self) -> None:
        """What was written so far survives the end of this process."""
        self._writer.flush()

    def close(self) -> None:
        """End the file with its index."""
        try:
            self._writer.finish()
        finally:
            self._file.close()


class Span(msgspec.Struct):
    """What a file holds of one key."""

    count: int = 0
    size: int = 0
    first: float = float("inf")
    last: float = float("-inf")


class Recording:
    """A file read back: messages by time, facts, attachments. `torn` says why the file ends early, "" when whole."""

    def __init__(self, path: Path, wanted: Callable[[str], bool] = lambda key: True) -> None:
        self.path = path
        self.torn = ""
        self.facts: dict[str, dict[str, str]] = {}
        self.files: dict[str, bytes] = {}
        self.rows: list[Row] = []
        self.spans: dict[str, Span] = {}
        self._wanted = wanted
        self._channels: dict[int, Channel] = {}
        with _opened(path, "rb") as file:
            if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
                raise RecordingError(f"{path}: not an MCAP file")
            self._read(file)
        self.rows.sort(key=lambda row: row.t)  # stable: equal times stay in the order of arrival

    def _read(self, file: IO[bytes]) -> None:
        file.seek(0)
        try:
            for record in _records(file):
                self._take(record)
            if self._promised != (found := self._found()):
                self.torn = f"{found} of {self._promised} messages"
        except _TORN as error:
            self.torn = f"{type(error).__name__} after {self._found()} messages"

    _promised = -1

    def _found(self) -> int:
        return sum(span.count for span in self.spans.values())

    def _take(self, record: Any) -> None:
        if isinstance(record, Message):
            self._message(self._channels[record.channel_id].topic, record)
        elif isinstance(record, Channel):
            self._channels[record.id] = record
        elif isinstance(record, Metadata):
            self.facts[record.name] = record.metadata
        elif isinstance(record, Statistics):
            self._promised = record.message_count
        elif isinstance(record, Attachment):
            self.files[record.name] = record.data

    def _message(self, name: str, record: Message) -> None:
        t = record.log_time / NANO
        span = self.spans.setdefault(name, Span())
        span.count, span.size = span.count + 1, span.size + len(record.data)
        span.first, span.last = min(span.first, t), max(span.last, t)
        key, mark, _ = name.partition(RAW)
        if self._wanted(key):
            tick = record.sequence - 1 if record.sequence else None
            row = Row(key=key, payload=record.data, t=t, wall=record.publish_time / NANO, tick=tick, junk=bool(mark))
            self.rows.append(row)

    def of(self, key: str) -> list[Row]:
        """The messages of one key."""
        return [row for row in self.rows if row.key == key]


def _records(file: IO[bytes]) -> Iterator[Any]:
    """Records in file order, chunks opened and checked; the reader itself checks the magic at the end."""
    for record in StreamReader(file, emit_chunks=True, record_size_limit=2**30).records:
        if isinstance(record, Chunk):
            yield from breakup_chunk(record, validate_crc=True)
        elif not isinstance(record, Schema):
            yield record


def _opened(path: Path, mode: str) -> IO[bytes]:
    try:
        return path.open(mode)
    except OSError as error:
        raise RecordingError(f"{path}: {error.strerror}") from None
