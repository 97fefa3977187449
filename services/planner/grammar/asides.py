"""A sentence without the parts between its marks that ask for nothing: `bin the cans, they are empties`. Pure."""

import re
from collections.abc import Callable

from common.language.breaks import is_statement
from common.language.mood import forbids, without_harmless
from common.language.normalise import Words

_MARKS = re.compile(r"\s*([,;.!?]+)\s*")
_TALE_MARKS = re.compile(r"\s*([,;.!?]+|(?<=\s)so(?=\s))\s*(?:(?:so|and so)\s+)?")
_TURNING = frozenset({
    "if", "unless", "until", "instead", "otherwise", "or", "sorry", "mean", "meant", "except", "wait", "actually",
    "always", "only",
})  # fmt: skip
"""Words of a part that makes something else of the rest, though it tells something."""
_NAMING = re.compile(r"(?:this|that|these|those|it) (?:is|are)\b")
"""How a part begins that may say what something is called."""
_LIMITING = frozenset({
    "not", "no", "only", "but", "except", "if", "unless", "until", "instead", "rather", "otherwise", "than", "without",
    "or", "nor", "never", "and", "then", "always", "both", "all", "each", "sorry",
    "mean", "meant", "wait", "actually", "correction", "oops",
})  # fmt: skip
"""Words of a part that says something about the rest."""


def without_asides(text: str, idle: Callable[[Words, bool], bool]) -> str:
    """Normalised text with marks, without the parts that are `idle` and limit nothing of the rest.

    `idle` is told whether a part is an exclamation. The text as it is where none or all of them are.
    """
    pieces = _MARKS.split(text)
    parts, marks = pieces[::2], [*pieces[1::2], ""]
    kept = [
        (part, mark)
        for part, mark in zip(parts, marks, strict=True)
        if part and not ((words := tuple(part.split())) and _says_nothing(words) and idle(words, "!" in mark))
    ]
    if not kept or len(kept) == len(list(filter(None, parts))):
        return text
    return " ".join(f"{part}{mark}" for part, mark in kept).rstrip(" ,;")


def with_tales_apart(text: str, names: Callable[[Words], bool]) -> str:
    """Normalised text with a full stop behind each part that only tells something; without those that name nothing.

    `i am laying the table, so the bowl please, thanks` as `i am laying the table . the bowl please, thanks`.
    """
    pieces = _TALE_MARKS.split(text)
    parts, marks = pieces[::2], [*pieces[1::2], ""]
    told = [
        is_statement(part) and not _NAMING.match(part) and _TURNING.isdisjoint(part.split()) and not forbids(part)
        for part in parts
    ]
    while len(parts) > 1 and told[-1] and not names(tuple(parts[-1].split())):
        parts, marks, told = parts[:-1], [*marks[: len(parts) - 2], ""], told[:-1]
    told[-1] = False  # "the white mug would help" tells something, and asks for it
    if not any(told) and len(parts) == len(pieces[::2]):
        return text
    kept = [
        f"{part} ." if is_tale else f"{part}{',' if mark == 'so' else mark}"
        for part, mark, is_tale in zip(parts, marks, told, strict=True)
        if part and not (is_tale and not names(tuple(part.split())))
    ]
    return " ".join(kept).rstrip(" ,;.")


def _says_nothing(words: Words) -> bool:
    text = " ".join(words)
    return _LIMITING.isdisjoint(without_harmless(text).split()) and not forbids(text)
