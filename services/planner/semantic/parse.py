"""What any sentence most likely means, as plain commands and questions one after the other. Pure.

Where no single form says it all, the sentence is cut at its marks and conjunctions; of all cuts the likeliest counts.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

from common.language.normalise import Words
from services.planner.grammar.chunks import MARK
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.forms import NONE, OTHER, Candidate
from services.planner.semantic.ranker import Ranked, rank

LEAST = 0.3
"""Least probability of what is asked about (chosen on lists left out: below it one in two is meant otherwise)."""
DOUBT = 0.5
"""Weight of the probability that nothing is asked for (chosen: a needless question costs less than a lost request)."""
LONGEST = 60
"""Most words and marks of a sentence that are read (chosen: bounds the time)."""
MOST_CUTS = 5
"""Most places at which a sentence may be cut (chosen: bounds the time to 20 parts)."""
_CONJUNCTIONS = frozenset({MARK, "and", "then", "so", "but", "because", "while", "since", "also", "plus", "though"})


class Part(NamedTuple):
    """Words of a sentence and what they mean; `p`: with how much probability."""

    words: Words
    meant: Candidate
    p: float


def parse(words: Words, vocabulary: Vocabulary) -> list[Part]:
    """The likeliest parts of a sentence in words and marks, in their order; [] for one that is too long."""
    words = _trimmed(words)
    if not words or len(words) > LONGEST:
        return []
    cuts = [at for at, word in enumerate(words) if word in _CONJUNCTIONS and 0 < at < len(words) - 1][:MOST_CUTS]

    @cache
    def ranked(begin: int, end: int) -> tuple[Ranked, ...]:
        return tuple(rank(_trimmed(words[begin:end]), vocabulary))

    @cache
    def best(begin: int) -> tuple[float, list[Part]]:
        found = _option(words, begin, len(words), ranked)
        more = math.log(_share(ranked(begin, len(words)), OTHER))
        for cut in cuts:
            if more <= found[0]:  # no part adds to it: the logarithm of a probability
                break
            if cut > begin and _trimmed(words[begin:cut]) and _trimmed(words[cut:]):
                value, parts = _option(words, begin, cut, ranked)
                if more + value > found[0]:
                    after, others = best(cut)
                    found = max(found, (more + value + after, [*parts, *others]), key=lambda option: option[0])
        return found

    return best(0)[1]


def _option(
    words: Words, begin: int, end: int, ranked: Callable[[int, int], tuple[Ranked, ...]]
) -> tuple[float, list[Part]]:
    of_form: dict[tuple[object, ...], list[Ranked]] = {}
    for one in ranked(begin, end):  # quotations of other lengths say the same
        of_form.setdefault((one.candidate.form, *one.candidate.roles.items()), []).append(one)
    options = [(group[0].candidate, sum(one.p for one in group)) for group in of_form.values()]
    meant, p = max(
        (option for option in options if option[0].form != OTHER),
        key=lambda option: option[1] * (DOUBT if option[0].form == NONE else 1.0),
    )
    return math.log(max(p, 1e-9)), [Part(_trimmed(words[begin:end]), meant, p)]


def _share(ranked: tuple[Ranked, ...], form: str) -> float:
    return max(next(r.p for r in ranked if r.candidate.form == form), 1e-9)


def _trimmed(words: Words) -> Words:
    """Without marks and conjunctions around."""
    begin, end = 0, len(words)
    while begin < end and words[begin] in _CONJUNCTIONS:
        begin += 1
    while begin < end and words[end - 1] in _CONJUNCTIONS:
        end -= 1
    return words[begin:end]
