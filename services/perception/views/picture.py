"""A view as a small picture for people. Pure."""

from common.rendering import encode
from services.perception.views.view import View

WIDTH = 320
"""Pixels: with QUALITY some 10 KB a picture, which a message and a journal can carry."""
QUALITY = 75
"""JPEG quality; Pillow's default, at which no block edges show."""


def jpeg(view: View) -> bytes:
    """The colours of a view, at most WIDTH pixels wide."""
    step = max(1, -(-view.shape[1] // WIDTH))
    return encode.jpeg(view.rgb[::step, ::step], QUALITY)
