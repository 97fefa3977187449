"""Small files that are whole at any moment."""

import contextlib
from pathlib import Path


def replace(path: Path, data: bytes) -> str:
    """Put a new content in the place of the old in one step; the reason when that was not possible."""
    part = path.with_suffix(".part")
    try:
        part.write_bytes(data)
        part.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink()
        return str(error)
    return ""
