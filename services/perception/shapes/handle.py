"""Handles in the picture: what is as thin as one beside a body that is not. Pure."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

THICK = 0.016
"""Width [m] at its distance of what is a handle and no body: the bars of mugs and pans have 6 to 12 mm."""
BODY = 0.7
"""Least share of the pixels that are left without handles: else all of it is as thin as one."""
SHARE = 0.02
"""Least share of the pixels that are of a handle. Chosen: more than corners that the removal rounds off."""


@dataclass(frozen=True)
class Parts:
    """An object's `body` and its `handle` (h, w), none if none is seen, from pixel `row`, `column` on."""

    body: NDArray[np.bool_]
    handle: NDArray[np.bool_]
    row: int
    column: int

    def of_body(self, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> NDArray[np.bool_]:
        return np.asarray(self.body[rows - self.row, columns - self.column])

    def of_handle(self, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> NDArray[np.bool_]:
        return np.asarray(self.handle[rows - self.row, columns - self.column])


def parted(rows: NDArray[np.intp], columns: NDArray[np.intp], pixel: float) -> Parts:
    """Body and handle of an object's pixels, which are `pixel` [m] wide where it is."""
    # Two pixels more on every side, so that closing does not end at an edge.
    row, column = int(rows.min()) - 2, int(columns.min()) - 2
    mask = np.zeros((int(np.ptp(rows)) + 5, int(np.ptp(columns)) + 5), bool)
    mask[rows - row, columns - column] = True
    # Rims and edges have no depth and may be missing as lines.
    mask = ndimage.binary_closing(mask, np.ones((2, 2)))
    side = max(2, round(THICK / pixel))
    body = ndimage.binary_opening(mask, np.ones((side, side)))
    if np.count_nonzero(body) < BODY * len(rows):
        return Parts(mask, np.zeros_like(mask), row, column)
    labels, count = ndimage.label(body)
    if count > 1:
        body = labels == 1 + int(np.bincount(labels[body])[1:].argmax())
    body |= _stands_on(mask, body)
    return Parts(body, _handle(mask, body), row, column)


def _stands_on(mask: NDArray[np.bool_], body: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The parts below the body: the stem and the foot of a glass, without which it would stand farther away."""
    labels, _ = ndimage.label(mask & ~body, np.ones((3, 3)))
    lowest = np.flatnonzero(body.any(axis=1))[-1]
    across = np.flatnonzero(body.any(axis=0))
    found = np.zeros_like(mask)
    for n, box in enumerate(ndimage.find_objects(labels), start=1):
        middle = (box[1].start + box[1].stop - 1) / 2
        if box[0].stop - 1 > lowest and across[0] <= middle <= across[-1]:
            found |= labels == n
    return found


def _handle(mask: NDArray[np.bool_], body: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The largest thin part at the side of the body."""
    labels, count = ndimage.label(mask & ~body, np.ones((3, 3)))
    across = np.flatnonzero(body.any(axis=0))
    parts = (labels == n + 1 for n in range(count))
    beside = [p for p in parts if not across[0] <= float(np.nonzero(p)[1].mean()) <= across[-1]]
    part = max(beside, key=np.count_nonzero, default=np.zeros_like(mask))
    return part if np.count_nonzero(part) >= SHARE * np.count_nonzero(mask) else np.zeros_like(mask)
