"""The quantile of a few values."""

import numpy as np
import pytest

from common.geometry import quantile


@pytest.mark.parametrize("count", [1, 2, 3, 50, 997])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.5, 0.98, 1.0])
def test_it_is_that_of_numpy_to_the_last_bit(count: int, share: float) -> None:
    values = np.random.default_rng(count).normal(size=count)
    assert quantile(values, share) == np.quantile(values, share)
