"""`tidybot calibrate`: measures the cameras' mounts from pictures of the arm and of what both cameras see."""

import argparse
from pathlib import Path

from cli.errors import CliError, number
from cli.link import linked, robot_command
from common import topics

NEEDED = ("sim", "camera")


def calibrate(args: argparse.Namespace) -> int:
    """Check the options, then measure; imports the numerical libraries that other commands do without."""
    if args.out.exists() and not args.force:
        raise CliError(f"{args.out} is there already; --force writes over it")
    with linked(args) as link:
        if lacking := [name for name in NEEDED if name not in link.alive()]:
            raise CliError(f"{' and '.join(lacking)} must be up; see `tidybot ps`")
        state = link.latest(topics.BRAIN_STATE)
        if state is not None and state.command:
            raise CliError(f"the robot is at work ({state.command}); `tidybot stop` ends that")
        from cli.cameras.measure import run

        return run(link, args.out, args.poses)


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(
        commands,
        calibrate,
        "where the cameras really sit: the arm moves, 0.9 m around the robot must be free above 0.35 m",
    )
    parser.add_argument("--out", type=Path, default=Path("calibration.toml"), metavar="FILE", help="(%(default)s)")
    parser.add_argument("--force", action="store_true", help="write over FILE")
    parser.add_argument(
        "--poses", type=number(4, 40), default=8, metavar="N", help="of the arm, for each camera (%(default)s)"
    )
