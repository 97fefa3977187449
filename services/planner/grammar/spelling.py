"""Slips of typed words: `teh blu botle` as `the blue bottle`, by edit distance to the words that are known. Pure."""

import re
from collections.abc import Iterable, Sequence

LONG_WORD = 5
"""Letters from which on a name may be taken for a slip of another (chosen: `cat` is no slip of `can`)."""
VERY_LONG = 9
"""Letters from which on two slips are forgiven (chosen)."""


def corrected(words: Sequence[str], plain: Iterable[str], names: Iterable[str]) -> tuple[list[str], bool]:
    """(words with slips undone, whether a name was changed). `plain`: verbs, colours and words between; `names`: nouns.

    A word that is known stays, and so does one that is near several.
    """
    common, nouns = set(plain), set(names)
    found, named = [], False
    for word in words:
        if word in common or word in nouns or not word.isalpha() or len(word) < 3:
            found.append(word)
            continue
        near = _alike(word, common | nouns) or _nearest(word, common - nouns)
        near = near or (_nearest(word, nouns) if len(word) >= LONG_WORD else None)
        named = named or near in nouns
        found.append(near or word)
    return found, named


def _alike(word: str, known: set[str]) -> str | None:
    """The only known word that is spelled alike but for doubled and silent letters and groups of vowels: `aple`."""
    alike = [k for k in known if len(k) > 2 and _sound(k) == _sound(word)]
    return alike[0] if len(alike) == 1 else None


def _sound(word: str) -> str:
    single = re.sub(r"([aeiou])[aeiou]+", r"\1", re.sub(r"(.)\1+", r"\1", word.replace("wh", "w")))
    return re.sub(r"(?<=[^aeiou])e$", "", single)


def _nearest(word: str, known: set[str]) -> str | None:
    """The only word within the allowed distance, of the same beginning if several are."""
    allowed = 2 if len(word) >= VERY_LONG else 1
    near = [k for k in known if len(k) > 2 and abs(len(k) - len(word)) <= allowed and distance(word, k) <= allowed]
    if len(word) < LONG_WORD:  # another letter makes another word: `hate` is no slip of `have`
        near = [k for k in near if len(k) != len(word) or sorted(k) == sorted(word)]
    near = [k for k in near if not (k.endswith("s") and k[:-1] in near)]
    near = [k for k in near if k[0] == word[0] or sorted(k) == sorted(word) or len(word) >= LONG_WORD]
    if len(near) > 1:
        near = [k for k in near if k[0] == word[0] and sorted(k) == sorted(word)] or [
            k for k in near if k[0] == word[0]
        ]
    return near[0] if len(near) == 1 else None


def distance(a: str, b: str) -> int:
    """Letters to insert, delete, exchange or swap with their neighbour (optimal string alignment)."""
    rows = [list(range(len(b) + 1))]
    for i, x in enumerate(a, 1):
        row = [i]
        for j, y in enumerate(b, 1):
            cost = min(rows[-1][j] + 1, row[-1] + 1, rows[-1][j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and y == a[i - 2]:
                cost = min(cost, rows[-2][j - 2] + 1)
            row.append(cost)
        rows.append(row)
    return rows[-1][-1]
