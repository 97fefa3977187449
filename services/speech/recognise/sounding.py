"""Correction of misheard words by their sound: `bring me the read mugg` to `bring me the red mug`. Pure.

Editex, of J. Zobel and P. Dart, "Phonetic String Matching: Lessons from Information Retrieval", SIGIR 1996: an edit
distance in which letters of one group sound alike.
"""

from collections.abc import Container, Iterable
from functools import cache

_GROUPS = ("aeiouy", "bp", "ckq", "dt", "lr", "mn", "gj", "fpv", "sxz", "csz")
_ALIKE = frozenset((a, b) for group in _GROUPS for a in group for b in group)
_SILENT = frozenset("hw")
SAME, ALIKE, OTHER = 0, 1, 2
"""Distance of two letters, in halves of one letter that is wholly another."""
NEAR = 0.25
"""Most distance per letter of the longer word, in letters wholly other, at which a word may be another one misheard
(chosen)."""
VERY_NEAR = 0.125
"""The same where the words as they were heard could be meant, too (chosen: one letter of four that sounds alike)."""
SHORTEST = 3
"""Letters of the shortest word that is compared (chosen: shorter ones all sound alike)."""
MOST = 2
"""Most words of one sentence that are taken for misheard (chosen: with more of them it says something else)."""


def resounded(words: list[str], known: Container[str], heard: Iterable[str], near: float = NEAR) -> list[str] | None:
    """The words with each one that is not `known` replaced by the one of `heard` that is nearest in sound.

    None where nothing is exchanged, where a word sounds like none or like two of them, and where too many are unknown.
    """
    strange = [w for w in words if w not in known and not w.isdigit()]
    if not 0 < len(strange) <= MOST:
        return None
    options = frozenset(heard)
    instead = {word: _nearest(word, options, near) for word in strange}
    return None if None in instead.values() else [instead.get(w) or w for w in words]


def _nearest(word: str, known: frozenset[str], near: float) -> str | None:
    if len(word) < SHORTEST:
        return None
    far = sorted((editex(word, k) / max(len(word), len(k)), k) for k in known if len(k) >= SHORTEST)[:2]
    if not far or far[0][0] > OTHER * near or (len(far) > 1 and far[1][0] == far[0][0]):
        return None
    return far[0][1]


@cache
def editex(a: str, b: str) -> int:
    """Phonetic distance of two words: 0 for the same, up to 2 for each letter that differs."""
    rows = [[0]]
    for j in range(len(b)):
        rows[0].append(rows[0][-1] + _step(b[j - 1] if j else "", b[j]))
    for i, x in enumerate(a):
        row = [rows[i][0] + _step(a[i - 1] if i else "", x)]
        for j, y in enumerate(b):
            row.append(
                min(
                    rows[i][j + 1] + _step(a[i - 1] if i else "", x),
                    row[j] + _step(b[j - 1] if j else "", y),
                    rows[i][j] + _letters(x, y),
                )
            )
        rows.append(row)
    return rows[-1][-1]


def _letters(x: str, y: str) -> int:
    return SAME if x == y else ALIKE if (x, y) in _ALIKE else OTHER


def _step(before: str, letter: str) -> int:
    """What a letter more or less counts: nothing doubled, one beside its like or where it is hardly heard."""
    return ALIKE if letter in _SILENT and before != letter else _letters(before, letter) if before else OTHER
