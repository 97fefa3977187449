"""Comparison of sentences by the words that carry their meaning."""

import re

_FILLER = re.compile(r"\b(?:please|hey jarvis|jarvis|the|a|an|my|me|to)\b")


def plain(text: str) -> str:
    """A sentence in lower case without punctuation, articles and polite words."""
    words = re.sub(r"[^a-z0-9' ]+", " ", text.lower())
    return " ".join(_FILLER.sub(" ", words).split())
