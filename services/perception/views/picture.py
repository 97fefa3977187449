"""A view as a small picture for people. Pure."""

import io

from PIL import Image

from services.perception.views.view import View

WIDTH = 320
"""Pixels: with QUALITY some 10 KB a picture, which a message and a journal can carry."""
QUALITY = 75
"""JPEG quality; Pillow's default, at which no block edges show."""


def jpeg(view: View) -> bytes:
    """The colours of a view, at most WIDTH pixels wide."""
    step = max(1, -(-view.shape[1] // WIDTH))
    file = io.BytesIO()
    Image.fromarray(view.rgb[::step, ::step]).save(file, "JPEG", quality=QUALITY)
    return file.getvalue()
