"""`tidybot fleet`: where every robot is and what it does, and a command for the best of them."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import msgspec
from rich.console import Console
from rich.live import Live
from rich.table import Table

from cli.errors import CliError
from cli.fleet.choice import Candidate
from cli.fleet.dispatch import POLL, Dispatch
from cli.fleet.radio import OTHERS, router_config
from cli.fleet.robots import Desk, RobotNow
from cli.link import address
from cli.output import show
from common import messages as m
from common import topics
from common.bus.session import open_session
from common.security.access import FLEET
from common.time.clock import monotonic, sleep

PERIOD = 1.0
"""Time between two looks of `--watch` [s]."""
NAMELESS = "(no namespace)"


def shown(name: str) -> str:
    """A robot's name as people read it."""
    return name or NAMELESS


@contextmanager
def desk(args: argparse.Namespace) -> Iterator[Desk]:
    """A session outside of all namespaces, under the fleet's certificate where there are keys."""
    connect, _ = address(args)
    with open_session(connect, "", name=args.certificate, prefixed=False) as session:
        yield Desk(session)


def table(robots: list[RobotNow], gone: dict[str, float]) -> Table:
    """One line for each robot; `gone`: names of those that were there, with how long ago [s]."""
    drawn = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for head in ("robot", "state", "does", "x", "y", "battery", "holds"):
        drawn.add_column(head, no_wrap=head != "does", justify="right" if head in ("x", "y", "battery") else "left")
    for r in robots:
        x, y = (f"{r.pose[0]:.1f}", f"{r.pose[1]:.1f}") if r.pose is not None else ("", "")
        charge = f"{100 * r.battery:.0f} %" if r.battery is not None else ""
        state = "STOPPED" if r.braked else r.state or "no answer"
        drawn.add_row(shown(r.name), state, r.question or r.command or r.detail, x, y, charge, r.holding)
    for name, since in sorted(gone.items()):
        drawn.add_row(shown(name), "LOST", f"not heard for {since:.0f} s", "", "", "", "")
    return drawn


def fleet(args: argparse.Namespace) -> int:
    """List the robots that are there, once or until interrupted."""
    with desk(args) as d:
        if not args.watch:
            robots = d.look()
            if args.json:
                print(msgspec.json.encode(robots).decode())
            elif robots:
                Console().print(table(robots, {}))
            else:
                print("no robot is there; each needs its router linked with this one (docs/DEPLOY.md)")
            return 0
        seen: dict[str, float] = {}
        with Live(console=Console(), auto_refresh=False) as live:
            while True:
                robots, now = d.look(), monotonic()
                seen |= {r.name: now for r in robots}
                if args.json:
                    live.console.print(msgspec.json.encode(robots).decode(), soft_wrap=True, markup=False)
                else:
                    present = {r.name for r in robots}
                    live.update(table(robots, {n: now - t for n, t in seen.items() if n not in present}), refresh=True)
                sleep(PERIOD)


def say(args: argparse.Namespace) -> int:
    """Give a command to the best robot; exit status 0 when it was taken, with --wait when it was delivered."""
    text = " ".join(args.text)
    if not text.strip():
        raise CliError('say what? `tidybot fleet say "bring me the red mug"`')

    def tell(line: str) -> None:
        if not args.json:
            print(line, flush=True)

    with desk(args) as d:
        order = Dispatch(d, text, args.robot, tell)
        taken = order.offer()
        if not args.json:
            _explain(order.candidates, order.by)
        end = monotonic() + args.timeout
        while taken and (args.wait or args.hand_over) and not order.follow(args.hand_over):
            if monotonic() > end:
                raise CliError(f"no outcome after {args.timeout:.0f} s")
            sleep(POLL)
    outcome = order.outcome
    if args.json:
        print(msgspec.json.encode(_record(order)).decode())
    elif outcome is not None:
        tell(f"{shown(order.by or '')}: {outcome.outcome}{': ' + outcome.reason if outcome.reason else ''}")
    for name in order.lost:
        tell(f"{shown(name)} is still lost, and would go on with it: `tidybot fleet recall {order.id}` once it is back")
    if not taken or ((args.wait or args.hand_over) and (outcome is None or outcome.outcome != "delivered")):
        return 1
    return 0


def _record(order: Dispatch) -> dict[str, Any]:
    ranked = [{"robot": c.name, "seconds": c.cost if c.able else None, "why": c.why} for c in order.candidates]
    outcome = order.outcome
    return {
        "accepted": order.by is not None,
        "robot": order.by,
        "command_id": order.id,
        "candidates": ranked,
        "outcome": outcome.outcome if outcome is not None else None,
        "reason": outcome.reason if outcome is not None else "",
        "lost": order.lost,
    }


def _explain(candidates: list[Candidate], by: str | None) -> None:
    if not candidates:
        print("no robot is there")
    for one in candidates:
        mark = "->" if one.name == by else "  "
        print(f"{mark} {shown(one.name)}: {f'{one.cost:.0f} s, ' if one.able else ''}{one.why}", flush=True)


def stop(args: argparse.Namespace) -> int:
    """Brake every robot, or those that are named."""
    with desk(args) as d:
        names = set(args.robot) or d.names()
        for name in names:
            d.send(name, topics.ROBOT_STOP, m.RobotStop(reason="fleet stop", source="tidybot fleet"))
        d.look(names, objects=False)  # the answers come after the stops have gone out
    _say_who("stopped", names, args)
    return 0 if names else 1


def _say_who(what: str, names: set[str], args: argparse.Namespace) -> None:
    show(args, sorted(names), [f"{what}: {', '.join(shown(n) for n in sorted(names)) or 'nobody is there'}"])


def recall(args: argparse.Namespace) -> int:
    """Withdraw a command from every robot that is there."""
    with desk(args) as d:
        names = d.names()
        for name in names:
            d.send(name, topics.VOICE_COMMAND, m.VoiceCommand(text="", withdraws=args.id))
        d.look(names, objects=False)
    _say_who("withdrawn from", names, args)
    return 0 if names else 1


def page(args: argparse.Namespace) -> int:
    """One page for all robots, until interrupted."""
    from cli.fleet.page import serve
    from cli.fleet.watch_room import WatchRoom

    with desk(args) as d:
        serve(WatchRoom(d), args.host, args.port)
    return 0


def radio(args: argparse.Namespace) -> int:
    """Print the configuration of a robot's own router, which thins what crosses its radio link."""
    print(router_config(args.to, args.hz), end="")
    return 0


def _options(parser: argparse.ArgumentParser, verb: bool = False) -> None:
    """Add the options of the connection; those after a verb override those before it."""
    kept: Any = argparse.SUPPRESS
    parser.add_argument(
        "--connect", metavar="ENDPOINTS", default=kept if verb else None,
        help="router endpoints (default: the run's, TIDYBOT_CONNECT)",
    )  # fmt: skip
    parser.add_argument(
        "--certificate", metavar="NAME", default=kept if verb else FLEET,
        help=f"where there are keys: whose (default {FLEET})",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", default=kept if verb else False, help="as JSON")


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("fleet", help="several robots: who is where and does what; a command for the best")
    parser.add_argument("--watch", action="store_true", help="look again every second, until Ctrl-C")
    _options(parser)
    parser.set_defaults(run=fleet)
    verbs = parser.add_subparsers(metavar="VERB", parser_class=type(parser))
    one = verbs.add_parser("say", help="a command for the best free robot, and why it is that one")
    one.add_argument("text", nargs="*", help="such as: bring me the red mug")
    one.add_argument("--robot", action="append", default=[], metavar="NAME", help="one of these only (repeatable)")
    one.add_argument("--wait", action="store_true", help="until the mission ends; exit 0 only if it succeeded")
    one.add_argument("--hand-over", action="store_true", help="and give it to another robot if that one is lost")
    one.add_argument("--timeout", type=float, default=1800.0, metavar="S", help="for --wait (default %(default)s)")
    _options(one, verb=True)
    one.set_defaults(run=say)
    one = verbs.add_parser("stop", help="brake every robot")
    one.add_argument("--robot", action="append", default=[], metavar="NAME", help="these only (repeatable)")
    _options(one, verb=True)
    one.set_defaults(run=stop)
    one = verbs.add_parser("recall", help="withdraw a command that was given to the fleet")
    one.add_argument("id", help="the command_id of `fleet say --json`")
    _options(one, verb=True)
    one.set_defaults(run=recall)
    one = verbs.add_parser("radio", help="the configuration of a robot's own router, which thins what crosses WiFi")
    one.add_argument("to", nargs="+", metavar="ENDPOINT", help="the routers to link with: tls/10.0.0.5:7447")
    one.add_argument("--hz", type=float, default=OTHERS, metavar="N", help="of every other stream (%(default)s)")
    one.set_defaults(run=radio)
    one = verbs.add_parser("page", help="one page for all: map, states, questions, a stop for each and for all")
    one.add_argument("--host", default="127.0.0.1", metavar="ADDRESS", help="others need a token (default %(default)s)")
    one.add_argument("--port", type=int, default=8090, metavar="N", help="(default %(default)s)")
    _options(one, verb=True)
    one.set_defaults(run=page)
