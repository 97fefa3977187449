"""`tidybot mcp`: a server of the Model Context Protocol, so that an agent can use the robot."""

import argparse
import importlib.util

from cli.errors import CliError
from cli.link import robot_command
from common.security.access import AGENT

PORT = 8765
"""Default port for `--http`."""


def address(text: str) -> tuple[str, int]:
    """`PORT`, `HOST` or `HOST:PORT`; an IPv6 address with a port stands in brackets.

    Raises:
        argparse.ArgumentTypeError: no such thing.
    """
    host, _, port = text.rpartition(":")
    if text.isdecimal():
        host, port = "127.0.0.1", text
    elif not port.isdecimal() or (":" in host and not host.startswith("[")):
        host, port = text, str(PORT)
    if not host or not 0 < int(port) < 65536:
        raise argparse.ArgumentTypeError(f"{text!r}: expected HOST, PORT or HOST:PORT")
    return host.strip("[]"), int(port)


def mcp(args: argparse.Namespace) -> int:
    """The command; over stdio it ends when the agent's host closes the pipe."""
    if importlib.util.find_spec("mcp") is None:
        raise CliError("agents need the package mcp: pip install 'tidybot-zenoh[mcp]'")
    import anyio

    from cli.agents.http import serve
    from cli.agents.missions import Missions
    from cli.agents.server import build

    server = build(Missions(args, args.client, confirmed=not args.confirm))
    if args.http is None:
        anyio.run(server.run_stdio_async)
    else:
        anyio.run(serve, server, *args.http)
    return 0


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(commands, mcp, "let an agent use the robot (Model Context Protocol, on stdio or HTTP)")
    parser.add_argument(
        "--http",
        nargs="?",
        type=address,
        const=("127.0.0.1", PORT),
        metavar="[HOST:]PORT",
        help=f"serve over HTTP, with the page's token (default 127.0.0.1:{PORT})",
    )
    parser.add_argument("--confirm", action="store_true", help="the robot asks a person about every command first")
    parser.add_argument("--client", default=AGENT, metavar="NAME", help="whose certificate (default: %(default)s)")
