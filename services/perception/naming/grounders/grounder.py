"""Grounders of one's own: which of the objects in a picture a phrase means, asked where words alone do not tell."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from common.runtime import StartError
from services.perception.config import PerceptionConfig

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


def load_grounder(config: PerceptionConfig) -> Grounder | None:
    """The grounder of the configuration; None for `words`, with which only words, names and print tell.

    Raises:
        StartError: an unknown name, or what it needs is not there; says what to do.
    """
    # Imported here: each needs packages of an extra that others do without.
    loaders: dict[str, Callable[[PerceptionConfig], Grounder]] = {"clip": _clip, "vision": _vision}
    if config.grounder == "words":
        return None
    if config.grounder not in loaders:
        raise StartError(f"perception.grounder = {config.grounder!r}: expected words, clip or vision")
    try:
        return loaders[config.grounder](config)
    except (GrounderError, ImportError, OSError) as error:
        raise StartError(f"perception.grounder = {config.grounder!r}: {error}") from None


def _clip(config: PerceptionConfig) -> Grounder:
    from services.perception.naming.grounders.clip import Clip

    return Clip(config.clip_model, config.clip_least)


def _vision(config: PerceptionConfig) -> Grounder:
    from services.perception.naming.grounders.vision import Vision

    return Vision(config.vision_url, config.vision_model, config.vision_key, config.vision_timeout)
