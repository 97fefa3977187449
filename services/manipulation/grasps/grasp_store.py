"""Grasp store: the grasped object on disk, for the process that succeeds one that was killed."""

import contextlib
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np

from common.files import atomic_file
from services.manipulation.grasps.grasped_object import GraspedObject

NAME, VERSION = "hand", 1
"""File with the grasped object, and the version of its layout: another one is not read."""
RELEASED = "released"
"""File with the id of the goal for which the fingers were last opened."""


class StoredGrasp(msgspec.Struct):
    """A `GraspedObject` in plain numbers, and the width [m] at which the fingers came to rest on it."""

    label: str
    kind: str
    rotation: list[list[float]]
    offset: list[float]
    size: tuple[float, float, float]
    width: float
    yaw: float
    closed: float
    version: int = VERSION


class GraspStore:
    """What is held, and for which goal the fingers were last opened: files in `directory`; None: only in memory."""

    def __init__(self, directory: Path | None, report: Callable[[str], None]) -> None:
        self._path, self._report = directory / NAME if directory else None, report
        self._released_path = directory / RELEASED if directory else None
        self._released: str | None = None
        self._kept: GraspedObject | None = None
        self._settled = False

    def release(self, goal_id: str) -> None:
        """Write, before the fingers open, for which goal they do."""
        if goal_id == self._released:
            return
        self._released = goal_id
        if self._released_path is not None:
            with contextlib.suppress(OSError):
                self._released_path.parent.mkdir(parents=True, exist_ok=True)
            if why := atomic_file.replace(self._released_path, goal_id.encode()):
                self._report(why)

    def released(self) -> str:
        """The goal for which the fingers were last opened, by this or a former process; "" if none is known."""
        if self._released is None:
            self._released = ""
            if self._released_path is not None:
                with contextlib.suppress(OSError, UnicodeDecodeError):
                    self._released = self._released_path.read_text(encoding="utf-8")
        return self._released

    def keep(self, held: GraspedObject | None, closed: float) -> None:
        """Write what is held now, where it has changed."""
        if self._path is None or (self._settled and held is self._kept):
            return
        self._kept, self._settled = held, True
        why = ""
        if held is not None:
            rotation, offset = held.rotation.tolist(), held.offset.tolist()
            memo = StoredGrasp(held.label, held.kind, rotation, offset, held.size, held.width, held.yaw, closed)
            with contextlib.suppress(OSError):
                self._path.parent.mkdir(parents=True, exist_ok=True)
            why = atomic_file.replace(self._path, msgspec.msgpack.encode(memo))
        if held is None or why:
            try:
                self._path.unlink(missing_ok=True)
            except OSError as error:
                why = why or str(error)
        if why:
            self._report(why)

    def recall(self, width: float, within: float) -> GraspedObject | None:
        """What a former process held, when the fingers are still where it closed them [m]."""
        if self._path is None:
            return None
        try:
            memo = msgspec.msgpack.decode(self._path.read_bytes(), type=StoredGrasp)
        except (OSError, msgspec.DecodeError):
            return None
        rotation, offset = np.array(memo.rotation), np.array(memo.offset)
        sound = memo.version == VERSION and rotation.shape == (3, 3) and offset.shape == (3,)
        if not sound or abs(width - memo.closed) > within:
            return None
        self._settled = True
        self._kept = GraspedObject(memo.label, memo.kind, rotation, offset, memo.size, memo.width, memo.yaw)
        return self._kept
