"""`tidybot stop`, `resume`: the robot's brake, which the simulation itself holds, and the mission that it cut short."""

import argparse

from cli.errors import CliError
from cli.link import Link, Subscription, linked, robot_command
from common import messages as m
from common import topics

CONFIRM = 3.0
"""Time [s] for the simulation to say that it has stopped or goes on."""


def stop(args: argparse.Namespace) -> int:
    with linked(args) as link:
        brake(link, args.reason, "tidybot")
    print("stopped; `tidybot resume` goes on with the mission, `tidybot resume --cancel` only releases the brake")
    return 0


def brake(link: Link, reason: str, source: str) -> None:
    """Brake base and arm, and return when the simulation says that they stand.

    Raises:
        CliError: it does not in time.
    """
    watch = Subscription(link, topics.SIM_STATUS)
    link.send(topics.ROBOT_STOP, m.RobotStop(reason=reason, source=source))
    _confirm(watch, "stopped")


def resume(args: argparse.Namespace) -> int:
    with linked(args) as link:
        before = link.latest(topics.BRAIN_STATE)
        last = before.last if before is not None else None
        left = last is not None and last.resumable
        watch, states = Subscription(link, topics.SIM_STATUS), Subscription(link, topics.BRAIN_STATE)
        link.send(topics.ROBOT_RESUME, m.RobotResume(source="tidybot", go_on=not args.cancel))
        _confirm(watch, "running")
        begun = states.until(lambda s: bool(s.mission_id), CONFIRM) if left and not args.cancel else None
    command = begun.command if begun is not None else ""
    print(f"running; goes on with {command!r}" if command else "running; no mission is under way")
    return 0


def _confirm(watch: "Subscription[m.SimStatus]", state: str) -> None:
    if watch.until(lambda status: status.state == state, CONFIRM) is None:
        raise CliError(f"the simulation did not confirm within {CONFIRM:.0f} s that it is {state}; see `tidybot ps`")


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(commands, stop, "brake base and arm now; stays so until `resume`", aliases=["stop-robot"])
    parser.add_argument("reason", nargs="?", default="operator")
    parser = robot_command(commands, resume, "release the brake and go on with the mission that was stopped")
    parser.add_argument("--cancel", action="store_true", help="only release the brake; the mission stays cancelled")
