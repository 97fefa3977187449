"""Connections of the open pages: texts and sound to them, events from them. Runs in the web server's loop."""

import asyncio
import contextlib
from collections.abc import Callable

import msgspec
from aiohttp import WSMsgType, web

from services.dashboard.web.events import Event, Sound, Words

SEND_QUEUE = 100
"""Messages that a browser may be behind; chosen: some seconds of sound and state."""
MAX_CHUNK = 64 * 1024
"""Bytes of a visitor's message: two seconds of sound."""


class Visitors:
    """Keeps a WebSocket for each open page; events of visitors go to `told`."""

    def __init__(self, told: Callable[[Event], None]) -> None:
        self._told = told
        self._open: dict[web.WebSocketResponse, asyncio.Queue[str | bytes]] = {}
        self._last: dict[str, str] = {}

    def __len__(self) -> int:
        return len(self._open)

    async def serve(self, request: web.Request) -> web.StreamResponse:
        """Serve one visitor's connection from opening to closing."""
        socket = web.WebSocketResponse(heartbeat=10.0, max_msg_size=MAX_CHUNK, compress=False)
        await socket.prepare(request)
        outbox: asyncio.Queue[str | bytes] = asyncio.Queue(SEND_QUEUE)
        for text in self._last.values():
            outbox.put_nowait(text)
        self._open[socket] = outbox
        sender = asyncio.ensure_future(_send(socket, outbox))
        try:
            async for message in socket:
                if message.type is WSMsgType.BINARY:
                    self._told(Sound(message.data))
                elif message.type is WSMsgType.TEXT:
                    with contextlib.suppress(msgspec.DecodeError):
                        self._told(msgspec.json.decode(message.data, type=Words))
        finally:
            self._open.pop(socket, None)
            sender.cancel()
            await asyncio.gather(sender, return_exceptions=True)
            # A microphone that goes with its page must not leave half a sentence open.
            self._told(Sound(b""))
        return socket

    def tell(self, kind: str, text: str) -> None:
        """Send a text to every page, and to those that open before there is a newer text of this kind."""
        self._last[kind] = text
        self.spread(text)

    def spread(self, message: str | bytes) -> None:
        """Send a message to every page that is open now."""
        for visitor, outbox in list(self._open.items()):
            try:
                outbox.put_nowait(message)
            except asyncio.QueueFull:
                # A browser that hangs loses its connection, and nobody else notices; it opens a new one by itself.
                self._open.pop(visitor, None)
                if visitor._req is not None and visitor._req.transport is not None:
                    visitor._req.transport.abort()

    async def close(self) -> None:
        """Close every visitor's connection."""
        for visitor in list(self._open):
            with contextlib.suppress(ConnectionError, TimeoutError):
                await asyncio.wait_for(visitor.close(), 0.5)


async def _send(socket: web.WebSocketResponse, outbox: "asyncio.Queue[str | bytes]") -> None:
    while True:
        message = await outbox.get()
        if isinstance(message, str):
            await socket.send_str(message)
        else:
            await socket.send_bytes(message)
