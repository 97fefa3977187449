"""Sentences compared by the words that carry their meaning."""

import re

_FILLER = re.compile(r"\b(?:please|hey jarvis|jarvis|the|a|an|my|me|to)\b")


def plain(text: str) -> str:
    """The words that carry the meaning, for comparing two sentences."""
    words = re.sub(r"[^a-z0-9' ]+", " ", text.lower())
    return " ".join(_FILLER.sub(" ", words).split())
