"""Which command a sentence means, with how much probability: a log-linear model over the candidates of forms.py.

Learnt from the labelled sentences of tests/data by `python -m bench.semantic`, from which of the candidates are planned
rightly (Liang, "Learning executable semantic parsers for natural language understanding", 2016). The weights are read
at the first sentence.
"""

from collections.abc import Sequence
from importlib.resources import files
from typing import NamedTuple

from common.language.embedding import beside_features
from common.language.log_linear import Floats, LogLinear, Option
from common.language.normalise import Words
from services.planner.grammar.chunks import MARK, POINTING, Chunk, chunks
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.features import abstracted, features
from services.planner.semantic.forms import Candidate, candidates

WEIGHTS = "weights.npz"
"""Beside this module: what `LogLinear.save` wrote."""
_STANDS_FOR = {"thing": "the thing", "spot": "the table", "time": "a minute"}
"""What a thing, place or time is called in the sentence without names."""


class Ranked(NamedTuple):
    """`p`: the probability of the candidate among all of its sentence."""

    candidate: Candidate
    p: float


def options(
    words: Words, found: Sequence[Chunk], meant: Sequence[Candidate], known: frozenset[str], holds: bool
) -> list[Option]:
    """The candidates of a sentence as the model sees them; `holds`: the hand is not empty."""
    said = abstracted(words, found, known, holds)
    return [Option(c.form, features(said, c)) for c in meant]


def embedding(words: Words, found: Sequence[Chunk]) -> Floats:
    """Of a sentence in words and marks without the names in it, and of all its words: (2 * embedding.SIZE,)."""
    begins = {chunk.begin: chunk for chunk in found}
    bare: list[str] = []
    at = 0
    while at < len(words):
        chunk = begins.get(at)
        if chunk is None:
            bare.append(words[at])
            at += 1
        else:
            bare.append("it" if chunk.text in POINTING else _STANDS_FOR[chunk.kind])
            at = chunk.end
    return beside_features(" ".join(bare), " ".join(word for word in words if word != MARK))


def named(words: Words, vocabulary: Vocabulary) -> list[Chunk]:
    """The things, places and times that a sentence names."""
    return chunks(words, vocabulary, pronouns=True, unlisted=True, alone=True)


class Ranker:
    """The candidates of sentences by a model."""

    def __init__(self, model: LogLinear) -> None:
        self.model = model

    @classmethod
    def shipped(cls) -> "Ranker":
        """The one that this package brings along."""
        return cls(LogLinear.load(files(__package__) / WEIGHTS))

    def rank(self, words: Words, vocabulary: Vocabulary) -> list[Ranked]:
        """All candidates of a sentence in words and marks (`forms.tokens`), the likeliest first."""
        found = named(words, vocabulary)
        meant = candidates(words, found, vocabulary.before)
        p = self.model.probabilities(
            options(words, found, meant, self.model.words, vocabulary.holds), embedding(words, found)
        )
        return sorted(map(Ranked, meant, p.tolist()), key=lambda ranked: -ranked.p)


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
