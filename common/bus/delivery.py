"""Publishers and subscribers with the delivery that the topic table declares, and single puts and gets.

Events and goals travel over advanced publishers (cache, miss detection) to advanced subscribers (history,
recovery), so a router outage loses none; streams keep the newest value only. Every latched key also answers a
plain `get`. Callbacks only enqueue: they run in Zenoh's receiving thread, one after the other in the order of arrival.
"""

import struct
from collections.abc import Callable
from typing import Any

import zenoh
from zenoh import ext, handlers

from common import messages as m
from common import topics
from common.bus import codec
from common.time.clock import unix_time
from common.topic import Topic

CACHE = 64
"""Messages that an advanced publisher keeps for recovery [count]; chosen: events come a few a second at most, so this
is more than an outage of 5 s holds up."""
HEARTBEAT = 0.25
"""Period of the sequence numbers by which a subscriber notices that the last message was lost [s]; chosen: short
against the 1 s that the brain settles after an answer."""
_TICK = struct.Struct("<q")


class Publisher:
    """Sends one topic with the delivery that the table declares; in lockstep streams lose nothing either."""

    def __init__(self, opened: zenoh.Session, topic: Topic[Any], lossless: bool = False) -> None:
        self._matching = opened.declare_publisher(topic.key)
        self.last: bytes | None = None
        encoding = codec.encoding_of(topic)
        self._out: Any
        if topic.keep == "latest":
            control = zenoh.CongestionControl.BLOCK if lossless else zenoh.CongestionControl.DROP
            self._out = opened.declare_publisher(topic.key, encoding=encoding, congestion_control=control)
        elif not topic.recover:
            self._out = opened.declare_publisher(
                topic.key, encoding=encoding, congestion_control=zenoh.CongestionControl.BLOCK, express=True
            )
        else:
            self._out = ext.declare_advanced_publisher(
                opened,
                topic.key,
                encoding=encoding,
                congestion_control=zenoh.CongestionControl.BLOCK,
                cache=ext.CacheConfig(CACHE),
                sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=HEARTBEAT),
                publisher_detection=True,
            )
        if topic.latched:
            self._queryable = opened.declare_queryable(topic.key, self._answer)
        self._key, self._encoding = topic.key, encoding

    def _answer(self, query: zenoh.Query) -> None:
        with query:
            if self.last is not None:
                query.reply(self._key, self.last, encoding=self._encoding)

    def put(self, payload: bytes, tick: int | None) -> None:
        self.last = payload
        self._out.put(payload, attachment=stamp(tick))

    @property
    def has_subscribers(self) -> bool:
        return bool(self._matching.matching_status.matching)  # type: ignore[attr-defined]


def fetch(opened: zenoh.Session, key: str, payload: bytes = b"", timeout: float = 2.0) -> dict[str, bytes]:
    """The answers to a `get` on a key expression, as key -> payload; empty when nobody answered."""
    answers: dict[str, bytes] = {}
    for reply in opened.get(key, payload=payload or None, timeout=timeout):
        if reply.ok is not None:
            answers[str(reply.ok.key_expr)] = reply.ok.payload.to_bytes()
    return answers


def send(opened: zenoh.Session, topic: Topic[Any], message: m.Message) -> None:
    """Publish one message, as any client does."""
    opened.put(topic.key, codec.encode(topic, message), encoding=codec.encoding_of(topic))


def subscribe(opened: zenoh.Session, topic: Topic[Any], receive: Callable[[zenoh.Sample], None]) -> Any:
    """A subscriber with the delivery that the table declares: streams as they come, events with what was missed."""
    if topic.keep == "latest" or not topic.recover:
        return listen(opened, topic.key, receive)
    return ext.declare_advanced_subscriber(
        opened,
        topic.key,
        _in_order(receive),
        history=ext.HistoryConfig(detect_late_publishers=True, max_samples=CACHE),
        recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
    )


def listen(opened: zenoh.Session, key: str, receive: Callable[[zenoh.Sample], None]) -> Any:
    """A plain subscriber to a key expression."""
    return opened.declare_subscriber(key, _in_order(receive))


def _in_order(receive: Callable[[zenoh.Sample], None]) -> Any:
    """Zenoh would give every subscriber a thread of its own: a tick could be seen before the data it follows."""
    return handlers.Callback(receive, indirect=False)


def watch_tokens(opened: zenoh.Session, changed: Callable[[str, bool], None]) -> Any:
    """A subscriber to the liveliness of services: `changed(name, alive)`, those already there first."""

    def receive(sample: zenoh.Sample) -> None:
        changed(str(sample.key_expr).split("/")[-2], sample.kind == zenoh.SampleKind.PUT)

    return opened.liveliness().declare_subscriber(topics.ALIVE_KEY.format(name="*"), _in_order(receive), history=True)


def stamp(tick: int | None) -> bytes | None:
    """The attachment that says in which lockstep tick a sample is published; `tick_of` reads it."""
    return None if tick is None else _TICK.pack(tick)


def tick_of(sample: zenoh.Sample) -> int | None:
    """The lockstep tick in which a sample was published, None where it carries none."""
    raw = sample.attachment.to_bytes() if sample.attachment is not None else b""
    return int(_TICK.unpack(raw)[0]) if len(raw) == _TICK.size else None


def sent_at(sample: zenoh.Sample) -> float:
    """Unix time of the sender's put."""
    return sample.timestamp.get_time().timestamp() if sample.timestamp is not None else unix_time()
