"""The recogniser's decoder as one step for many beam hypotheses at once, rebuilt from the weights of the shipped one.

The shipped network keeps the encoder's keys and values for each hypothesis, gets its cache rearranged from outside and
unpacks its weights at each run: six times the CPU time. Here the encoder's part is kept
once, the choice of the hypotheses that go on happens inside, and the matrices stay packed in 8 bits
(`decoder_networks.py` writes these networks).
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.inference import session

LAYERS, HEADS, HEAD_SIZE, ROTARY_SIZE = 8, 8, 52, 32
"""Moonshine base: decoder layers, attention heads, numbers per head, and how many of them are rotated by position."""
MODEL_SIZE = HEADS * HEAD_SIZE
ROTARY_BASE = 10000.0
"""Base of the rotary embedding's frequencies (Su et al., "RoFormer", 2021)."""
CROSS, STEP, EMBEDDING, EMBEDDING_SCALE = "cross.onnx", "step.onnx", "embedding.npy", "embedding_scale.npy"
"""Files of the two networks, of the tokens' embedding as int8, and of its scale and what is added."""
Array = NDArray[Any]
Cache = dict[str, Array]


class Decoder:
    """Sessions of two networks: the cross-attention cache of an utterance, and one step of decoding."""

    def __init__(self, folder: Path) -> None:
        self._embedding = np.load(folder / EMBEDDING, mmap_mode="r")
        self._scale, self._added = np.load(folder / EMBEDDING_SCALE)
        self._cross = session(folder / CROSS)
        self._step = session(folder / STEP)

    def cross_attention_cache(self, hidden: Array) -> Cache:
        """Keys and values per layer of what the encoder found, (variants, frames, MODEL_SIZE)."""
        return dict(zip(cross_names(), self._cross.run(None, {"hidden": hidden}), strict=True))

    def step(self, attended: Cache, cache: Array, rows: list[int], tokens: list[int]) -> tuple[Array, Array]:
        """Log-probabilities (hypotheses, tokens) after one more token each, and the new cache.

        `rows` are the hypotheses in `cache` (2 LAYERS, variants, hypotheses, HEADS, length, HEAD_SIZE) that go on.
        """
        variants = len(attended["cross0"])
        x = self._embedding[tokens].astype(np.float32) * self._scale + self._added
        feeds = {"x": np.tile(x, (variants, 1, 1)), "rows": np.array(rows, np.int64), "cache": cache}
        feeds["rotation"] = rotary_embedding(cache.shape[4])
        scores, present = self._step.run(None, {**feeds, **attended})
        return scores, present

    @staticmethod
    def empty_cache(variants: int) -> Array:
        """The cache of the one hypothesis that there is at first."""
        return np.zeros((2 * LAYERS, variants, 1, HEADS, 0, HEAD_SIZE), np.float32)


def cross_names() -> list[str]:
    """Names of the keys and values of each layer, as one network puts them out and the other takes them."""
    return [f"cross{k}" for k in range(2 * LAYERS)]


def rotary_embedding(position: int) -> Array:
    """Rotation (HEAD_SIZE, HEAD_SIZE) that a query or key of that position is multiplied by."""
    angles = position / ROTARY_BASE ** (np.arange(0, ROTARY_SIZE, 2) / ROTARY_SIZE)
    found = np.eye(HEAD_SIZE, dtype=np.float32)
    even, odd = np.arange(0, ROTARY_SIZE, 2), np.arange(1, ROTARY_SIZE, 2)
    found[even, even] = found[odd, odd] = np.cos(angles)
    found[odd, even], found[even, odd] = -np.sin(angles), np.sin(angles)
    return found
