"""Pictures as files in memory."""

import io
from typing import Any

from PIL import Image


def jpeg(picture: Any, quality: int) -> bytes:
    """A picture, RGB (h, w, 3) uint8 or Pillow's, as JPEG of that quality [1 to 95]."""
    return _encoded(picture, "JPEG", quality=quality)


def png(picture: Any) -> bytes:
    """The same as PNG, which loses nothing."""
    return _encoded(picture, "PNG")


def _encoded(picture: Any, form: str, **options: int) -> bytes:
    out = io.BytesIO()
    (picture if isinstance(picture, Image.Image) else Image.fromarray(picture)).save(out, form, **options)
    return out.getvalue()
