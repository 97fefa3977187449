"""The wake word in what was transcribed. Pure."""

from collections.abc import Iterable
from difflib import SequenceMatcher

WAKE_LIKENESS = 0.85
"""Least share of letters in common with the wake word (chosen: `they jarvins` has 0.91, `hey travis` 0.8)."""


def without_wake(text: str, phrases: Iterable[str]) -> str:
    """Text after the wake word or what is written nearly so (`they jarvins`), or the whole text."""
    words = text.split()
    for phrase in phrases:
        width = len(phrase.split())
        if SequenceMatcher(None, " ".join(words[:width]).strip(","), phrase).ratio() >= WAKE_LIKENESS:
            return " ".join(words[width:])
    return text
