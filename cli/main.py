"""`tidybot`: start, watch, command and examine the robot."""

import argparse
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from cli import (
    calibrate,
    conform,
    control,
    demo,
    doctor,
    evaluate,
    explain,
    keys,
    map,
    mission,
    missions,
    places,
    record,
    replay,
    robot,
    speech,
    teach,
    topic,
    tree,
    up,
    watch,
)
from cli.agents import command as agents
from cli.errors import CliError, near
from cli.fleet import command as fleet
from common.bus.session import BusError

FAILED, MISUSED, INTERRUPTED = 1, 2, 130
"""Exit statuses: a command failed, was mistyped, or was ended by Ctrl-C (128 + SIGINT)."""


class Parser(argparse.ArgumentParser):
    """Names the nearest command or option after a typo."""

    def error(self, message: str) -> NoReturn:
        word = message.partition("invalid choice: '")[2].partition("'")[0]
        commands = next((a.choices for a in self._actions if isinstance(a, argparse._SubParsersAction)), None)
        if word and commands and "choose from" in message:
            message = f"no command {word!r}{near(word, commands)}"
        elif message.startswith("unrecognized arguments: --"):
            option = message.split()[2].partition("=")[0]
            options = [o for a in self._actions for o in a.option_strings if o.startswith("--")]
            message = f"no option {option}{near(option, options)}"
        self.exit(MISUSED, f"{self.prog}: {message}; `{self.prog} --help` lists what there is\n")


def parser() -> argparse.ArgumentParser:
    """The whole command line."""
    top = Parser(prog="tidybot", description="A voice-commanded mobile manipulator: start it, command it, look inside.")
    commands = top.add_subparsers(required=True, metavar="COMMAND", parser_class=Parser)
    for module in (
        up,
        control,
        mission,
        missions,
        explain,
        speech,
        robot,
        teach,
        places,
        topic,
        tree,
        watch,
        fleet,
        record,
        replay,
        doctor,
        keys,
        map,
        agents,
        calibrate,
        conform,
        demo,
        evaluate,
    ):
        module.register(commands)
    return top


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point; the exit status."""
    top = parser()
    args, rest = top.parse_known_args(argv)
    if rest:
        _sub_parser(top, argv or sys.argv[1:]).error(f"unrecognized arguments: {' '.join(rest)}")
    try:
        return int(args.run(args))
    except (CliError, BusError) as error:
        print(f"tidybot: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader (head, less) has gone; Python would complain again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED


def _sub_parser(top: argparse.ArgumentParser, words: Sequence[str]) -> argparse.ArgumentParser:
    """The parser of the command among `words`, whose options are the ones to suggest."""
    parser = top
    for word in words:
        choices = next((a.choices for a in parser._actions if isinstance(a, argparse._SubParsersAction)), {})
        parser = choices.get(word, parser) if choices else parser
    return parser


if __name__ == "__main__":
    sys.exit(main())
