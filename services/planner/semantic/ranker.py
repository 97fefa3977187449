"""Which command a sentence means, with how much probability: a log-linear model over the candidates of forms.py.

Learnt from the labelled sentences of tests/data by `python -m bench.semantic`, from which of the candidates are planned
rightly (Liang, "Learning executable semantic parsers for natural language understanding", 2016). The weights are read
at the first sentence.
"""

from importlib.resources import files
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from common.language.normalise import Words
from services.planner.grammar.chunks import chunks
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.features import abstracted, features
from services.planner.semantic.forms import Candidate, candidates

WEIGHTS = "weights.npz"
"""Beside this module: `weights` (2**BITS,) int8, `scale` of one step of them, and the `words` that were learnt from."""


class Ranked(NamedTuple):
    """`p`: the probability of the candidate among all of its sentence."""

    candidate: Candidate
    p: float


class Ranker:
    """The model; `words` are those that it knows, all others count as one."""

    def __init__(self, weights: npt.NDArray[np.float32], words: frozenset[str]) -> None:
        self._weights, self._words = weights, words

    @classmethod
    def shipped(cls) -> "Ranker":
        """The one that this package brings along."""
        with (files(__package__) / WEIGHTS).open("rb") as file, np.load(file) as stored:
            weights = stored["weights"].astype(np.float32) * stored["scale"]
            return cls(weights, frozenset(bytes(stored["words"]).decode().split()))

    def rank(self, words: Words, vocabulary: Vocabulary) -> list[Ranked]:
        """All candidates of a sentence in words and marks (`forms.tokens`), the likeliest first."""
        found = chunks(words, vocabulary, pronouns=True, unlisted=True)
        said = abstracted(words, found, self._words)
        meant = candidates(found)
        scores = np.array([self._weights[features(said, c)].sum() for c in meant])
        shares = np.exp(scores - scores.max())
        shares /= shares.sum()
        return sorted(map(Ranked, meant, shares.tolist()), key=lambda ranked: -ranked.p)


_MODELS: list[Ranker] = []
"""The model in use, once there is one."""


def use(model: Ranker | None) -> None:
    """Rank by another model than the shipped one, or with None by the shipped one again."""
    _MODELS[:] = [model] if model else []


def rank(words: Words, vocabulary: Vocabulary) -> list[Ranked]:
    """`Ranker.rank` of the model in use."""
    if not _MODELS:
        use(Ranker.shipped())
    return _MODELS[0].rank(words, vocabulary)
