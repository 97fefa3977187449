"""`tidybot fleet page`: one page for all robots, with the access rules of the page of one."""

import asyncio
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path

from aiohttp import web

from cli.agents.http import page_token
from cli.errors import CliError
from cli.fleet.watch_room import WatchRoom
from common.process.host import StopSignal
from common.security.web_middleware import access_middleware

FILES = Path(__file__).parent / "web"
POLICY = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'"
LONGEST = 500
"""Characters of a command [count]; chosen: more than anybody says."""


def application(room: WatchRoom, token: str) -> web.Application:
    """The page and what it asks for."""

    @web.middleware
    async def json_only(
        request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        # Forms of other sites can post, but not JSON.
        if request.method == "POST" and request.content_type != "application/json":
            raise web.HTTPUnsupportedMediaType(text="JSON only.\n")
        return await handler(request)

    async def index(request: web.Request) -> web.StreamResponse:
        return web.FileResponse(FILES / "fleet.html")

    async def state(request: web.Request) -> web.StreamResponse:
        return web.json_response(room.shown())

    async def act(request: web.Request) -> web.StreamResponse:
        asked = await request.json()
        match asked:
            case {"do": "stop", "robot": str() | None as name}:
                # Asking who is there takes a moment, and the page goes on meanwhile.
                await asyncio.to_thread(room.stop, name)
            case {"do": "answer", "robot": str() as name, "yes": bool() as yes}:
                room.answer(name, yes)
            case {"do": "say", "text": str() as text, "hand_over": bool() as hand_over} if 0 < len(text) <= LONGEST:
                room.say(text, hand_over)
            case _:
                raise web.HTTPBadRequest(text="expected stop, answer or say\n")
        return web.json_response({})

    app = web.Application(
        middlewares=[access_middleware(token, POLICY, "the fleet's"), json_only], client_max_size=4096
    )
    app.router.add_get("/", index)
    app.router.add_get("/state", state)
    app.router.add_post("/act", act)
    app.router.add_static("/web", FILES)
    return app


async def _serve(room: WatchRoom, host: str, port: int, token: str, stop: StopSignal) -> None:
    runner = web.AppRunner(application(room, token), access_log=None, shutdown_timeout=0.5)
    await runner.setup()
    try:
        await web.TCPSite(runner, host, port).start()
    except OSError as error:
        await runner.cleanup()
        raise CliError(f"{host}:{port}: {error.strerror}; choose another with --port") from None
    url = f"http://{f'[{host}]' if ':' in host else host}:{port}/"
    print(f"fleet: open {url}{f'?token={token}' if token else ''}", file=sys.stderr, flush=True)
    while not stop.is_set():
        await asyncio.sleep(0.1)
    await runner.cleanup()


def serve(room: WatchRoom, host: str, port: int) -> None:
    """Serve until interrupted.

    Raises:
        CliError: the port cannot be had, or the token can be guessed.
    """
    token, stop = page_token(host), StopSignal()
    try:
        asyncio.run(_serve(room, host, port, token, stop))
    finally:
        room.close()
