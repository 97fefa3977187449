"""Zenoh: sessions, and `ZenohIo`, the `Io` of a process of its own.

Events and goals travel over advanced publishers (cache, miss detection) to advanced subscribers (history,
recovery), so a router outage loses none; streams keep the newest value only. Every latched key also answers a
plain `get`. Callbacks only enqueue: they run in Zenoh's receiving thread, one after the other in the order of arrival.
"""

import queue
import struct
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from concurrent.futures import wait as futures_wait
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

import msgspec
import zenoh
from zenoh import ext, handlers

from common import codec, keys, probe, topics
from common import messages as m
from common.access import OPERATOR
from common.clock import Clock, monotonic, unix_time
from common.io import Handler
from common.iobase import CAPACITY, UNSTAMPED, IoBase, Mailbox, WorkerJob
from common.scene import Scene
from common.topics import Topic

if TYPE_CHECKING:
    from common.certificate import Identity

CONFIGS = Path(__file__).resolve().parent.parent / "config" / "zenoh"
DEFAULT_CONNECT = "tcp/127.0.0.1:7447"
DEFAULT_SECURE = "tls/127.0.0.1:7447"
CACHE = 64
HEARTBEAT = 0.25
PROBE_AFTER, PROBE_PERIOD = 2.0, 30.0
_TICK = struct.Struct("<q")
_BAD_REQUEST = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError, OSError)


class BusError(ValueError):
    """An endpoint, namespace or Zenoh configuration that cannot be used."""


class NoRouter(BusError):
    """Nobody listens at the endpoints."""


def default_connect() -> str:
    """The router of this machine: over TLS when there are keys.

    Raises:
        BusError: TIDYBOT_KEYS names nothing.
    """
    try:
        return DEFAULT_SECURE if keys.directory() else DEFAULT_CONNECT
    except keys.KeysError as error:
        raise BusError(str(error)) from None


def identity_for(connect: str, name: str, namespace: str) -> "Identity | None":
    """The certificate to show at these endpoints, None for plain ones.

    Raises:
        BusError: keys that cannot be used, or plain endpoints although there are keys.
    """
    secure = [e.startswith("tls/") for e in endpoints(connect)]
    try:
        found = keys.directory()
        if found is None and any(secure):
            raise BusError(f"{connect} needs certificates: `tidybot keys` makes them, TIDYBOT_KEYS says where they are")
        if found is None:
            return None
        if not all(secure):
            raise BusError(
                f"{connect}: there are keys in {found}, so only tls/ endpoints are used (TIDYBOT_KEYS=off: none)"
            )
        from common.certificate import Identity

        return Identity(keys.folder(found, name, namespace), name, namespace)
    except keys.KeysError as error:
        raise BusError(str(error)) from None


def endpoints(connect: str) -> list[str]:
    return [e.strip() for e in connect.split(",") if e.strip()]


def client_config(
    connect: str, namespace: str = "", directory: Path = CONFIGS, shown: "Identity | None" = None
) -> zenoh.Config:
    """A client of the comma-separated router endpoints; with a certificate `shown` it speaks TLS only.

    Raises:
        BusError: a bad endpoint or namespace.
    """
    try:
        config = zenoh.Config.from_file(str(directory / "client.json5"))
        config.insert_json5("connect/endpoints", _json(endpoints(connect)))
        if shown is not None:
            config.insert_json5("transport/link/protocols", _json(["tls"]))
            config.insert_json5("transport/link/tls", _json(shown.settings(serving=False)))
        if namespace:
            config.insert_json5("namespace", _json(namespace))
    except zenoh.ZError as error:
        raise BusError(f"zenoh configuration for {connect!r}, namespace {namespace!r}: {error}") from None
    return config


@contextmanager
def session(
    connect: str,
    namespace: str = "",
    wait: Callable[[float], bool] | None = None,
    patience: float = 3.0,
    name: str = OPERATOR,
) -> Iterator[zenoh.Session]:
    """An open session that is closed whatever happens: an open one keeps the process from ending.

    Zenoh blocks until the first connection, deaf to signals, so it opens in a thread of its own. A node passes
    `wait(seconds) -> stop?` and waits for its router as long as that is False; a tool waits `patience` seconds.
    With keys the session shows the certificate of `name`.

    Raises:
        BusError: a bad endpoint or certificate, or no router in time.
        NoRouter: `wait` said stop before a router was there.
    """
    opening: Future[zenoh.Session] = Future()
    shown = identity_for(connect, name, namespace)
    config = client_config(connect, namespace, shown=shown)
    Thread(target=_open, args=(config, opening), name="zenoh-open", daemon=True).start()
    began = monotonic()
    asked = began + PROBE_AFTER
    while not opening.done():
        if wait is None and monotonic() > began + patience:
            raise NoRouter(
                _trouble(connect, shown) or f"nothing answers at {connect}; start the robot with `tidybot up`"
            )
        if monotonic() > asked:
            asked = monotonic() + PROBE_PERIOD
            why = _trouble(connect, shown)
            if why and wait is None:
                raise BusError(why)
            why = why or f"waiting for a router at {connect}; `python -m services.router` starts one"
            print(f"{name}: {why}", file=sys.stderr, flush=True)
        if wait is None:
            futures_wait([opening], 0.05)
        elif wait(0.05):
            raise NoRouter("stopped before a router was there")
    try:
        opened = opening.result()
    except zenoh.ZError as error:
        raise BusError(f"cannot connect to {connect}: {error}") from None
    with opened:
        yield opened


def _trouble(connect: str, shown: "Identity | None") -> str:
    """Why no router takes us, "" when none is there."""
    found = (probe.trouble(endpoint, shown) for endpoint in endpoints(connect))
    return next((why for why in found if why), "")


def fetch(opened: zenoh.Session, key: str, payload: bytes = b"", timeout: float = 2.0) -> dict[str, bytes]:
    """What answers a `get` on a key expression: key -> payload. Empty: nobody answered."""
    answers: dict[str, bytes] = {}
    for reply in opened.get(key, payload=payload or None, timeout=timeout):
        if reply.ok is not None:
            answers[str(reply.ok.key_expr)] = reply.ok.payload.to_bytes()
    return answers


def send(opened: zenoh.Session, topic: Topic[Any], message: m.Message) -> None:
    """One message, once, as any client sends it."""
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


def tick_of(sample: zenoh.Sample) -> int | None:
    """The lockstep tick in which a sample was published, None where it carries none."""
    raw = sample.attachment.to_bytes() if sample.attachment is not None else b""
    return int(_TICK.unpack(raw)[0]) if len(raw) == _TICK.size else None


def sent_at(sample: zenoh.Sample) -> float:
    """Unix time of the sender's put."""
    return _seconds(sample.timestamp) if sample.timestamp is not None else unix_time()


def _open(config: zenoh.Config, opening: "Future[zenoh.Session]") -> None:
    try:
        opening.set_result(zenoh.open(config))
    except zenoh.ZError as error:
        opening.set_exception(error)


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
        self._out.put(payload, attachment=None if tick is None else _TICK.pack(tick))

    @property
    def matched(self) -> bool:
        return bool(self._matching.matching_status.matching)  # type: ignore[attr-defined]


class ZenohIo(IoBase):
    """`Io` over a Zenoh session."""

    def __init__(
        self,
        opened: zenoh.Session,
        name: str,
        reads: Iterable[Topic[Any]],
        writes: Iterable[Topic[Any]],
        *,
        scene: Scene,
        seed: int,
        lockstep: bool,
        clock: Clock,
        log_level: str = "info",
    ) -> None:
        reads, writes = tuple(reads), tuple(writes)
        self._session = opened
        self._log_publisher: Any = opened.declare_publisher(topics.LOG_KEY.format(name=name), encoding=codec.JSON)
        super().__init__(
            name, reads, writes, scene=scene, seed=seed, lockstep=lockstep, clock=clock, log_level=log_level
        )
        self._started = unix_time()
        self.out_tick: int | None = None
        self._peers: dict[str, str] = {}
        self._queries: queue.SimpleQueue[tuple[Handler, zenoh.Query]] = queue.SimpleQueue()
        self._kept: list[Any] = []
        self._streams: list[tuple[Any, Mailbox[Any]]] = []
        self._publishers = {t.key: Publisher(opened, t, lossless=lockstep) for t in writes}
        for topic in reads:
            self._subscribe(topic)
        self._kept.append(watch_tokens(opened, self._on_token))
        self._kept.append(listen(opened, topics.HEALTH_KEY.format(name="*"), self._on_health))

    def _subscribe(self, topic: Topic[Any]) -> None:
        box = self._boxes[topic.key]
        if topic.keep == "latest":
            # A stream waits outside Python until the next step: to call into it for every sample costs twice as much.
            waiting: Any = handlers.RingChannel(CAPACITY if self.lockstep else 1)
            self._streams.append((self._session.declare_subscriber(topic.key, waiting), box))
            if topic.latched:
                self._session.get(topic.key, lambda reply: _keep(box, reply.ok) if reply.ok is not None else None)
            return
        started, stale_key = self._started, f"{topic.key} (stale)"

        def receive(sample: zenoh.Sample) -> None:
            if topic.command and sample.timestamp is not None and _seconds(sample.timestamp) < started:
                self.drops[stale_key] += 1
                return
            _keep(box, sample)

        self._kept.append(subscribe(self._session, topic, receive))

    def begin(self, tick: int | None, now: float) -> None:
        for stream, box in self._streams:
            taken = 0
            while (sample := stream.try_recv()) is not None:
                _keep(box, sample)
                taken += 1
            if taken == CAPACITY:
                box.overflow += 1
        super().begin(tick, now)

    # --- peers
    def _on_token(self, name: str, alive: bool) -> None:
        if alive:
            self._peers.setdefault(name, "")
        else:
            self._peers.pop(name, None)

    def _on_health(self, sample: zenoh.Sample) -> None:
        try:
            health = codec.decode_as(m.Health, sample.payload.to_bytes())
        except codec.DecodeError as error:
            self.drops[str(sample.key_expr)] += 1
            self.log.debug("dropped", key=str(sample.key_expr), reason=str(error))
            return
        # Also without a token: that of a dead process may be lost after its successor's was announced.
        self._peers[health.name] = health.epoch

    def peer(self, name: str) -> str | None:
        return self._peers.get(name)

    def matched(self, topic: Topic[Any]) -> bool:
        return self._publishers[topic.key].matched

    # --- sending
    def _send(self, topic: Topic[Any], payload: bytes) -> None:
        tick = None
        if self.lockstep:
            tick = self.tick if self.out_tick is None else self.out_tick
        self._publishers[topic.key].put(payload, tick)

    def _send_log(self, record: m.LogRecord) -> None:
        self._log_publisher.put(msgspec.json.encode(record))

    # --- queries
    def serve(self, key: str, handler: Handler) -> None:
        self._kept.append(self._session.declare_queryable(key, lambda query: self._queries.put((handler, query))))

    def ask(self, key: str, request: bytes = b"") -> WorkerJob[bytes | None]:
        return self.submit(lambda: next(iter(fetch(self._session, key, request).values()), None))

    def answer_queries(self) -> None:
        """Run the handlers of waiting queries, in the calling thread."""
        while not self._queries.empty():
            handler, query = self._queries.get()
            payload = query.payload.to_bytes() if query.payload is not None else b""
            with query:
                try:
                    query.reply(query.key_expr, handler(payload), encoding=codec.JSON)
                except _BAD_REQUEST as error:
                    self.count_drop(str(query.key_expr), f"{type(error).__name__}: {error}")
                    query.reply_err(str(error))


def _keep(box: Mailbox[Any], sample: zenoh.Sample) -> None:
    tick = tick_of(sample)
    box.put(sample.payload.to_bytes(), UNSTAMPED if tick is None else tick)


def _seconds(timestamp: zenoh.Timestamp) -> float:
    return timestamp.get_time().timestamp()


def _json(value: object) -> str:
    return msgspec.json.encode(value).decode()
