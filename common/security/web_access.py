"""Access rules of the robot's web servers, the page's and the agents': addresses, origins and tokens."""

import hmac
import ipaddress
import secrets
from urllib.parse import urlsplit

LOCAL_NAMES = ("localhost", "ip6-localhost")
SHORTEST = 16
"""Characters of a token: 96 bits when made by `secrets.token_urlsafe`."""
COOKIE = "tidybot"


def is_loopback(host: str) -> bool:
    """True for addresses that only this machine can reach."""
    if host in LOCAL_NAMES:
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


def token_for(host: str, token: str) -> str:
    """The token that visitors must show; "" when none is needed.

    Raises:
        ValueError: one that could be guessed.
    """
    if token and len(token) < SHORTEST:
        raise ValueError(f"dashboard.token: {len(token)} characters; at least {SHORTEST} are needed")
    if token or is_loopback(host):
        return token
    return secrets.token_urlsafe(24)


def host_is_ours(host_header: str, token: str) -> bool:
    """True for a `Host` header that may be used: without a token only loopback names, against DNS rebinding."""
    return bool(token) or is_loopback(urlsplit(f"//{host_header}").hostname or "")


def same_origin(origin: str | None, host_header: str) -> bool:
    """False for a WebSocket or a request that a page of another site opened."""
    return origin is None or urlsplit(origin).netloc == host_header


def admits(token: str, *shown: str | None) -> bool:
    """True when one of the strings that the visitor shows is the token, or none is needed."""
    return not token or any(hmac.compare_digest(token.encode(), s.encode()) for s in shown if s)
