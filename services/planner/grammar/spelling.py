"""Slips of typed words: `teh blu botle` as `the blue bottle`, by edit distance to the words that are known. Pure."""

import re
from collections.abc import Container, Iterable, Sequence
from functools import lru_cache

from common.language.normalise import REMEMBERED

LONG_WORD = 5
"""Letters from which on a name may be taken for a slip of another (chosen: `cat` is no slip of `can`)."""
MARKS = ",;.!?"
"""Marks that stand behind words."""
LONGEST_RUN = 3
"""Most words that are one name misheard (chosen)."""
SOUNDS_PER_SLIP = 6
"""Sounds of a name of which one may be another (chosen: `toy books` for the toy box)."""
_SOUNDS = tuple(
    (re.compile(spelling), sound)
    for spelling, sound in (
        (r"^(?:kn|gn)", "n"), (r"^wr", "r"), ("wh", "w"), ("ph", "f"), ("ck|c(?![eiyh])|q", "k"), ("x", "ks"),
        ("ough|ew$|eu|ue|oo|ou", "u"), ("ea(?=d$)", "e"), ("[ae]i|ay", "a"), ("y$", "i"), (r"(.)\1+", r"\1"),
        (r"([aeiou])[aeiou]+", r"\1"), (r"(?<=[^aeiou])e$", ""),
    )
)  # fmt: skip
"""Spellings, and one sign for those that sound alike."""
VERY_LONG = 9
"""Letters from which on two slips are forgiven (chosen)."""


def corrected(
    words: Sequence[str], plain: Iterable[str], names: Iterable[str], spelled: Container[str] = ()
) -> tuple[list[str], bool]:
    """(words with slips undone, whether a name was changed). `plain`: verbs, colours and words between; `names`: nouns.

    A word that is known stays, and so do one that is near several and the words of `spelled`, which are no slips.
    """
    common, nouns = set(plain), set(names)
    found, named = [], False
    for word in words:
        if word in common or word in nouns or word in spelled or not word.isalpha() or len(word) < 3:
            found.append(word)
            continue
        near = _alike(word, common | nouns) or _nearest(word, common - nouns)
        near = near or (_nearest(word, nouns) if len(word) >= LONG_WORD else None)
        named = named or near in nouns
        found.append(near or word)
    return found, named


def renamed(words: Sequence[str], names: Iterable[str], colours: Container[str], kinds: Container[str]) -> list[str]:
    """Words with a run of them replaced by the only name that sounds much like it: `the dress her` as `the dresser`.

    No run goes beyond a word with a mark behind it: `the sofa, can you` has no soda can in it.
    The words as they are where there is no such name, or several. A kind with its colours describes a thing of its own,
    however much it sounds like another: `the green bowl` beside a green bottle.
    """
    sounds = {name: _sound(name.replace(" ", "")) for name in names}
    bare = [w.strip(MARKS) for w in words]
    runs = [(a, b) for b in range(1, len(words) + 1) for a in range(max(0, b - LONGEST_RUN), b)]
    runs = [(a, b) for a, b in runs if list(words[a : b - 1]) == bare[a : b - 1]]
    for begin, end in sorted(runs, key=lambda run: run[0] - run[1]):
        said = _sound("".join(bare[begin:end]))
        allowed = len(said) // SOUNDS_PER_SLIP
        spelled = " ".join(bare[begin:end])
        described = end - begin > 1 and bare[end - 1] in kinds and all(w in colours for w in bare[begin : end - 1])
        if len(said) < LONG_WORD or spelled in sounds or described:
            continue
        near = {n for n, s in sounds.items() if abs(len(s) - len(said)) <= allowed and distance(s, said) <= allowed}
        if len(near) == 1 and (end - begin > 1 or " " in next(iter(near))):
            return [*bare[:begin], *next(iter(near)).split(), *bare[end:]]
    return bare


def _alike(word: str, known: set[str]) -> str | None:
    """The only known word that sounds alike: `aple`, `blew`."""
    alike = [k for k in known if len(k) > 2 and _sound(k) == _sound(word)]
    return alike[0] if len(alike) == 1 else None


@lru_cache(REMEMBERED)
def _sound(word: str) -> str:
    """How a word is spoken, roughly: one sign for letters that sound alike, no silent ones."""
    for spelling, sound in _SOUNDS:
        word = spelling.sub(sound, word)
    return word


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


@lru_cache(10 * REMEMBERED)
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
