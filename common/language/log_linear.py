"""Which of several options a text means, and with how much probability: log-linear models learnt from examples. Pure.

An option counts by hashed features of its own (Weinberger et al., "Feature hashing for large scale multitask learning",
2009) and by what its form makes of the embedding of the text. `bench/log_linear.py` learns the weights.
"""

from collections.abc import Iterable, Sequence
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import NamedTuple
from zlib import crc32

import numpy as np
import numpy.typing as npt

from common.language.eight_bits import in_8_bits

BITS = 18
"""Features are counted modulo 2**BITS (chosen: 100 000 features are seen in tests/data, so few share a number)."""
UNKNOWN = "<unknown>"
"""What stands for every word that is not among those learnt from."""

Floats = npt.NDArray[np.float32]


class Option(NamedTuple):
    """`form`: which weights of the embedding count for it; `features`: numbers below 2**BITS."""

    form: str
    features: Sequence[int]


class LogLinear:
    """Weights `sparse` (2**BITS,) of features, `dense` (forms, D) of embeddings by form; `words` that it knows."""

    def __init__(self, sparse: Floats, dense: Floats, forms: Sequence[str], words: frozenset[str]) -> None:
        self._sparse, self._dense, self.words = sparse, dense, words
        self._row = {form: row for row, form in enumerate(forms)}

    @classmethod
    def load(cls, path: Traversable) -> "LogLinear":
        """The model that `save` has written."""
        with path.open("rb") as file, np.load(file) as stored:
            sparse, dense = (stored[n].astype(np.float32) * stored[f"{n}_step"] for n in ("sparse", "dense"))
            forms, words = (bytes(stored[n]).decode().split() for n in ("forms", "words"))
            return cls(sparse, dense, forms, frozenset(words))

    def save(self, path: Path) -> None:
        """Write it with weights of 8 bits."""
        table: dict[str, npt.NDArray[np.generic]] = {}
        for name, weights in (("sparse", self._sparse), ("dense", self._dense)):
            table[name], table[f"{name}_step"] = in_8_bits(weights)
        for name, listed in (("forms", list(self._row)), ("words", sorted(self.words))):
            table[name] = np.frombuffer(" ".join(listed).encode(), np.uint8)
        np.savez_compressed(path, **table)  # type: ignore[arg-type]

    def probabilities(self, options: Sequence[Option], embedding: Floats) -> Floats:
        """Of each option (n,), together 1; `embedding` (D,) of the text."""
        of_form = self._dense @ embedding
        scores = np.array([self._sparse[o.features].sum() + of_form[self._row[o.form]] for o in options])
        shares = np.exp(scores - scores.max())
        return np.asarray(shares / shares.sum(), np.float32)


def hashed(names: Iterable[str]) -> list[int]:
    """Numbers of features by their names; a feature counts once each time it is listed."""
    return [crc32(name.encode()) % (1 << BITS) for name in names]
