"""A dictionary with words for keys in two files that are mapped into memory: a look-up takes some microseconds."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

_decode = msgspec.json.Decoder().decode
PARTS = ("keys", "starts", "values", "places")


def write(words: Mapping[str, msgspec.Raw], path: Path) -> None:
    """Write a dictionary of values that are still JSON, as files that begin with `path`."""
    rows = sorted((key.encode(), value) for key, value in words.items())
    keys, starts = _joined([key for key, _ in rows])
    values, places = _joined([bytes(value) for _, value in rows])
    for part, array in {"keys": keys, "values": values}.items():
        np.save(_file(path, part), array)
    for part, ends in {"starts": starts, "places": places}.items():
        np.save(_file(path, part), ends)


class PackedMapping(Mapping[str, Any]):
    """A dictionary that cannot be added to, of the files that `write` wrote; each look-up decodes."""

    def __init__(self, path: Path) -> None:
        arrays = (np.load(_file(path, part), mmap_mode="r") for part in PARTS)
        self._keys, self._starts, self._values, self._places = (memoryview(array) for array in arrays)

    def _find(self, key: str) -> int:
        """Where the key is, -1 for nowhere."""
        wanted, keys, starts = key.encode(), self._keys, self._starts
        low, high = 0, len(starts) - 1
        while low < high:
            middle = (low + high) // 2
            found = bytes(keys[starts[middle] : starts[middle + 1]])
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
            yield bytes(self._keys[start:end]).decode()

    def __len__(self) -> int:
        return len(self._starts) - 1


def _file(path: Path, part: str) -> Path:
    return path.with_name(f"{path.name}.{part}.npy")


def _joined(parts: list[bytes]) -> tuple[NDArray[np.uint8], NDArray[np.uint32]]:
    """All parts in one, and where each begins, with the end of the last.

    An empty file cannot be mapped: a byte that no part has ends it.
    """
    ends = np.cumsum([0, *map(len, parts)], dtype=np.uint32)
    return np.frombuffer(b"".join(parts) + b"\0", np.uint8), ends
