"""Printed words: what was read on an object over several looks, and whether it is what somebody asked for. Pure.

Words are compared by rapidfuzz, which is there where something can be read (the extra `ocr`).
"""

import re
from collections.abc import Collection, Iterable, Sequence
from typing import NamedTuple

from common.naming.names import normalise
from common.naming.small_print import telling

MAX_LINES = 12
"""Lines kept of one object. Chosen: more than a package shows of its front in letters that can be read."""
SAME_LINE = 75.0
"""Likeness (of 100) from which two readings are of one line."""
SHORT = 3
"""Letters up to which a word has to be read exactly: "tea" is one letter from "pea" and "ten"."""
SURE, LIKELY = 0.85, 0.72
"""Likeness of the words asked for to what was read, from which it is that and from which a nearer look is worth it.
Chosen: one wrong letter in seven, and one in four."""
WORST_WORD = 0.7
"""Likeness that each of the words must have: "tomato" to "potato" has .67."""
ALIKE = ("nwmh", "hrkax", "ocqdg0", "iltj1", "tfyr", "efb", "uvy", "s58b", "prfd", "ceo", "gs6")
"""Letters that small print makes look alike: "NATER" and "WATEH" were read for "WATER"."""
MISTAKEN = 0.65
"""What one of them in place of another counts, where any other letter counts 1. Chosen: one in five letters is no
doubt, one in four is."""


ROUND = 0.95
"""What a word counts whose parts alone were read. Chosen: surer than a wrong letter in seven."""


class Line(NamedTuple):
    """A line as read, and how sure of it the reader is, 0 to 1."""

    text: str
    confidence: float


def merged(known: Sequence[Line], read: Iterable[Line]) -> list[Line]:
    """Lines of several looks; of two readings of one line the longer or surer counts."""
    from rapidfuzz import fuzz

    lines = list(known)
    for line in read:
        alike = [i for i, other in enumerate(lines) if fuzz.ratio(line.text.lower(), other.text.lower()) >= SAME_LINE]
        if not alike:
            lines.append(line)
        elif _worth(line) > _worth(lines[alike[0]]):
            lines[alike[0]] = line
    return sorted(lines, key=_worth, reverse=True)[:MAX_LINES]


def _worth(line: Line) -> float:
    """What goes around a can is read a part at a time: of two readings the longer one says more."""
    return line.confidence * len(line.text)


def sure_words(lines: Iterable[Line]) -> list[str]:
    """The words of lines that were read for sure, and that not every pack has."""
    return [w for line in lines if line.confidence >= SURE for w in telling(line.text)]


def parts(lines: Iterable[Line]) -> list[str]:
    """The words of lines that were read for sure, and what may be parts of such: of a can's print the end is seen."""
    return [w for line in lines if line.confidence >= SURE for w in normalise(line.text).split() if len(w) >= SHORT]


def shown(lines: Iterable[Line]) -> str:
    """What was read, for `WorldObject.text`."""
    return " / ".join(line.text for line in lines)


def likeness(words: Sequence[str], text: str, said: Collection[str] = ()) -> float:
    """How much the text reads like all of the words, 0 to 1; 0 when one of them is not there.

    A word may be broken or glued to its neighbours in the text, and a letter in seven may be wrong. `said`: words that
    may be such neighbours, so that "greentea" has "tea" in it and "steam" has not.
    """
    tokens = [part for token in normalise(text).split() for part in _parted(token, {*words, *said})]
    if not tokens or not words:
        return 0.0
    glued = "".join(tokens)
    found = [_word_in(word, tokens, glued) for word in words]
    if min(found) < WORST_WORD:
        return 0.0
    return sum(f * len(w) for f, w in zip(found, words, strict=True)) / sum(map(len, words))


def traces(words: Sequence[str], text: str) -> float:
    """How much of the words stands in the text, 0 to 1, though others of them, or their ends, do not."""
    from rapidfuzz import fuzz

    tokens = [t for t in normalise(text).split() if len(t) >= SHORT]
    parts = [max((fuzz.partial_ratio(t, w) / 100 for t in tokens if len(t) <= len(w)), default=0.0) for w in words]
    return max(parts, default=0.0)


def _word_in(word: str, tokens: Sequence[str], glued: str) -> float:
    """Likeness of a word to the part of the text that is most like it."""
    if len(word) <= SHORT:
        return float(word in tokens)
    from rapidfuzz import fuzz

    best = max(_similarity(form, token) for token in tokens for form in _forms(word))
    best = max(best, ROUND * _covered(word, tokens))
    within = fuzz.partial_ratio(word, glued) / 100 if len(glued) >= len(word) else 0.0
    # Found within other words it may be a chance: "rice" is in "price".
    return float(max(best, within * 0.95))


def _parted(token: str, words: Collection[str]) -> list[str]:
    """A token as the words that it is glued of, or as it is."""
    first = next((w for w in sorted(words, key=len, reverse=True) if w and token.startswith(w)), "")
    if not first or first == token:
        return [token]
    rest = _parted(token.removeprefix(first), words)
    return [first, *rest] if all(part in words for part in rest) else [token]


def _covered(word: str, tokens: Sequence[str]) -> float:
    """Share of a word's letters that stand in tokens which are parts of it: what goes around a can is read as "hon"
    from one side and "ney" from another."""
    letters: set[int] = set()
    for token in tokens:
        if SHORT <= len(token) < len(word) and (at := word.find(token)) >= 0:
            letters |= set(range(at, at + len(token)))
    return len(letters) / len(word)


def _similarity(word: str, read: str) -> float:
    """1 less the edit distance to a word as read, as a share of the longer one; letters that look alike count less."""
    row = [float(n) for n in range(len(read) + 1)]
    for n, letter in enumerate(word, 1):
        before, row[0] = row[0], float(n)
        for k, other in enumerate(read, 1):
            before, row[k] = row[k], min(row[k] + 1.0, row[k - 1] + 1.0, before + _mistaken(letter, other))
    return 1.0 - row[-1] / max(len(word), len(read))


def _mistaken(a: str, b: str) -> float:
    if a == b:
        return 0.0
    return MISTAKEN if any(a in letters and b in letters for letters in ALIKE) else 1.0


def _forms(word: str) -> tuple[str, ...]:
    """A word and its plural or singular: people ask for corn flakes and for a corn flake."""
    return (word, word.removesuffix("s")) if word.endswith("s") else (word, f"{word}s")


def printed_words(query: str, common: Iterable[str]) -> list[str]:
    """The words of a query that a label could have: those that are not `common` words, which name kinds, colours,
    places and relations."""
    plain = {w for phrase in common for w in normalise(phrase).split()}
    return [w for w in normalise(query).split() if w not in plain and not re.fullmatch(r"\d", w)]
