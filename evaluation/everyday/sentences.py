"""The lists of everyday sentences in tests/data."""

from pathlib import Path
from typing import NamedTuple

DATA = Path(__file__).resolve().parents[2] / "tests" / "data" / "sentences.tsv"
LEARNING = DATA.with_name("learning.tsv")


class Sentence(NamedTuple):
    context: str
    said: str
    right: str


def lists(path: Path = DATA) -> dict[str, list[Sentence]]:
    """The rows of tests/data/sentences.tsv, or of another such file, by the number of their list."""
    found: dict[str, list[Sentence]] = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            number, *row = line.split("\t")
            found.setdefault(number, []).append(Sentence(*row))
    return found


def all_lists() -> dict[str, list[Sentence]]:
    """The lists that are tested, and those that are only learnt from."""
    return {**lists(), **lists(LEARNING)}
