"""Access to a page: an aiohttp middleware that lets in whoever may, and says what the page may load."""

from collections.abc import Awaitable, Callable

from aiohttp import web
from aiohttp.typedefs import Middleware

from common.security import web_access as access

STAYS = 12 * 3600
"""Time [s] for which a browser that has shown the token is let in again; chosen: a working day."""


def access_middleware(token: str, policy: str, whose: str) -> Middleware:
    """Lets in under addresses of ours only, with the `token` where there is one.

    `policy`: the Content-Security-Policy of every answer; `whose` page it is, for those who are refused.
    """

    @web.middleware
    async def middleware(
        request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        host, shown = request.host, request.query.get("token")
        if not access.host_is_ours(host, token) or not access.same_origin(request.headers.get("Origin"), host):
            raise web.HTTPForbidden(text=f"This address is not {whose} page.\n")
        if not access.admits(token, request.cookies.get(access.COOKIE), shown):
            raise web.HTTPUnauthorized(text="Open the address with ?token=..., as printed at the start.\n")
        if token and shown and request.path == "/":
            # The token is not for the history of the browser.
            answer: web.StreamResponse = web.Response(status=303, headers={"Location": "/"})
            answer.set_cookie(access.COOKIE, token, httponly=True, samesite="Strict", max_age=STAYS)
            return answer
        answer = await handler(request)
        if not answer.prepared:
            answer.headers["Content-Security-Policy"] = policy
            answer.headers["X-Content-Type-Options"] = "nosniff"
            answer.headers["Referrer-Policy"] = "no-referrer"
        return answer

    return middleware
