"""Spoken or typed text as words: lower case, without punctuation and politeness, cut into clauses. Pure."""

import re
import unicodedata
from collections.abc import Container
from functools import lru_cache

Words = tuple[str, ...]

REMEMBERED = 10_000
"""Texts of which a pure function keeps what it found (chosen: twenty times the names of a household)."""
DETERMINERS = frozenset({
    "the", "a", "an", "my", "your", "our", "that", "this", "some", "any", "those", "these", "her", "his", "their",
    "its",
})  # fmt: skip
"""Words before a noun that say nothing about which object is meant beyond "one of these"."""

_PAST = {
    "brought": "bring", "took": "take", "taken": "take", "got": "get", "gave": "give", "given": "give", "went": "go",
    "gone": "go", "came": "come", "found": "find", "threw": "throw", "thrown": "throw", "drove": "drive",
    "driven": "drive", "held": "hold", "laid": "lay", "left": "leave", "stuck": "stick", "said": "say",
    "told": "tell", "kept": "keep", "stood": "stand", "sat": "sit",
}  # fmt: skip
"""Irregular past forms of the verbs of commands."""


_DOUBLE = re.compile(r"\b(the|my|our|an?|that|this|his|her|your) ([a-z]{2,})-\2\b")
"""The name of a yo-yo, which is no word that somebody who hesitates says twice."""


@lru_cache(REMEMBERED)
def normalise(text: str, keep: str = "") -> str:
    """Lower-case words separated by single spaces; accents and punctuation go, except the marks in `keep`."""
    plain = re.sub("&+", " and ", text.lower().replace("’", "'").replace("_", " "))
    folded = unicodedata.normalize("NFKD", plain)
    letters = _DOUBLE.sub(r"\1 \2\2", "".join(c for c in folded if not unicodedata.combining(c)))
    return " ".join(re.sub(rf"[^\w'{re.escape(keep)}]+", " ", letters).split())


def without_determiners(words: Words) -> Words:
    """Words without leading determiners."""
    while words and words[0] in DETERMINERS:
        words = words[1:]
    return words


def infinitive(word: str, verbs: Container[str]) -> str:
    """`bringing` and `brought` as `bring`, as in "would you mind bringing me ..."; other words stay."""
    if word in verbs:
        return word
    if word in _PAST:
        return _PAST[word]
    if word.endswith("ied") and f"{word[:-3]}y" in verbs:
        return f"{word[:-3]}y"
    if word.endswith("ed"):
        return next((v for v in (word[:-2], word[:-1], word[:-3]) if v in verbs), word)
    stem = word.removesuffix("ing")
    if stem == word or word in verbs:
        return word
    return next((v for v in (stem, f"{stem}e", stem[:-1]) if v in verbs), word)


def indefinite(name: str) -> str:
    """A name with its article: `an apple`, `a mug`."""
    return f"{'an' if name[:1] in 'aeiou' else 'a'} {name}"


def enumeration(names: list[str], last: str = "and") -> str:
    """Names as spoken: `a, b and c`."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}" if names else ""
