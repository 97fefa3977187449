"""Which command a sentence means, with how much probability: a tuned transformer over the candidates of forms.py.

Learnt from the labelled sentences of tests/data by `python -m bench.semantic`, from which of the candidates are planned
rightly (Liang, "Learning executable semantic parsers for natural language understanding", 2016). The weights are read
at the first sentence.
"""

from functools import cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np

from common.language.normalise import Words
from services.planner.grammar.chunks import Chunk, chunks
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.forms import Candidate, candidates
from services.planner.semantic.network import Network

WEIGHTS = "weights.npz"
"""Beside this module: what `Network.save` wrote."""
TEMPERED = 0.7
"""Weight of the scores (chosen on lists left out: with 1 it is too sure of what is wrong; Guo et al., 2017)."""


class Ranked(NamedTuple):
    """`p`: the probability of the candidate among all of its sentence."""

    candidate: Candidate
    p: float


def named(words: Words, vocabulary: Vocabulary) -> list[Chunk]:
    """The things, places and times that a sentence names."""
    return chunks(words, vocabulary, pronouns=True, unlisted=True, alone=True)


def rank(words: Words, vocabulary: Vocabulary) -> list[Ranked]:
    """All candidates of a sentence in words and marks (`forms.tokens`), the likeliest first."""
    key = vocabulary.new_nouns, words  # parts of a sentence are asked about again in its other readings
    if key not in vocabulary.ranked:
        vocabulary.ranked[key] = _rank(words, vocabulary)
    ranked: list[Ranked] = vocabulary.ranked[key]
    return ranked


def _rank(words: Words, vocabulary: Vocabulary) -> list[Ranked]:
    found = named(words, vocabulary)
    meant = candidates(words, found, vocabulary.before)
    scores = TEMPERED * _shipped().scores(words, found, meant, vocabulary.situation)
    shares = np.exp(scores - scores.max())
    return sorted(map(Ranked, meant, (shares / shares.sum()).tolist()), key=lambda ranked: -ranked.p)


@cache
def _shipped() -> Network:
    """The one that this package brings along."""
    return Network.load(files(__package__) / WEIGHTS)
