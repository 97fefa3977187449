"""What commands print: for programs with `--json`, else for people."""

import argparse
from collections.abc import Iterable
from typing import Any

import msgspec


def show(args: argparse.Namespace, value: Any, lines: Iterable[str]) -> None:
    """Print `value` as one line of JSON where `--json` was given, else the `lines` that tell people of it."""
    for line in [msgspec.json.encode(value).decode()] if args.json else lines:
        print(line)
