"""`tidybot transcribe`: recordings through the speech service's own recogniser."""

import argparse
import os
import subprocess
import sys
from pathlib import Path

from common.installation import ROOT

MODULE = "services.speech.transcribe"


def transcribe(args: argparse.Namespace) -> int:
    options = ["--json"] if args.json else []
    words = [str(path) for path in args.wav]
    path = os.pathsep.join(p for p in (str(ROOT), os.environ.get("PYTHONPATH", "")) if p)
    environment = {**os.environ, "PYTHONPATH": path}
    return subprocess.run([sys.executable, "-m", MODULE, *options, *words], env=environment).returncode


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("transcribe", help="what the robot understands in recordings, one line a file")
    parser.add_argument("wav", nargs="+", type=Path)
    parser.add_argument("--json", action="store_true")
    parser.set_defaults(run=transcribe)
