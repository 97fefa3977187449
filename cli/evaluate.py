"""`tidybot eval`: scenarios in lockstep, judged by physics. The work is done by the `evaluation` package."""

import argparse
import sys
from pathlib import Path

from cli.errors import CliError, number
from cli.processes.plan import add_machine_options
from cli.processes.programs import become

EXAMPLES = """examples:
  tidybot eval --suite seed                                  the five scenarios of the VLA contract, with their logs
  tidybot eval --suite fetch --scenarios 100 --seed 7 --jobs 2
  tidybot eval --suite fetch --scenarios 1 --seed 42 --timeline   repeat the case of seed 42
  tidybot eval --suite tidy --json tidy.json
  tidybot eval --suite fetch --scenarios 3 --processes       the same seeds with every service a process
  tidybot eval --suite commands                              every line of docs/COMMANDS.md, judged by its effect
  tidybot eval --suite spoken -n 20 --voices DIR --snr 10    recordings with a manifest.tsv, from sound to delivery
  tidybot eval --suite clutter -n 8                          things of which nobody told the robot; also sizes, lying
  tidybot eval --world examples/worlds                       worlds from outside, and what is asked for in each
  tidybot eval -n 1000 --cluster tcp://HOST:8786             on the workers of a Dask scheduler; local: some here

Case i has the seed SEED + i. Success is what physics shows: lifted, carried in the hand, upright and at rest in the
goal region, no furniture hit, nothing else moved by 3 cm or knocked over. Every success that the robot claims at any
time is held against physics at that time. Exit status 0 when the suite's bar is met, 1 when a claim was false or fewer
cases ended as expected, 130 after Ctrl-C."""


def evaluate(args: argparse.Namespace) -> int:
    """Become `python -m evaluation` with the same words."""
    if (args.voices or args.snr is not None) and args.suite != "spoken":
        raise CliError("--voices and --snr are for --suite spoken")
    if args.replace and args.processes:
        raise CliError("--replace works in one process; leave --processes out")
    if args.cluster and args.cluster != "local" and not args.cluster.startswith(("tcp://", "tls://")):
        raise CliError(f"--cluster {args.cluster}: expected tcp://HOST:PORT of a Dask scheduler, or local")
    if args.world and not args.world.is_dir():
        raise CliError(f"--world {args.world}: no such directory; docs/WORLDS.md has what it holds")
    words = sys.argv[sys.argv.index("eval") + 1 :]
    become("evaluation", *words)


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser(
        "eval", help="random scenarios at full speed, judged by physics", epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("--suite", default="fetch", metavar="NAME", help="one of those that --list shows (%(default)s)")
    parser.add_argument("--list", action="store_true", help="the suites, what a case of each is, and its bar")
    parser.add_argument("--world", type=Path, metavar="DIR", help="worlds of your own instead (docs/WORLDS.md)")
    parser.add_argument("--scenarios", "-n", type=number(1), metavar="N", help="how many (default: the suite's own)")
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="of the first case (default %(default)s)")
    parser.add_argument("--jobs", "-j", type=number(1), default=1, metavar="J", help="worker processes")
    parser.add_argument(
        "--cluster", metavar="ADDRESS", help="a Dask scheduler such as tcp://HOST:8786; `local` starts J workers here"
    )
    parser.add_argument("--voices", type=Path, metavar="DIR", help="recordings and manifest.tsv for the suite spoken")
    level, share = number(-20, 80, "dB", whole=False), number(0, 1, whole=False)
    parser.add_argument("--snr", type=level, metavar="DB", help="signal-to-noise ratio of the suite spoken (20)")
    parser.add_argument("--processes", action="store_true", help="every service a process, as with `tidybot up`")
    parser.add_argument("--pipeline", choices=("fetch", "vla"), default="", help="where the suite leaves it open")
    parser.add_argument("--json", metavar="FILE", help="write the report there, - for standard output")
    parser.add_argument("--html", metavar="FILE", help="write a report with plots and pictures of failures, one file")
    parser.add_argument("--timeline", action="store_true", help="print each case's mission log")
    parser.add_argument(
        "--at-least", type=share, metavar="SHARE", help="exit 1 when fewer did as expected (default: the suite's bar)"
    )
    parser.add_argument(
        "--replace", action="append", default=[], metavar="MODULE:CLASS", help="a class of yours in a service's place"
    )
    add_machine_options(parser)
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value", help="override a parameter")
    parser.set_defaults(run=evaluate)
