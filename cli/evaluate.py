"""`tidybot eval`: scenarios in lockstep, judged by physics. The work is done by the `evaluation` package."""

import argparse
import os
import sys

from cli.errors import checked
from cli.programs import ROOT

SUITES = ("seed", "fetch", "tidy", "faults", "dialogue", "chaos")
EXAMPLES = """examples:
  tidybot eval --suite seed                                  the five scenarios of the VLA contract, with their logs
  tidybot eval --suite fetch --scenarios 100 --seed 7 --jobs 2
  tidybot eval --suite fetch --scenarios 1 --seed 42 --timeline   repeat the case of seed 42
  tidybot eval --suite tidy --json tidy.json
  tidybot eval --suite fetch --scenarios 3 --processes       the same seeds with every service a process

Case i has the seed SEED + i. Success is what physics shows: lifted, carried in the hand, at rest in the goal region,
no furniture hit, nothing else knocked over. Exit status 0 when every case was run, 130 after Ctrl-C."""


def evaluate(args: argparse.Namespace) -> int:
    """Become `python -m evaluation` with the same words."""
    checked(args.suite, SUITES, "suite")
    words = sys.argv[sys.argv.index("eval") + 1 :]
    path = os.pathsep.join(p for p in (str(ROOT), os.environ.get("PYTHONPATH", "")) if p)
    environment = {"OMP_NUM_THREADS": "1", **os.environ, "PYTHONPATH": path}
    os.execve(sys.executable, [sys.executable, "-m", "evaluation", *words], environment)


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number} is not 1 or more")
    return number


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser(
        "eval", help="random scenarios at full speed, judged by physics", epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("--suite", default="fetch", metavar="NAME", help=f"one of {', '.join(SUITES)} (%(default)s)")
    parser.add_argument("--scenarios", "-n", type=_positive, metavar="N", help="how many (default: the suite's own)")
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="of the first case (default %(default)s)")
    parser.add_argument("--jobs", "-j", type=_positive, default=1, metavar="J", help="worker processes")
    parser.add_argument("--processes", action="store_true", help="every service a process, as with `tidybot up`")
    parser.add_argument("--pipeline", choices=("fetch", "vla"), default="", help="where the suite leaves it open")
    parser.add_argument("--json", metavar="FILE", help="write the report there, - for standard output")
    parser.add_argument("--html", metavar="FILE", help="write a report with plots and pictures of failures, one file")
    parser.add_argument("--timeline", action="store_true", help="print each case's mission log")
    parser.add_argument(
        "--at-least", type=float, default=0.0, metavar="SHARE", help="exit 1 when fewer did as expected"
    )
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value", help="override a parameter")
    parser.set_defaults(run=evaluate)
