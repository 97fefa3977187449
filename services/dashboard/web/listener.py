"""The page's listening socket, and the lock on viser's own server behind it."""

import contextlib
import socket
from collections.abc import Iterator
from typing import Any

import websockets.asyncio.server
from websockets.http11 import Request, Response

from services.dashboard.config import DashboardConfig

KEY_HEADER = "X-Tidybot-Page"


class PageError(RuntimeError):
    """The page cannot be served as configured; says why."""


def listen(config: DashboardConfig) -> socket.socket:
    """A listening socket on the configured port or one of the next.

    Raises:
        PageError: none can be had.
    """
    ports = [config.port] if config.port == 0 else range(config.port, config.port + max(1, config.port_tries))
    family = socket.AF_INET6 if ":" in config.host else socket.AF_INET
    why = ""
    for port in ports:
        opened = socket.socket(family, socket.SOCK_STREAM)
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            opened.bind((config.host, port))
            opened.listen(64)
            opened.setblocking(False)
            return opened
        except (OSError, OverflowError) as error:
            opened.close()
            why = str(error)
    raise PageError(
        f"dashboard: no port of {config.host}:{config.port} and the {config.port_tries - 1} after it is free ({why}); "
        "choose another with `--set dashboard.port=N`"
    )


@contextlib.contextmanager
def guarded(secret: str) -> Iterator[None]:
    """While this context lasts, viser's servers are created to answer only requests with our key in the header."""
    serve: Any = websockets.asyncio.server.serve

    def with_key(handler: Any, *where: Any, **options: Any) -> Any:
        def check(connection: Any, request: Request) -> Response | None:
            if request.headers.get(KEY_HEADER) != secret:
                return connection.respond(403, "")  # type: ignore[no-any-return]
            return None

        return serve(handler, *where, **{**options, "process_request": check})

    websockets.asyncio.server.serve = with_key  # type: ignore[misc,assignment]
    try:
        yield
    finally:
        websockets.asyncio.server.serve = serve  # type: ignore[misc]
