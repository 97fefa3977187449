"""How much people say what to the robot: a trigram model of words, for transcriptions that sound alike.

Absolute discounting (Ney, Essen and Kneser, "On structuring probabilistic dependences in stochastic language
modelling", 1994) over words, with one class each for things, their plurals, places and colours, so that any household's
names are expected where the learnt ones were (Brown et al., "Class-based n-gram models of natural language", 1992).
Shallow fusion with the network (Gulcehre et al., "On using monolingual corpora in neural machine translation", 2015).
`python -m bench.word_ngrams` learns it.
"""

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from functools import cache, lru_cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from common.household import Household
from common.language.spoken import BETWEEN
from services.speech.config import SpeechConfig
from services.speech.recognise.grammar import vocabulary
from services.speech.recognise.token_trie import letters
from services.speech.recognise.wake_text import without_wake

TABLE = "word_ngrams.npz"
"""Beside this module: what `bench.word_ngrams` wrote."""
WEIGHT = 0.2
"""Weight of the model's logarithm beside the network's (chosen on six voices, quiet, in babble and in echoes)."""
PER_WORD = 3.0
"""Natural logarithm that is granted for each word (chosen: with none a sentence that breaks off is cheapest, with the
4.8 that a word of sentences left out costs on average one that is said twice)."""
UNKNOWN = math.log(3000)
"""What it costs which unknown word it is, a negative logarithm (chosen: as many as are known)."""
START, END, OTHER = "<s>", "</s>", "<unknown>"
SHORTEST = 3
"""Letters of the shortest word of a name that counts as one (chosen: shorter ones are words of any sentence)."""
KEPT = 4_000
"""Texts whose cost is kept [count]; chosen: those of an utterance, some MB."""
_PARTS = {"colour": "<colour>", "object": "<thing>", "place": "<place>", "surface": "<place>", "container": "<place>"}
PLURAL = "<things>"
State = tuple[int, int]


class Table(NamedTuple):
    """`words`: the number of each; `one` (V,), `two`, `three`: natural logarithms of probabilities of words, pairs and
    triples, the latter by sorted keys; `after_one` (V,), `after_two`: what is left for others after a word or pair."""

    words: dict[str, int]
    one: NDArray[np.float16]
    after_one: NDArray[np.float16]
    pairs: NDArray[np.int64]
    two: NDArray[np.float16]
    after_two: NDArray[np.float16]
    triples: NDArray[np.int64]
    three: NDArray[np.float16]


@cache
def table() -> Table:
    """The shipped model."""
    with (files(__package__) / TABLE).open("rb") as file, np.load(file) as stored:
        words = {str(word): k for k, word in enumerate(stored["words"])}
        return Table(words, **{name: stored[name] for name in Table._fields[1:]})


class WordNgrams:
    """Costs of sentences of a household with these `classes` of words; `wake`: what may stand before a sentence."""

    def __init__(self, classes: Mapping[str, str], wake: Iterable[str], learnt: Table | None = None) -> None:
        self._table, self._classes, self._wake = learnt or table(), classes, tuple(wake)
        self._sizes = Counter(classes.values())
        self._words = lru_cache(KEPT)(self._words_of)
        self._costs = lru_cache(KEPT)(self._costs_of)
        self._log = lru_cache(KEPT)(self._log_of)

    def __call__(self, text: str, whole: bool = False) -> float:
        """Cost of the words of a text, or of the `whole` sentence."""
        total, state = self._costs(self._words(text))
        return total - WEIGHT * self._log(self._table.words[END], state) if whole else total

    def _words_of(self, text: str) -> tuple[str, ...]:
        return tuple(without_wake(letters(text), self._wake).split())

    def _costs_of(self, words: tuple[str, ...]) -> tuple[float, State]:
        if not words:
            return 0.0, (self._table.words[START],) * 2
        *before, word = words
        total, state = self._costs(tuple(before))
        kind = self._classes.get(word, word)
        number = self._table.words.get(kind, self._table.words[OTHER])
        which = math.log(self._sizes[kind]) if kind in self._sizes else 0.0
        which = UNKNOWN if number == self._table.words[OTHER] else which
        return total - WEIGHT * (self._log(number, state) - which + PER_WORD), (state[1], number)

    def _log_of(self, number: int, state: State) -> float:
        """Natural logarithm of the probability of a word after two others."""
        learnt, (first, second) = self._table, state
        before = first * len(learnt.one) + second
        k = _find(learnt.triples, before * len(learnt.one) + number)
        if k is not None:
            return float(learnt.three[k])
        j = _find(learnt.pairs, before)
        left = 0.0 if j is None else float(learnt.after_two[j])
        k = _find(learnt.pairs, second * len(learnt.one) + number)
        if k is not None:
            return left + float(learnt.two[k])
        return left + float(learnt.after_one[second]) + float(learnt.one[number])


def classes(config: SpeechConfig, household: Household, names: Iterable[str]) -> dict[str, str]:
    """The class of each word of the names of things, places and colours that is no word of any sentence."""
    parts = vocabulary(household, (*config.objects, *names), config.places, config.colours)
    found: dict[str, str] = {}
    for part, kind in _PARTS.items():
        for word in (word for name in parts[part] for word in name.split()):
            if len(word) < SHORTEST or (word in BETWEEN and part != "colour"):
                continue
            several = word.endswith("s")
            found.setdefault(word, PLURAL if several and part == "object" else kind)
            if part == "object" and not several:
                found.setdefault(f"{word}{'es' if word[-1] in 'xh' else 's'}", PLURAL)
    return found


def _find(keys: NDArray[np.int64], key: int) -> int | None:
    k = int(np.searchsorted(keys, key))
    return k if k < len(keys) and keys[k] == key else None
