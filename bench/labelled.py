"""What the network that ranks meanings learns from: sentences with their candidates, and which of those are right."""

from typing import NamedTuple

from services.planner.grammar.chunks import Chunk
from services.planner.semantic.forms import Candidate


class Labelled(NamedTuple):
    """A sentence of a list with its candidates; `right`: those that are planned as it means (n,).

    `situation`: words for what is held or was done before.
    """

    list: str
    words: tuple[str, ...]
    found: list[Chunk]
    meant: list[Candidate]
    right: list[bool]
    situation: tuple[str, ...]
