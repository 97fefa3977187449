"""Errors that the command line shows as one line, and suggestions for mistyped words."""

import argparse
from collections.abc import Iterable
from difflib import get_close_matches


class CliError(Exception):
    """Shown as `tidybot: <text>`; exit status 1."""


def near(word: str, known: Iterable[str]) -> str:
    """` (did you mean 'x'?)` for the closest known word, `; known: ...` when none is close."""
    known = list(known)
    close = get_close_matches(word, known, n=3, cutoff=0.5)
    if close:
        return "; did you mean " + " or ".join(repr(c) for c in close) + "?"
    return f"; known: {', '.join(known)}"


def checked(word: str, known: Iterable[str], what: str) -> str:
    """The word itself when known.

    Raises:
        CliError: unknown; names the nearest.
    """
    known = list(known)
    if word not in known:
        raise CliError(f"no {what} {word!r}{near(word, known)}")
    return word


def port_number(text: str) -> int:
    """The type of a `--port` option.

    Raises:
        argparse.ArgumentTypeError: not a port that a program can listen on.
    """
    if not text.isdecimal() or not 0 < int(text) < 65536:
        raise argparse.ArgumentTypeError(f"{text!r}: expected 1 to 65535")
    return int(text)
