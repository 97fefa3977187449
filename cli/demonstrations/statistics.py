"""Statistics of a feature, by which LeRobot normalises: minimum, maximum, mean, standard deviation, count. Pure."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cli.demonstrations.sampler import Picture

Statistics = dict[str, Any]
PICTURES = 100
"""Pictures of an episode from which its statistics are taken, evenly spread; chosen, as in LeRobot, for speed."""


def of_values(values: Any) -> Statistics:
    """Statistics of (n,) or (n, d) values over n; lists of length d, of 1 for (n,)."""
    rows = np.asarray(values, np.float64).reshape(len(values), -1)
    return _summary(rows, len(rows))


def of_pictures(pictures: Sequence[Picture]) -> Statistics:
    """Statistics of three channels (0 to 1) over all pixels of some pictures; nested lists of shape (3, 1, 1)."""
    chosen = np.unique(np.linspace(0, len(pictures) - 1, min(len(pictures), PICTURES)).round().astype(int))
    pixels = [np.frombuffer(pictures[i].rgb, np.uint8).reshape(-1, 3) for i in chosen]
    found = _summary(np.concatenate(pixels) / 255.0, len(chosen))
    return {k: v if k == "count" else [[[x]] for x in v] for k, v in found.items()}


def merged(parts: Sequence[Statistics]) -> Statistics:
    """Statistics of several samples together: means weighted by count, variances with the spread of the means.

    Source: Chan, Golub, LeVeque, "Updating formulae and a pairwise algorithm for computing sample variances", 1979.
    """
    counts = np.array([part["count"][0] for part in parts], np.float64)
    shape = np.shape(parts[0]["mean"])
    weights = (counts / counts.sum()).reshape(-1, *[1] * len(shape))
    means = np.array([part["mean"] for part in parts])
    deviations = np.array([part["std"] for part in parts])
    mean = (weights * means).sum(axis=0)
    variance = (weights * (deviations**2 + (means - mean) ** 2)).sum(axis=0)
    return {
        "min": np.min([part["min"] for part in parts], axis=0).tolist(),
        "max": np.max([part["max"] for part in parts], axis=0).tolist(),
        "mean": mean.tolist(),
        "std": np.sqrt(variance).tolist(),
        "count": [int(counts.sum())],
    }


def _summary(rows: Any, count: int) -> Statistics:
    """Over the rows of (n, d); `count` is what they stand for."""
    return {
        "min": rows.min(axis=0).tolist(),
        "max": rows.max(axis=0).tolist(),
        "mean": rows.mean(axis=0).tolist(),
        "std": rows.std(axis=0).tolist(),
        "count": [count],
    }
