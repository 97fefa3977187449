"""How the hand holds what is in it, on disk: a process that was killed is succeeded by one that knows."""

import contextlib
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np

from common import files
from services.manipulation.held import Held

NAME, VERSION = "hand", 1


class Memo(msgspec.Struct):
    """A `Held` in plain numbers, and the width [m] at which the fingers came to rest on it."""

    label: str
    kind: str
    rotation: list[list[float]]
    offset: list[float]
    size: tuple[float, float, float]
    width: float
    yaw: float
    closed: float
    version: int = VERSION


class HandMemo:
    """The file in `directory`; None: what is held is not kept."""

    def __init__(self, directory: Path | None, report: Callable[[str], None]) -> None:
        self._path, self._report = directory / NAME if directory else None, report
        self._kept: Held | None = None
        self._settled = False

    def keep(self, held: Held | None, closed: float) -> None:
        """Write what is held now, where it has changed."""
        if self._path is None or (self._settled and held is self._kept):
            return
        self._kept, self._settled = held, True
        why = ""
        if held is not None:
            rotation, offset = held.rotation.tolist(), held.offset.tolist()
            memo = Memo(held.label, held.kind, rotation, offset, held.size, held.width, held.yaw, closed)
            with contextlib.suppress(OSError):
                self._path.parent.mkdir(parents=True, exist_ok=True)
            why = files.replace(self._path, msgspec.msgpack.encode(memo))
        if held is None or why:
            try:
                self._path.unlink(missing_ok=True)
            except OSError as error:
                why = why or str(error)
        if why:
            self._report(why)

    def recall(self, width: float, within: float) -> Held | None:
        """What a former process held, when the fingers are still where it closed them [m]."""
        if self._path is None:
            return None
        try:
            memo = msgspec.msgpack.decode(self._path.read_bytes(), type=Memo)
        except (OSError, msgspec.DecodeError):
            return None
        rotation, offset = np.array(memo.rotation), np.array(memo.offset)
        sound = memo.version == VERSION and rotation.shape == (3, 3) and offset.shape == (3,)
        if not sound or abs(width - memo.closed) > within:
            return None
        self._settled = True
        self._kept = Held(memo.label, memo.kind, rotation, offset, memo.size, memo.width, memo.yaw)
        return self._kept
