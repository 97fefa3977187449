"""`tidybot`: start, watch, command and examine the robot."""

import argparse
import importlib
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from cli.errors import CliError, near
from common.bus.session import BusError
from common.config import ConfigError

COMMANDS = {
    "processes.up": ("up",),
    "processes.control": ("down", "ps", "restart", "logs"),
    "missions.say": ("say", "status"),
    "missions.journal": ("missions",),
    "missions.explain": ("explain",),
    "missions.transcribe": ("transcribe",),
    "robot": ("stop", "stop-robot", "resume"),
    "home.teach": ("teach", "forget"),
    "home.places": ("places", "rules"),
    "topic": ("topic",),
    "watch": ("watch",),
    "fleet.command": ("fleet",),
    "recordings.record": ("record",),
    "recordings.replay": ("replay",),
    "doctor": ("doctor",),
    "keys.command": ("keys",),
    "home.map": ("map",),
    "agents.command": ("mcp",),
    "cameras.calibrate": ("calibrate",),
    "drivers.conform": ("conform",),
    "missions.demo": ("demo",),
    "evaluate": ("eval",),
}
"""Which module of this package declares which commands, in the order of the help."""

FAILED, MISUSED, INTERRUPTED = 1, 2, 130
"""Exit statuses: a command failed, was mistyped, or was ended by Ctrl-C (128 + SIGINT)."""


class Commands(argparse._SubParsersAction):  # type: ignore[type-arg]
    """Commands whose own help begins with the line that the list of all commands has."""

    def add_parser(self, name: str, **more: Any) -> Any:
        what = more["help"]
        return super().add_parser(name, **{"description": f"{what[0].upper()}{what[1:]}.", **more})


class Parser(argparse.ArgumentParser):
    """Names the nearest command or option after a typo."""

    def __init__(self, **more: Any) -> None:
        super().__init__(**more)
        self.register("action", "parsers", Commands)

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


def parser(command: str = "") -> argparse.ArgumentParser:
    """The whole command line, or the part that declares `command`: some import what the others have no use for."""
    top = Parser(prog="tidybot", description="A voice-commanded mobile manipulator: start it, command it, look inside.")
    commands = top.add_subparsers(required=True, metavar="COMMAND", parser_class=Parser)
    for module in [name for name, declared in COMMANDS.items() if command in declared] or COMMANDS:
        importlib.import_module(f"cli.{module}").register(commands)
    return top


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point; the exit status."""
    words = sys.argv[1:] if argv is None else argv
    top = parser(words[0] if words else "")
    args, rest = top.parse_known_args(words)
    if rest:
        _sub_parser(top, words).error(f"unrecognized arguments: {' '.join(rest)}")
    try:
        return int(args.run(args))
    except (CliError, BusError, ConfigError) as error:
        print(f"tidybot: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader (head, less) has gone; Python would complain again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except OSError as error:
        if error.filename is None:
            raise  # nothing that was named on the command line
        print(f"tidybot: {error.filename}: {error.strerror}", file=sys.stderr)
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
