"""Texts as vectors: those of like meaning lie close together, in whatever words."""

from functools import lru_cache

import numpy as np

from common.language.normalise import REMEMBERED
from common.language.transformer import Floats, tokenizer, transformer

SCALE = np.float32(3.0)
"""Length of an embedding beside features of 1 (chosen on lists left out: 2 to 6 differ by a sentence in a hundred)."""
LONGEST = 128
"""Most word pieces that are read (chosen: sentences of 60 words have about 80)."""


@lru_cache(REMEMBERED)
def embedded(text: str) -> Floats:
    """The embedding of a text, the mean over its word pieces: (transformer.SIZE,), of length 1."""
    pieces = tokenizer().encode(text).ids
    if len(pieces) > LONGEST:
        pieces = [*pieces[: LONGEST - 1], pieces[-1]]
    mean = transformer().states(pieces).mean(axis=0)
    return np.asarray(mean / np.linalg.norm(mean), np.float32)


def beside_features(*texts: str) -> Floats:
    """The embeddings of n texts as a model reads them beside its features: (n * SIZE,), each of length SCALE."""
    return np.concatenate([embedded(text) for text in texts]) * SCALE
