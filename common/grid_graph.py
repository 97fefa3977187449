"""Graph of the free cells of a grid, for shortest paths. Pure."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Step = tuple[int, int]
"""Rows and columns from a cell to another."""


def steps(reach: int) -> list[Step]:
    """Steps to one half of the neighbours up to `reach` rows and columns away; the same lead back from the others."""
    there = range(-reach, reach + 1)
    return [(r, c) for r in there for c in there if math.gcd(r, c) == 1 and (r > 0 or (r == 0 and c > 0))]


def nearest_free(free: NDArray[np.bool_], cell: tuple[int, int]) -> tuple[int, int]:
    """The cell itself where it is `free` (rows, columns) or none is, else the nearest that is."""
    if free[cell] or not free.any():
        return cell
    rows, columns = np.nonzero(free)
    nearest = int(np.argmin(np.square(rows - cell[0]) + np.square(columns - cell[1])))
    return int(rows[nearest]), int(columns[nearest])


def graph_of(
    free: NDArray[np.bool_], resolution: float, reach: int, weight: NDArray[np.float64] | None = None
) -> sparse.csr_matrix:
    """Links [m] in one direction between `free` cells (rows, columns) that are one of the `steps(reach)` apart.

    `weight` (rows, columns): what a metre costs in each cell, None: 1. Node `row * columns + column` is that cell.
    """
    rows, columns = free.shape
    numbers = np.arange(free.size).reshape(free.shape)
    heads, tails, lengths = [], [], []
    for down, right in steps(reach):
        here = slice(0, rows - down), slice(max(0, -right), columns - max(0, right))
        there = slice(down, rows), slice(max(0, right), columns + min(0, right))
        both = free[here] & free[there]
        heads.append(numbers[here][both])
        tails.append(numbers[there][both])
        mean = 1.0 if weight is None else 0.5 * (weight[here] + weight[there])[both]
        lengths.append(np.full(int(both.sum()), math.hypot(down, right) * resolution) * mean)
    ends = np.concatenate(heads), np.concatenate(tails)
    return sparse.csr_matrix((np.concatenate(lengths), ends), shape=(free.size, free.size))
