"""A sentence without the parts between its marks that ask for nothing: `bin the cans, they are empties`. Pure."""

import re
from collections.abc import Callable

from common.language.mood import forbids, without_harmless
from common.language.normalise import Words

_MARKS = re.compile(r"\s*([,;.!?]+)\s*")
_LIMITING = frozenset({
    "not", "no", "only", "but", "except", "if", "unless", "until", "instead", "rather", "otherwise", "than", "without",
    "or", "nor", "never", "and", "then", "always", "both", "all", "each", "sorry",
    "mean", "meant", "wait", "actually", "correction", "oops",
})  # fmt: skip
"""Words of a part that says something about the rest."""


def without_asides(text: str, idle: Callable[[Words], bool]) -> str:
    """Normalised text with marks, without the parts that are `idle` and limit nothing of the rest.

    The text as it is where none or all of them are.
    """
    pieces = _MARKS.split(text)
    parts, marks = pieces[::2], [*pieces[1::2], ""]
    kept = [
        (part, mark)
        for part, mark in zip(parts, marks, strict=True)
        if part and not ((words := tuple(part.split())) and _says_nothing(words) and idle(words))
    ]
    if not kept or len(kept) == len(list(filter(None, parts))):
        return text
    return " ".join(f"{part}{mark}" for part, mark in kept).rstrip(" ,;")


def _says_nothing(words: Words) -> bool:
    text = " ".join(words)
    return _LIMITING.isdisjoint(without_harmless(text).split()) and not forbids(text)
