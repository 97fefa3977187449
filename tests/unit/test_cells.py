"""The cells of a map as a message carries them: what is unpacked, and what is refused before it fills the memory."""

import zlib

import numpy as np
import pytest

from common import messages as m
from common.cells import LARGEST, unpacked


def grid(cells: bytes, width: int = 3, height: int = 2) -> m.MapGrid:
    return m.MapGrid(t=0, x=0, y=0, resolution=0.05, width=width, height=height, cells=cells, odom=(0, 0, 0))


def test_rows_begin_in_the_south() -> None:
    cells = np.arange(6, dtype=np.uint8).reshape(2, 3)
    assert (unpacked(grid(zlib.compress(cells.tobytes()))) == cells).all()


@pytest.mark.parametrize("cells", [b"", b"nonsense", zlib.compress(bytes(5)), zlib.compress(bytes(7))])
def test_cells_of_another_number_are_refused(cells: bytes) -> None:
    with pytest.raises(ValueError, match="cells"):
        unpacked(grid(cells))


@pytest.mark.parametrize(("width", "height"), [(0, 2), (-3, -2), (LARGEST, 2), (10**12, 10**12)])
def test_a_size_that_no_map_has_is_refused(width: int, height: int) -> None:
    with pytest.raises(ValueError, match="cells"):
        unpacked(grid(zlib.compress(bytes(6)), width, height))
