"""The model of what people say to the robot (services/speech/recognise/word_ngrams.py), learnt from tests/data.

python -m bench.word_ngrams                 # learns from all lists that may be learnt from and writes its file
python -m bench.word_ngrams --without 34 35 # learns from all the others, and prints what a word of these costs
"""

import math
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench.log_linear import LEAST, arguments
from common import config
from common.language.normalise import normalise
from evaluation.everyday.flat import HOME
from evaluation.everyday.sentences import all_lists
from services.speech.config import SpeechConfig
from services.speech.recognise import word_ngrams

HELD_BACK = frozenset(str(number) for number in range(36, 46))
"""Lists that show what the rest is worth: no model learns from them."""
DISCOUNT = 0.75
"""What is taken from each count (chosen: the usual value)."""
OFTEN = 2
"""Least count of a triple that is kept (chosen: a third of them; what is said once says little)."""
Ngram = tuple[int, ...]


def main() -> int:
    args = arguments(__doc__).parse_args()
    parameters = config.load("speech", SpeechConfig, config.DEFAULT_DIR, {})
    classes = word_ngrams.classes(parameters, HOME, ())
    lists = all_lists()
    said = {k: [tuple(normalise(row.said).split()) for row in rows] for k, rows in lists.items() if k not in HELD_BACK}
    learnt_from = [words for k, rows in said.items() if k not in args.without for words in rows]
    learnt = learn(learnt_from, classes)
    if args.without:
        cost = word_ngrams.WordNgrams(classes, parameters.wake, learnt)
        rest = [" ".join(words) for k in args.without for words in said[k]]
        words = sum(len(text.split()) for text in rest)
        total = sum(cost(text, whole=True) for text in rest) / word_ngrams.WEIGHT
        print(f"{total / words + word_ngrams.PER_WORD:.2f} a word (natural logarithm) in {len(rest)} sentences")
        return 0
    path = Path(word_ngrams.__file__).with_name(word_ngrams.TABLE)
    fields = {name: getattr(learnt, name) for name in learnt._fields[1:]}
    np.savez_compressed(path, words=np.array(list(learnt.words)), **fields)
    print(f"{path}: {path.stat().st_size // 1000} kB, learnt from {len(learnt_from)} sentences")
    return 0


def learn(said: Iterable[tuple[str, ...]], classes: Mapping[str, str]) -> word_ngrams.Table:
    """The model of sentences in words, of which some belong to `classes`."""
    sentences = [tuple(classes.get(word, word) for word in words) for words in said]
    often = Counter(word for words in sentences for word in set(words))
    known = sorted(word for word, times in often.items() if times >= LEAST)
    numbers = {word: k for k, word in enumerate((word_ngrams.START, word_ngrams.END, word_ngrams.OTHER, *known))}
    three: Counter[Ngram] = Counter()
    start = numbers[word_ngrams.START]
    for words in sentences:
        line = (start, start, *(numbers.get(w, numbers[word_ngrams.OTHER]) for w in words), numbers[word_ngrams.END])
        three.update(zip(line, line[1:], line[2:], strict=False))
    two = Counter(gram[1:] for gram in three)
    one = Counter(gram[1:] for gram in two)
    size = len(numbers)
    first, after = _discounted(one, {(k,): 1 / size for k in range(size)}, 1)
    second, after_one = _discounted(two, first, 1)
    third, after_two = _discounted(three, second, OFTEN)
    left = after[()]
    singles = [math.log(first.get((k,), left / size)) for k in range(size)]
    pairs, triples = sorted(second), sorted(third)
    return word_ngrams.Table(
        numbers,
        np.array(singles, np.float16),
        _logs(after_one.get((k,), 1.0) for k in range(size)),
        np.array([a * size + b for a, b in pairs], np.int64),
        _logs(second[pair] for pair in pairs),
        _logs(after_two.get(pair, 1.0) for pair in pairs),
        np.array([(a * size + b) * size + c for a, b, c in triples], np.int64),
        _logs(third[triple] for triple in triples),
    )


def _discounted(
    counts: Mapping[Ngram, int], lower: Mapping[Ngram, float], least: int
) -> tuple[dict[Ngram, float], dict[Ngram, float]]:
    """Probability of each n-gram that is counted `least` times, and what is left for others after its beginning."""
    totals: defaultdict[Ngram, int] = defaultdict(int)
    for gram, count in counts.items():
        totals[gram[:-1]] += count
    left: dict[Ngram, float] = dict.fromkeys(totals, 1.0)
    kept = {gram: count for gram, count in counts.items() if count >= least}
    for gram, count in kept.items():
        left[gram[:-1]] -= (count - DISCOUNT) / totals[gram[:-1]]
    return {
        gram: (count - DISCOUNT) / totals[gram[:-1]] + left[gram[:-1]] * lower[gram[1:] or gram]
        for gram, count in kept.items()
    }, left


def _logs(values: Iterable[float]) -> NDArray[np.float16]:
    return np.log(np.fromiter(values, float)).astype(np.float16)


if __name__ == "__main__":
    sys.exit(main())
