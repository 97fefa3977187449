"""Output of commands: JSON for programs, lines for people."""

import argparse
from collections.abc import Callable, Iterable
from typing import Any, TextIO

import msgspec

from common import messages as m
from common.time.clock import monotonic

OFTEN, SELDOM = 0.2, 10.0
"""Time [s] between two states of a line of progress on a terminal, and between two lines elsewhere."""


def show(args: argparse.Namespace, value: Any, lines: Iterable[str]) -> None:
    """Print `value` as one line of JSON where `--json` was given, else the `lines` that tell people of it."""
    for line in [msgspec.json.encode(value).decode()] if args.json else lines:
        print(line)


def state_line(state: m.BrainState) -> str:
    """`  12.3 s  NAVIGATING  step  detail`."""
    return "  ".join(w for w in (f"{state.t:8.1f} s  {state.state:11}", state.step, state.detail) if w)


class NewStates:
    """Formats the brain's states, leaving out repetitions."""

    def __init__(self) -> None:
        self._shown: tuple[str, ...] = ()

    def line(self, state: m.BrainState) -> str:
        """The state as a line, "" when nothing but its time is new."""
        now = state.state, state.step, state.detail
        new, self._shown = now != self._shown, now
        return state_line(state) if new else ""


class ProgressLine:
    """One line that renews itself on a terminal, a line now and then elsewhere."""

    def __init__(self, stream: TextIO) -> None:
        self._stream, self._terminal, self._due = stream, stream.isatty(), 0.0

    def show(self, text: Callable[[], str], last: bool = False) -> None:
        """Show the text, when it is due; the `last` one stays."""
        if monotonic() < self._due and not last:
            return
        self._due = monotonic() + (OFTEN if self._terminal else SELDOM)
        begin, end = ("\r\033[K", "") if self._terminal else ("", "\n")
        print(f"{begin}{text()}", end="\n" if last else end, file=self._stream, flush=True)

    def clear(self) -> None:
        """Make room for other text."""
        if self._terminal:
            self._stream.write("\r\033[K")
