"""`tidybot stop`, `resume`: the robot's brake, which the simulation itself holds."""

import argparse
from typing import Any

from cli.errors import CliError
from cli.link import Link, Watch, add_options, linked
from common import messages as m
from common import topics
from common.clock import monotonic

CONFIRM = 3.0


def stop(args: argparse.Namespace) -> int:
    with linked(args) as link:
        watch = Watch(link, topics.SIM_STATUS)
        link.send(topics.ROBOT_STOP, m.RobotStop(reason=args.reason, source="tidybot"))
        _confirm(watch, "stopped")
    print("stopped; `tidybot resume` releases the brake")
    return 0


def resume(args: argparse.Namespace) -> int:
    with linked(args) as link:
        watch = Watch(link, topics.SIM_STATUS)
        link.send(topics.ROBOT_RESUME, m.RobotResume(source="tidybot"))
        _confirm(watch, "running")
    print("running")
    return 0


def _confirm(watch: "Watch[m.SimStatus]", state: str) -> None:
    end = monotonic() + CONFIRM
    while monotonic() < end:
        status = watch.next(0.2)
        if status is not None and status.state == state:
            return
    raise CliError(f"the simulation did not confirm within {CONFIRM:.0f} s that it is {state}; see `tidybot ps`")


def query_truth(link: Link) -> dict[str, Any]:
    """`sim/truth`: what is really so, for the demonstration's verdict."""
    answer: dict[str, Any] = link.query(topics.SIM_TRUTH)
    return answer


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("stop", aliases=["stop-robot"], help="brake base and arm now; stays so until `resume`")
    parser.add_argument("reason", nargs="?", default="operator")
    add_options(parser)
    parser.set_defaults(run=stop)
    parser = commands.add_parser("resume", help="release the brake")
    add_options(parser)
    parser.set_defaults(run=resume)
