"""`tidybot keys`: a certificate for every service and client, so that each may do only its own part."""

import argparse
import os
import re
from pathlib import Path

from cli.errors import CliError
from cli.keys.authority import Authority, hosts_of
from cli.output import show
from cli.processes.services import NAMES
from common.bus.session import check_namespace
from common.security.access import AGENT, OPERATOR, ROUTER, Role, Subject
from common.security.keys import OFF, default_directory

DAYS = 365.0
"""Validity of a certificate [days]."""
CLIENTS: tuple[tuple[str, Role], ...] = ((OPERATOR, "operator"), (AGENT, "agent"))
"""The clients that every robot has, with their roles."""
_WORD = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")
_HOST = re.compile(r"[A-Za-z0-9:][A-Za-z0-9:._-]*")


def everybody(namespace: str, domain: int = 0) -> list[Subject]:
    """Who a robot consists of: the router, its services, one operator, and the agents' way in (`tidybot mcp`)."""
    services = [Subject(name=n, namespace=namespace, domain=domain) for n in NAMES if n != ROUTER]
    router = Subject(name=ROUTER, role="router")
    clients = [Subject(name=n, role=r, namespace=namespace) for n, r in CLIENTS]
    return [router, *services, *clients]


def keys(args: argparse.Namespace) -> int:
    """Make, renew or list certificates; the exit status."""
    authority = Authority(_directory(args))
    _check(args)
    if args.list:
        return _list(authority, args)
    known = authority.subjects()
    asked = [_client(args)] if args.client else everybody(args.namespace, args.ros_domain)
    if args.force or not authority.exists:
        # Everybody who had a certificate gets a new one: the old authority is no longer trusted.
        made = _merged(known, everybody(args.namespace, args.ros_domain), asked)
        authority.found(max(args.days, DAYS) * 3)
    else:
        made = [s for s in asked if not authority.has(s)]
        there = [s for s in asked if s.role != "router" and authority.has(s)]
        if there and not args.missing:
            raise CliError(
                f"{there[0].common_name} has a certificate in {authority.directory} already; --missing makes what is "
                "not there, --force makes all anew (every host then needs its new ones), --client NAME adds a client"
            )
    for subject in made:
        authority.issue(subject, args.days, hosts_of(args.host))
    authority.register(_merged(known, asked, made))
    if args.owner is not None:
        _give(authority, args.owner)
    _report(authority, made, args)
    return 0


def _check(args: argparse.Namespace) -> None:
    check_namespace(args.namespace)
    if args.client and not _WORD.fullmatch(args.client):
        raise CliError(f"{args.client!r}: letters, digits, '_', '.' and '-' only")
    for host in args.host:
        if not _HOST.fullmatch(host):
            raise CliError(f"--host {host}: neither a name nor an address")
    if args.client in NAMES:
        raise CliError(f"{args.client} is a service; a client needs another name")
    if args.days <= 0:
        raise CliError(f"--days {args.days:g}: expected a positive number")
    kinds = [option for option in ("observer", "agent", "fleet", "ros") if getattr(args, option)]
    if kinds and not args.client:
        raise CliError(f"--{kinds[0]} goes with --client NAME")
    if len(kinds) > 1:
        raise CliError(f"--{kinds[0]} and --{kinds[1]} are two kinds of client; choose one")


def _client(args: argparse.Namespace) -> Subject:
    if args.ros:
        return Subject(name=args.client, role="ros", domain=args.ros_domain)
    if args.fleet:
        return Subject(name=args.client, role="fleet")
    role: Role = "observer" if args.observer else "agent" if args.agent else "operator"
    return Subject(name=args.client, role=role, namespace=args.namespace)


def _merged(*lists: list[Subject]) -> list[Subject]:
    """Each once, the later word counts."""
    return list({s.common_name: s for subjects in lists for s in subjects}.values())


def _directory(args: argparse.Namespace) -> Path:
    if args.dir is not None:
        return Path(args.dir).resolve()
    given = os.environ.get("TIDYBOT_KEYS", "")
    return Path(given).resolve() if given not in ("", OFF) else default_directory()


def _give(authority: Authority, owner: int) -> None:
    """Services' keys to the user that containers run as; the rest to whom the directory belongs."""
    above = authority.directory.stat()
    private = {authority.directory / "ca"}
    private |= {
        authority.directory / s.common_name for s in authority.subjects() if s.role not in ("service", "router")
    }
    for folder, _, files in os.walk(authority.directory):
        path = Path(folder)
        if path == authority.directory:
            continue
        user, group = (above.st_uid, above.st_gid) if path in private else (owner, owner)
        for one in (path, *(path / f for f in files)):
            try:
                os.chown(one, user, group)
            except PermissionError:
                raise CliError(f"--owner {owner}: only root can give files away") from None


def _report(authority: Authority, made: list[Subject], args: argparse.Namespace) -> None:
    names = {s.common_name for s in made}
    rows = [r for r in authority.rows() if r.name in names]
    lines = [f"{row.name:24} {row.role:9} until {row.expires}" for row in rows]
    lines.append(f"in {authority.directory}; a router that is up must be restarted (`tidybot restart router`)")
    if args.dir is None and not os.environ.get("TIDYBOT_KEYS"):
        lines.append("`tidybot up` uses them from now on; TIDYBOT_KEYS=off does without")
    found = {"directory": str(authority.directory), "made": rows}
    show(args, found, lines if made else [f"nothing was missing in {authority.directory}"])


def _list(authority: Authority, args: argparse.Namespace) -> int:
    if not authority.exists:
        raise CliError(f"no keys in {authority.directory}; `tidybot keys` makes them")
    rows = authority.rows()
    show(args, rows, (f"{row.name:24} {row.role:9} until {row.expires}  {row.folder}" for row in rows))
    return 0


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("keys", help="certificates: each service and client may do only its own part")
    parser.add_argument("--dir", metavar="DIR", help="where (default: TIDYBOT_KEYS, TIDYBOT_KEYS_DIR, or run/keys)")
    parser.add_argument("--client", metavar="NAME", default="", help="add a client: a person's laptop, a tool")
    parser.add_argument("--observer", action="store_true", help="that client may only look")
    parser.add_argument(
        "--agent", action="store_true", help="that client is a program: it commands in words, and stops"
    )
    parser.add_argument(
        "--fleet",
        action="store_true",
        help="that client sees, commands and stops every robot (`tidybot fleet`)",
    )
    parser.add_argument("--ros", action="store_true", help="that client is a ROS 2 peer, and reaches its domain only")
    parser.add_argument("--ros-domain", type=int, default=0, metavar="N", help="ROS_DOMAIN_ID (default %(default)s)")
    parser.add_argument("--namespace", metavar="NAME", default="", help="for the robot of that namespace")
    parser.add_argument("--host", action="append", default=[], metavar="NAME", help="the router's name or address")
    parser.add_argument("--days", type=float, default=DAYS, metavar="N", help="validity (default %(default)s)")
    parser.add_argument("--missing", action="store_true", help="make what is not there, keep the rest")
    parser.add_argument("--force", action="store_true", help="a new authority and new certificates for everybody")
    parser.add_argument("--owner", type=int, metavar="UID", help="give the services' keys to this user (containers)")
    parser.add_argument("--list", action="store_true", help="what there is, and until when")
    parser.add_argument("--json", action="store_true", help="as JSON")
    parser.set_defaults(run=keys)
