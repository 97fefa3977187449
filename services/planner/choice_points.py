"""Choice points of a plan, so that a rejected plan is followed by the next best one. Pure."""

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")
MAX_RUNS = 64
"""Most combinations of choices that are tried (chosen: far more than a mission has attempts)."""


class ChoicePoints:
    """Answers each choice with the option that the script names, the first where the script ends."""

    def __init__(self, script: Sequence[int] = ()) -> None:
        self._script = tuple(script)
        self.taken: list[tuple[int, int]] = []

    def pick(self, options: Sequence[T]) -> T:
        at = len(self.taken)
        chosen = self._script[at] if at < len(self._script) else 0
        chosen = min(chosen, len(options) - 1)
        self.taken.append((chosen, len(options)))
        return options[chosen]

    def fork(self) -> "ChoicePoints":
        """The same script, going on from the same point."""
        other = ChoicePoints(self._script)
        other.taken = list(self.taken)
        return other


def every(run: Callable[[ChoicePoints], R]) -> Iterator[R]:
    """The results of `run` for every combination of choices, the preferred first, at most MAX_RUNS of them."""
    script: list[int] | None = []
    for _ in range(MAX_RUNS):
        if script is None:
            return
        choices = ChoicePoints(script)
        yield run(choices)
        script = _after(choices.taken)


def _after(taken: list[tuple[int, int]]) -> list[int] | None:
    """The next script in order: the last choice that has options left moves on."""
    for at in range(len(taken) - 1, -1, -1):
        chosen, number = taken[at]
        if chosen + 1 < number:
            return [c for c, _ in taken[:at]] + [chosen + 1]
    return None
