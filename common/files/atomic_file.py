"""Atomic replacement of small files: a reader, or a crash, finds the old content or the new one."""

import contextlib
import os
from pathlib import Path


def replace(path: Path, data: bytes, durable: bool = False) -> str:
    """Replace a file's content in one step; returns the reason when that was not possible, else "".

    `durable`: it is on the disk when this returns, so that a power cut does not take it back.
    """
    part = path.with_suffix(".part")
    try:
        with part.open("wb") as file:
            file.write(data)
            if durable:
                file.flush()
                os.fsync(file.fileno())
        part.replace(path)
        if durable:
            _sync_folder(path.parent)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink()
        return str(error)
    return ""


def _sync_folder(folder: Path) -> None:
    """Have the kernel write the folder's entries to the disk."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
