"""A dictionary with words for keys, packed: in a tenth of the memory of Python's own, at some microseconds a word."""

from collections.abc import Iterator, Mapping
from typing import Any

import msgspec
import numpy as np

_decode = msgspec.json.Decoder().decode


class PackedMapping(Mapping[str, Any]):
    """A dictionary that cannot be added to; made of values that are still JSON, which each look-up decodes."""

    def __init__(self, words: Mapping[str, msgspec.Raw]) -> None:
        rows = sorted((key.encode(), value) for key, value in words.items())
        self._keys, self._starts = _joined([key for key, _ in rows])
        self._values, self._places = _joined([bytes(value) for _, value in rows])

    def _find(self, key: str) -> int:
        """Where the key is, -1 for nowhere."""
        wanted, keys, starts = key.encode(), self._keys, self._starts
        low, high = 0, len(starts) - 1
        while low < high:
            middle = (low + high) // 2
            found = keys[starts[middle] : starts[middle + 1]]
            if found == wanted:
                return middle
            if found < wanted:
                low = middle + 1
            else:
                high = middle
        return -1

    def __getitem__(self, key: str) -> Any:
        at = self._find(key)
        if at < 0:
            raise KeyError(key)
        return _decode(self._values[self._places[at] : self._places[at + 1]])

    def __contains__(self, key: object) -> bool:
        return isinstance(key, str) and self._find(key) >= 0

    def __iter__(self) -> Iterator[str]:
        for start, end in zip(self._starts, self._starts[1:], strict=False):
            yield self._keys[start:end].decode()

    def __len__(self) -> int:
        return len(self._starts) - 1


def _joined(parts: list[bytes]) -> tuple[bytes, memoryview]:
    """All parts in one, and where each begins, with the end of the last."""
    ends = np.cumsum([0, *map(len, parts)], dtype=np.uint32)
    return b"".join(parts), ends.data
