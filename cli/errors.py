"""Errors that the command line shows as one line, and suggestions for mistyped words."""

import argparse
import math
from collections.abc import Callable, Iterable
from difflib import get_close_matches
from typing import Any

SHOWN = 20
"""Known words that a message lists; chosen: all services, suites and fields, and not all topics."""


class CliError(Exception):
    """Shown as `tidybot: <text>`; exit status 1."""


def near(word: str, known: Iterable[str]) -> str:
    """` (did you mean 'x'?)` for the closest known word, `; known: ...` (the first of many) when none is close."""
    known = list(known)
    close = get_close_matches(word, known, n=3, cutoff=0.5)
    if close:
        return "; did you mean " + " or ".join(repr(c) for c in close) + "?"
    more = [f"and {len(known) - SHOWN} more"] if len(known) > SHOWN + 1 else []
    return f"; known: {', '.join([*known[: SHOWN if more else None], *more])}"


def checked(word: str, known: Iterable[str], what: str) -> str:
    """The word itself if it is one of the known ones.

    Raises:
        CliError: unknown; names the nearest.
    """
    known = list(known)
    if word not in known:
        raise CliError(f"no {what} {word!r}{near(word, known)}")
    return word


def number(low: float, high: float = math.inf, unit: str = "", whole: bool = True) -> Callable[[str], Any]:
    """The type of an option that takes a number from `low` to `high`, a `whole` one or a fraction as well."""
    upper = f"to {high:.10g}" if math.isfinite(high) else "or more"

    def read(text: str) -> int | float:
        try:
            value = int(text) if whole else float(text)
        except ValueError:
            value = math.nan
        if not (low <= value <= high and math.isfinite(value)):
            raise argparse.ArgumentTypeError(f"{text!r}: expected {low:.10g} {upper} {unit}".rstrip())
        return value

    return read


port_number = number(1, 65535)
"""The type of a `--port` option: what a program can listen on."""
