"""Zenoh sessions: endpoints, certificates, and an open session or the reason why there is none."""

import re
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from concurrent.futures import wait as futures_wait
from contextlib import contextmanager
from threading import Thread
from typing import TYPE_CHECKING

import msgspec
import zenoh

from common.installation import shipped
from common.security import keys, tls_diagnosis
from common.security.access import OPERATOR
from common.time.clock import monotonic

if TYPE_CHECKING:
    from common.security.certificate import Identity

CONFIGS = shipped("config") / "zenoh"
DEFAULT_CONNECT = "tcp/127.0.0.1:7447"
DEFAULT_SECURE = "tls/127.0.0.1:7447"
PROBE_AFTER = 2.0
"""Wait for a connection before a TLS handshake of our own looks for the reason [s]; chosen: a router that runs answers
sooner."""
PROBE_PERIOD = 30.0
"""Time between two reports of why there is no router [s]; chosen: rarely enough not to flood a log."""
_NAMESPACE = re.compile(r"[A-Za-z0-9][\w.-]*(/[A-Za-z0-9][\w.-]*)*", re.ASCII)
ATTEMPT = 2.0
"""Longest single attempt to connect [s]; the lease of config/zenoh: who takes longer to answer is taken for frozen."""


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
        from common.security.certificate import Identity

        return Identity(keys.folder(found, name, namespace), name, namespace)
    except keys.KeysError as error:
        raise BusError(str(error)) from None


def check_namespace(namespace: str) -> None:
    """Raises `BusError` for what cannot be the beginning of a robot's keys and a folder of its certificates."""
    if namespace and not _NAMESPACE.fullmatch(namespace):
        raise BusError(f"namespace {namespace!r}: letters, digits, '_', '.' and '-' only, or several such by '/'")


def endpoints(connect: str) -> list[str]:
    return [e.strip() for e in connect.split(",") if e.strip()]


def client_config(connect: str, namespace: str = "", shown: "Identity | None" = None) -> zenoh.Config:
    """A client of the comma-separated router endpoints; with a certificate `shown` it speaks TLS only.

    Raises:
        BusError: a bad endpoint or namespace.
    """
    check_namespace(namespace)
    try:
        config = zenoh.Config.from_file(str(CONFIGS / "client.json5"))
        config.insert_json5("connect/endpoints", _json(endpoints(connect)))
        if shown is not None:
            config.insert_json5("transport/link/protocols", _json(["tls"]))
            config.insert_json5("transport/link/tls", _json(shown.settings(serving=False)))
        if namespace:
            config.insert_json5("namespace", _json(namespace))
    except zenoh.ZError as error:
        raise BusError(f"zenoh configuration for {connect!r}: {error}") from None
    return config


@contextmanager
def open_session(
    connect: str,
    namespace: str = "",
    wait: Callable[[float], bool] | None = None,
    patience: float = 3.0,
    name: str = OPERATOR,
    prefixed: bool = True,
) -> Iterator[zenoh.Session]:
    """An open session that is closed whatever happens: an open one keeps the process from ending.

    Zenoh is deaf to signals while it connects, so it opens in a thread of its own, in attempts that end by themselves.
    A node passes `wait(seconds) -> stop?` and waits for its router as long as that is False; a tool waits `patience`
    seconds. With keys the session shows the certificate of `name`. One that is not `prefixed` has its keys outside of
    the namespace.

    Raises:
        BusError: a bad endpoint or certificate, or no router in time.
        NoRouter: `wait` said stop before a router was there.
    """
    opening: Future[zenoh.Session] = Future()
    shown = identity_for(connect, name, namespace)
    config = client_config(connect, namespace if prefixed else "", shown=shown)
    attempt = ATTEMPT if wait is not None else min(ATTEMPT, patience)
    # No daemon: a thread that comes back from Zenoh while Python ends aborts the process, so Python waits for it.
    Thread(target=_open, args=(config, opening, attempt), name="zenoh-open").start()
    try:
        opened = _awaited(opening, connect, name, shown, wait, patience)
    except zenoh.ZError as error:
        raise BusError(f"cannot connect to {connect}: {error}") from None
    except BaseException:
        if not opening.cancel() and opening.exception() is None:
            opening.result().close()  # type: ignore[no-untyped-call]
        raise
    with opened:
        yield opened


def _awaited(
    opening: "Future[zenoh.Session]",
    connect: str,
    name: str,
    shown: "Identity | None",
    wait: Callable[[float], bool] | None,
    patience: float,
) -> zenoh.Session:
    """The session once it is open; meanwhile reports why there is none (see `open_session`)."""
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
            if wait is not None:
                why = why or f"waiting for a router at {connect}; `tidybot up` starts one"
                print(f"{name}: {why}", file=sys.stderr, flush=True)
        if wait is None:
            futures_wait([opening], 0.05)
        elif wait(0.05):
            raise NoRouter("stopped before a router was there")
    return opening.result()


def _trouble(connect: str, shown: "Identity | None") -> str:
    """Why no router takes us, "" when none is there."""
    found = (tls_diagnosis.trouble(endpoint, shown) for endpoint in endpoints(connect))
    return next((why for why in found if why), "")


def _open(config: zenoh.Config, opening: "Future[zenoh.Session]", attempt: float) -> None:
    """Attempts of so many seconds until one succeeds or nobody waits any more; what comes too late is closed."""
    config.insert_json5("connect/timeout_ms", _json(round(1e3 * attempt)))
    while not opening.cancelled():
        began = monotonic()
        try:
            opened = zenoh.open(config)
        except zenoh.ZError as error:
            # No router takes all the time there is, anything else fails at once.
            if monotonic() < began + attempt and opening.set_running_or_notify_cancel():
                opening.set_exception(error)
                return
        else:
            if opening.set_running_or_notify_cancel():
                opening.set_result(opened)
            else:
                opened.close()  # type: ignore[no-untyped-call]
            return


def _json(value: object) -> str:
    return msgspec.json.encode(value).decode()
