"""Zenoh: sessions, what goes over them once, and subscribers with the delivery that the table declares.

Events and goals travel over advanced publishers (cache, miss detection) to advanced subscribers (history,
recovery), so a router outage loses none; streams keep the newest value only. Every latched key also answers a
plain `get`. Callbacks only enqueue: they run in Zenoh's receiving thread, one after the other in the order of arrival.
"""

import struct
import sys
from collections.abc import Callable, Iterator
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
from common.clock import monotonic, unix_time
from common.topics import Topic

if TYPE_CHECKING:
    from common.certificate import Identity

CONFIGS = Path(__file__).resolve().parent.parent / "config" / "zenoh"
DEFAULT_CONNECT = "tcp/127.0.0.1:7447"
DEFAULT_SECURE = "tls/127.0.0.1:7447"
CACHE = 64
PROBE_AFTER, PROBE_PERIOD = 2.0, 30.0
_TICK = struct.Struct("<q")


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


def _open(config: zenoh.Config, opening: "Future[zenoh.Session]") -> None:
    try:
        opening.set_result(zenoh.open(config))
    except zenoh.ZError as error:
        opening.set_exception(error)


def _json(value: object) -> str:
    return msgspec.json.encode(value).decode()
