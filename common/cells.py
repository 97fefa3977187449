"""Decompression of the cells of a map in a message, limited to their declared number. Pure."""

import zlib

import numpy as np
from numpy.typing import NDArray

from common import messages as m

LARGEST = 4_000_000
"""Cells of the largest map [count]: 100 x 100 m at 5 cm."""


def unpacked(message: m.Costmap | m.MapGrid) -> NDArray[np.uint8]:
    """The cells (rows, columns) of a message, row 0 in the south.

    Raises:
        ValueError: they cannot be unpacked, or are not as many as it says.
    """
    width, height = message.width, message.height
    if not (0 < width <= LARGEST and 0 < height <= LARGEST // width):
        raise ValueError(f"{width} x {height} cells")
    try:
        cells = zlib.decompressobj().decompress(message.cells, width * height + 1)
    except zlib.error as error:
        raise ValueError(f"cells: {error}") from None
    if len(cells) != width * height:
        raise ValueError(f"{len(cells)} cells for {width} x {height}")
    return np.frombuffer(cells, np.uint8).reshape(height, width)
