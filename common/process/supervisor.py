"""Calls of supervisord's own interface (XML-RPC) over its Unix socket."""

import http.client
import xmlrpc.client
from pathlib import Path
from typing import Any


class NoSupervisor(Exception):
    """Nobody answers at the socket."""


class SupervisorRefused(Exception):
    """supervisord answers and does not do it; says why."""


def call(socket: Path, method: str, *args: Any) -> Any:
    """What supervisord answers to `method`; blocks until it does.

    Raises:
        NoSupervisor: there is no such socket, or nobody listens.
        SupervisorRefused: it says no.
    """
    if not socket.exists():
        raise NoSupervisor(f"{socket}: no such file")
    # Not for every process to load.
    from supervisor.xmlrpc import SupervisorTransport

    transport = SupervisorTransport(None, None, serverurl=f"unix://{socket}")
    try:
        return getattr(xmlrpc.client.ServerProxy("http://127.0.0.1", transport=transport), method)(*args)
    except xmlrpc.client.Fault as fault:
        raise SupervisorRefused(fault.faultString) from None
    except xmlrpc.client.ProtocolError as error:
        raise SupervisorRefused(error.errmsg) from None
    except (OSError, http.client.HTTPException) as error:
        raise NoSupervisor(str(error)) from None
    finally:
        transport.close()
