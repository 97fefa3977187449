"""Whether parts lie in one line, end to end: a tool, whatever is missing between its blade and its handle. Pure."""

import itertools
from collections.abc import Sequence

import numpy as np

from common.geometry import Array

JOIN = 0.02
"""Gap [m] on the floor plan up to which two segments belong to one object: a rim's two sides, a bottle and its cap."""
LONGEST, WIDEST, HIGHEST = 0.42, 0.12, 0.07
"""Extents [m] of the largest tool, and its height over the surface: a ladle, a rolling pin; a brush on its edge."""
SLIM, HANDLE = 3.0, 2.0
"""Length by width of a tool at least, and of one of its parts: three blocks in a row have none that is long."""
OVERLAP = 0.2
"""Share of the shorter of two parts up to which they overlap along the line."""
ASIDE, BESIDE = 1.3, 0.006
"""Width of all by that of the widest part, and what [m] it is more, up to which they are in line."""
STRAYS = 0.02
"""Share of the points at either end that are left out."""


def end_to_end(parts: Sequence[Array]) -> bool:
    """Parts, each (n, 3) [m, over the surface], lie one after the other along a line, and are no longer than a tool."""
    every = np.concatenate(parts)
    middle = every[:, :2].mean(axis=0)
    plan = every[:, :2] - middle
    turn = np.linalg.eigh(np.cov(plan.T))[1]
    spans, widths = [], []
    for part in parts:
        (low, start), (high, end) = np.quantile((part[:, :2] - middle) @ turn, (STRAYS, 1 - STRAYS), axis=0)
        spans.append((start, end))
        widths.append(high - low)
    across, along = np.ptp(np.quantile(plan @ turn, (STRAYS, 1 - STRAYS), axis=0), axis=0)
    slim = SLIM * across < along < LONGEST and across < min(WIDEST, ASIDE * max(widths) + BESIDE)
    handle = any(end - start > HANDLE * wide for (start, end), wide in zip(spans, widths, strict=True))
    if not slim or not handle or np.quantile(every[:, 2], 1 - STRAYS) > HIGHEST:
        return False
    spans.sort()
    return all(
        before[1] - after[0] < OVERLAP * min(before[1] - before[0], after[1] - after[0])
        for before, after in itertools.pairwise(spans)
    )
