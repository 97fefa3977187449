"""Masks a pixel narrower or wider are those of SciPy."""

import numpy as np
import pytest
from scipy import ndimage

from services.perception.views.masks import dilated, eroded

AROUND = np.ones((3, 3))


@pytest.mark.parametrize("shape", [(1, 1), (2, 5), (3, 3), (5, 1), (40, 60)])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_they_are_those_of_scipy(shape: tuple[int, int], share: float) -> None:
    mask = np.random.default_rng(7).random(shape) < share
    assert np.array_equal(dilated(mask), ndimage.binary_dilation(mask, AROUND))
    assert np.array_equal(eroded(mask), ndimage.binary_erosion(mask, AROUND))
