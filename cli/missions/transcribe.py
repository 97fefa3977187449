"""`tidybot transcribe`: recordings through the speech service's own recogniser."""

import argparse
from pathlib import Path

from cli.processes.programs import become


def transcribe(args: argparse.Namespace) -> int:
    options = ["--json"] if args.json else []
    become("services.speech.transcribe", *options, *(str(path) for path in args.wav))


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("transcribe", help="what the robot understands in recordings, one line a file")
    parser.add_argument("wav", nargs="+", type=Path)
    parser.add_argument("--json", action="store_true", help="as JSON")
    parser.set_defaults(run=transcribe)
