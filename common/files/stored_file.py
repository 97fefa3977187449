"""A value that a service keeps on disk, atomically, so that it survives a kill or a power cut."""

import contextlib
import re
from collections.abc import Callable
from pathlib import Path
from typing import Generic, TypeVar

import msgspec

from common.files import atomic_file

T = TypeVar("T")


class StoredFile(Generic[T]):
    """One value of a type in one JSON file; with `path` None nothing is kept. `warn(why)` is told what went wrong.

    A file that cannot be read is kept beside the new one. With `folder` its folder is made where it is missing.
    """

    def __init__(
        self, path: Path | None, kind: type[T], warn: Callable[[str], None], durable: bool = True, folder: bool = False
    ) -> None:
        self._path, self._kind, self._warn, self._durable, self._folder = path, kind, warn, durable, folder

    def load(self) -> T | None:
        """The value that was saved last, None where there is none."""
        if self._path is None or not self._path.exists():
            return None
        try:
            return msgspec.json.decode(self._path.read_bytes(), type=self._kind)
        except (OSError, msgspec.DecodeError) as error:
            aside = self._path.with_suffix(".unreadable")
            self._warn(f"{self._path} cannot be read ({error}); it is kept as {aside.name}")
            try:
                self._path.replace(aside)
            except OSError as refused:
                self._warn(str(refused))
            return None

    def save(self, value: T) -> bool:
        """Save the value; True when that was possible. A `durable` file is on the disk itself then."""
        if self._path is None:
            return True
        if self._folder:
            with contextlib.suppress(OSError):  # the file will not be written either, which tells why
                self._path.parent.mkdir(parents=True, exist_ok=True)
        why = atomic_file.replace(self._path, msgspec.json.encode(value), self._durable)
        if why:
            self._warn(f"{self._path.name} is not kept: {why}")
        return not why


def home_file(folder: Path | None, what: str, home: str) -> Path | None:
    """Path of the file `what` of one home, named by the home, so that a robot used in two homes keeps both."""
    return folder / f"{what}-{re.sub(r'[^A-Za-z0-9]+', '-', home).strip('-') or 'home'}.json" if folder else None
