"""Weights of learnt models in 8 bits, as they are kept in files."""

import numpy as np
import numpy.typing as npt

_STEPS = 127
"""Steps of an 8-bit weight to either side."""
_LEAST = 1e-9
"""Least size that the greatest weight is taken for, so that weights that are all 0 can be kept."""


def in_8_bits(weights: npt.NDArray[np.float32]) -> tuple[npt.NDArray[np.int8], npt.NDArray[np.float32]]:
    """Whole numbers, and the step () that they count: their product is the weights."""
    step = np.asarray(max(np.abs(weights).max(), _LEAST) / _STEPS, np.float32)
    return np.round(weights / step).astype(np.int8), step
