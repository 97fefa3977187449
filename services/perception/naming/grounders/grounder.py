"""Grounders of one's own: which of the objects in a picture a phrase means, asked where words alone do not tell."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Box = tuple[int, int, int, int]
"""Left, top, right, bottom [pixels] in the picture."""


@dataclass(frozen=True)
class Candidate:
    """An object in the picture: its id and label in `world/objects`, and where it is."""

    key: str
    label: str
    box: Box


@dataclass(frozen=True)
class Question:
    """Which of the `candidates` in the `picture` (h, w, 3) does the `phrase` mean?"""

    phrase: str
    picture: NDArray[np.uint8]
    candidates: tuple[Candidate, ...]


@dataclass(frozen=True)
class Choice:
    """The candidate that is meant by its `key`, "" for none; `confidence` 0 to 1, `detail` says why."""

    key: str = ""
    confidence: float = 0.0
    detail: str = ""


class GrounderError(Exception):
    """No answer: why, in a few words."""


class Grounder(Protocol):
    """Runs in the worker."""

    def choose(self, question: Question) -> Choice:
        """Answer a question.

        Raises:
            GrounderError: it could not be asked, or its answer is no answer.
        """
