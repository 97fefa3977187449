"""Normalisation of transcriptions, and removal of the wake word from them. Pure."""

import re
from collections.abc import Iterable
from difflib import SequenceMatcher

from common.language.normalise import normalise

WAKE_LIKENESS = 0.85
"""Least share of letters in common with the wake word (chosen: `they jarvins` has 0.91, `hey travis` 0.8)."""

_STOPS = re.compile(r"[.;:!?]+(?=\s)")


def clauses(text: str) -> str:
    """A transcription in normalised words, with a comma where it pauses or a sentence ends within it."""
    return normalise(_STOPS.sub(",", text), ",").strip(" ,")


def without_wake(text: str, phrases: Iterable[str]) -> str:
    """Text after the wake word or what is written nearly so (`they jarvins`), or the whole text."""
    words = text.split()
    for phrase in phrases:
        width = len(phrase.split())
        if SequenceMatcher(None, " ".join(words[:width]).strip(","), phrase).ratio() >= WAKE_LIKENESS:
            return " ".join(words[width:])
    return text
