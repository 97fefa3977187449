"""`tidybot mcp --http`: the server over Streamable HTTP, with the access rules of the operator's page."""

import socket
import sys
import tomllib
from typing import TYPE_CHECKING, Any

from cli.errors import CliError
from cli.processes.supervision import settings_of_run
from common import config
from common.security import web_access

if TYPE_CHECKING:
    from mcp.server.mcpserver import MCPServer
    from starlette.types import ASGIApp, Receive, Scope, Send

PATH = "/mcp"


def page_token(host: str) -> str:
    """The page's token: of the run that is up, the environment or dashboard.toml; made up where one is needed.

    Raises:
        CliError: one that could be guessed, or a configuration that cannot be read.
    """
    try:
        path = config.config_dir() / "dashboard.toml"
        filed = tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        changed = config.overrides(settings_of_run(), []).get("dashboard", {})
        given = changed["token"][0] if "token" in changed else filed.get("token", "")
        return web_access.token_for(host, str(given))
    except (OSError, ValueError) as error:
        raise CliError(str(error)) from None


class AccessMiddleware:
    """Lets in who shows the token (`Authorization: Bearer`), under an address of ours, from no other site's page."""

    def __init__(self, app: "ASGIApp", token: str) -> None:
        self._app, self._token = app, token

    async def __call__(self, scope: "Scope", receive: "Receive", send: "Send") -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        host = headers.get("host", "")
        kind, _, shown = headers.get("authorization", "").partition(" ")
        if not web_access.host_is_ours(host, self._token) or not web_access.same_origin(headers.get("origin"), host):
            await _refuse(send, 403, "This address is not the robot's.\n")
        elif not web_access.admits(self._token, shown if kind.lower() == "bearer" else None):
            await _refuse(send, 401, "Send the page's token: Authorization: Bearer TOKEN\n")
        else:
            await self._app(scope, receive, send)


async def _refuse(send: "Send", status: int, text: str) -> None:
    headers = [(b"content-type", b"text/plain; charset=utf-8")]
    if status == 401:
        headers.append((b"www-authenticate", b"Bearer"))
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": text.encode()})


async def serve(server: "MCPServer[Any]", host: str, port: int) -> None:
    """Serve until interrupted.

    Raises:
        CliError: the token is too short.
    """
    import uvicorn
    from mcp.server.transport_security import TransportSecuritySettings

    token = page_token(host)
    # The middleware below decides about hosts and origins, by the page's rules.
    security = TransportSecuritySettings(enable_dns_rebinding_protection=False)
    app = AccessMiddleware(
        server.streamable_http_app(streamable_http_path=PATH, transport_security=security, host=host), token
    )
    shown = f"[{host}]" if ":" in host else host
    try:
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        listening = socket.create_server((host, port), family=family)
    except OSError as error:
        raise CliError(f"--http {shown}:{port}: {error.strerror}") from None
    print(f"agents: http://{shown}:{port}{PATH}", file=sys.stderr)
    if token:
        print(f"each request needs the header  Authorization: Bearer {token}", file=sys.stderr, flush=True)
    options = uvicorn.Config(app, host=host, port=port, log_level="warning", timeout_graceful_shutdown=2)
    await uvicorn.Server(options).serve(sockets=[listening])
