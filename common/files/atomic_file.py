"""Small files that are whole at any moment."""

import contextlib
import os
from pathlib import Path


def replace(path: Path, data: bytes, durable: bool = False) -> str:
    """Put a new content in the place of the old in one step; the reason when that was not possible.

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
    """The file's name is on the disk as well."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
