"""viser's stream, passed on from its own server on a port that answers nobody else."""

import asyncio
from typing import Any

from aiohttp import ClientSession, WSMsgType, web

from services.dashboard.web.listener import KEY_HEADER

VIEW_LIMIT = 8 * 2**20
"""Bytes of a message from a visitor's 3-D view; chosen: far above what a camera's pose or a click takes."""


async def proxied(request: web.Request, session: ClientSession, port: int, secret: str) -> web.StreamResponse:
    """A visitor's WebSocket to viser's at `port`, until either closes."""
    wanted = [p.strip() for p in request.headers.get("Sec-WebSocket-Protocol", "").split(",") if p.strip()]
    outer = web.WebSocketResponse(protocols=wanted, heartbeat=20.0, compress=False, max_msg_size=VIEW_LIMIT)
    await outer.prepare(request)
    async with session.ws_connect(
        f"ws://127.0.0.1:{port}/", protocols=wanted, headers={KEY_HEADER: secret}, max_msg_size=0, compress=0
    ) as inner:
        ways = [asyncio.ensure_future(_pass(outer, inner)), asyncio.ensure_future(_pass(inner, outer))]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for way in ways:
                way.cancel()
            await asyncio.gather(*ways, return_exceptions=True)
    await outer.close()
    return outer


async def _pass(source: Any, sink: Any) -> None:
    """Frames from one WebSocket to another until either closes."""
    async for message in source:
        if message.type is WSMsgType.BINARY:
            await sink.send_bytes(message.data)
        elif message.type is WSMsgType.TEXT:
            await sink.send_str(message.data)
