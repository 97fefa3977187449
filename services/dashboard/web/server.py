"""The page's web server. The only module with a thread: viser's event loop, which also runs the front server.

Visitors reach one port: our page with the stop button, microphone and voice, and viser's 3-D view below `/view`, passed
on to viser's own server on a loopback port that answers nobody else. The service talks to it through `inbox`, `say`
and `play` only.
"""

import asyncio
import contextlib
import queue
import secrets
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import viser
from aiohttp import ClientSession, WSMsgType, web

from common.security import web_access as access
from common.security.web_middleware import access_middleware
from services.dashboard.config import DashboardConfig
from services.dashboard.web.events import Asked, Click, Event
from services.dashboard.web.listener import KEY_HEADER, PageError, guarded, listen
from services.dashboard.web.visitors import MAX_CHUNK, Visitors

VIEW_LIMIT = 8 * 2**20
"""Bytes of a message from a visitor's 3-D view; chosen: far above what a camera's pose or a click takes."""
PAGE = Path(__file__).parent / "page"
VIEW = Path(viser.__file__).parent / "client" / "build" / "index.html"
OPENING, CLOSING, ANSWER = 60.0, 2.0, 8.0
"""Limits [s] for the server to start and to end, and for the brain to answer for a mission's page; chosen: far
above what a busy machine needs."""
# The view under the other name of this machine is another site to a browser, which draws it in another process: however
# slow the drawing is, the stop button answers.
OTHER_NAME = {"127.0.0.1": "localhost", "localhost": "127.0.0.1"}
# Everything the page shows comes from here; `data:` and `blob:` are viser's own pictures and workers.
POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; font-src 'self' data:; "
    "script-src 'self' 'unsafe-inline' 'unsafe-eval' blob: data:; worker-src 'self' blob: data:; "
    "connect-src 'self' ws: wss: data: blob:; frame-src 'self' {us}; frame-ancestors 'self' {us}"
)


class Web:
    """Serves the page until `close`."""

    def __init__(self, config: DashboardConfig) -> None:
        try:
            self._token = access.token_for(config.host, config.token)
        except ValueError as error:
            raise PageError(str(error)) from None
        self._socket = listen(config)
        self.port: int = self._socket.getsockname()[1]
        self.inbox: queue.SimpleQueue[Event] = queue.SimpleQueue()
        self.visitors = Visitors(self.inbox.put)
        self._secret = secrets.token_urlsafe(24)
        with guarded(self._secret):
            self.viser = viser.ViserServer(host="127.0.0.1", port=0, label="tidybot", verbose=False)
        self._loop = self.viser.get_event_loop()
        self.viser.scene.on_click()(self._clicked)  # type: ignore[arg-type]
        host = "127.0.0.1" if config.host in ("", "0.0.0.0", "::") else config.host
        self.url = f"http://{f'[{host}]' if ':' in host else host}:{self.port}/"
        self.entrance = self.url + (f"?token={self._token}" if self._token else "")
        # The space bar stops the robot in the view as well; on a telephone the panels take the whole width.
        self._view_page = VIEW.read_text(encoding="utf-8").replace(
            "<head>", '<head><script src="/page/keys.js"></script><link rel="stylesheet" href="/page/view.css">', 1
        )
        self._runner = self._in_loop(self._start(), OPENING)

    # --- the service's side; any thread
    def say(self, kind: str, message: object) -> None:
        """Send a text to every page; the newest of each kind also goes to pages that open later."""
        text = msgspec.json.encode({"kind": kind, "value": message}).decode()
        self._loop.call_soon_threadsafe(self.visitors.tell, kind, text)

    def play(self, samples: bytes, rate: int) -> None:
        """Have every page play int16 samples."""
        self._loop.call_soon_threadsafe(self.visitors.spread, rate.to_bytes(4, "little") + samples)

    def answer(self, asked: Asked, page: str) -> None:
        """Answer a visitor who asked for a mission's page; "" for none."""
        self._loop.call_soon_threadsafe(_settle, asked.answer, page)

    @property
    def watched(self) -> bool:
        """True while a browser has the 3-D view open."""
        return bool(self.viser.get_clients())

    def close(self) -> None:
        """End the server and every visitor's connection."""
        with contextlib.suppress(TimeoutError):
            self._in_loop(self._end(), CLOSING)
        self.viser.stop()

    def _in_loop(self, work: Any, limit: float) -> Any:
        future: Future[Any] = asyncio.run_coroutine_threadsafe(work, self._loop)
        return future.result(limit)

    # --- the loop's side
    async def _start(self) -> web.AppRunner:
        us = " ".join(f"http://{name}:{self.port}" for name in OTHER_NAME)
        access_rules = access_middleware(self._token, POLICY.format(us=us), "the robot's")
        app = web.Application(middlewares=[access_rules], client_max_size=MAX_CHUNK)
        app.router.add_get("/", self._page)
        app.router.add_get("/view", self._view)
        app.router.add_get("/view/", self._view)
        app.router.add_get("/live", self.visitors.serve)
        app.router.add_get("/mission/{id}", self._mission)
        app.router.add_static("/page", PAGE)
        # A connector belongs to the loop that it is made in.
        self._inner = ClientSession()
        runner = web.AppRunner(app, access_log=None, shutdown_timeout=0.5)
        await runner.setup()
        await web.SockSite(runner, self._socket).start()
        return runner

    async def _end(self) -> None:
        await self.visitors.close()
        await self._inner.close()
        await self._runner.cleanup()

    async def _page(self, request: web.Request) -> web.StreamResponse:
        port = request.url.port
        name = "" if self._token else OTHER_NAME.get(request.url.host or "", "")
        text = (PAGE / "index.html").read_text(encoding="utf-8")
        text = text.replace('"/view/"', f'"http://{name}:{port}/view/"' if name else '"/view/"')
        return web.Response(text=text, content_type="text/html")

    async def _view(self, request: web.Request) -> web.StreamResponse:
        """viser's page, or its stream when a WebSocket is asked for."""
        if request.headers.get("Upgrade", "").lower() == "websocket":
            return await proxied(request, self._inner, self.viser.get_port(), self._secret)
        return web.Response(text=self._view_page, content_type="text/html")

    async def _mission(self, request: web.Request) -> web.StreamResponse:
        """A mission's timeline, from the brain's journal."""
        asked = Asked(request.match_info["id"], asyncio.get_running_loop().create_future())
        self.inbox.put(asked)
        with contextlib.suppress(TimeoutError):
            page = await asyncio.wait_for(asked.answer, ANSWER)
            if page:
                return web.Response(text=page, content_type="text/html")
        raise web.HTTPNotFound(text="The brain tells of no such mission.\n")

    async def _clicked(self, event: viser.SceneClickEvent) -> None:
        self.inbox.put(Click(np.array(event.ray_origin), np.array(event.ray_direction)))


def _settle(future: "asyncio.Future[str]", page: str) -> None:
    if not future.done():
        future.set_result(page)


# --- viser's stream, passed on from its own server on a port that answers nobody else
async def proxied(request: web.Request, session: ClientSession, port: int, secret: str) -> web.StreamResponse:
    """Connect a visitor's WebSocket to viser's at `port`, until either closes."""
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
