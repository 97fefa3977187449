"""Dark objects: a stereo camera finds no depth where nothing is bright enough to match; the picture shows them. Pure.

A black mug has depth on the stripes that face a lamp, and none beside them. The holes are as dark as the stripes, and
the surface around is not: what is dark and connected is one object, whose outline is the picture's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Array
from services.perception.views.view import View

Pixels = tuple[NDArray[np.intp], NDArray[np.intp]]
DARK = 42
"""Brightest channel (of 255) up to which a pixel is dark. Chosen: black paint in a lit room is below it; depth is lost
below a level of some 12."""
LEAST_BLIND = 40
"""Pixels without depth that make a dark blob worth the trouble."""
UNSEEN = 0.3
"""Share of a blob's pixels without depth from which its outline says more of it than what was measured."""
MOSTLY = 0.6
"""Share of a part's pixels that are in the blob that it belongs to."""
WIDEST, HIGHEST = 0.24, 0.32
"""Extents [m] at its distance beyond which a dark blob is furniture or shadow."""
BODY = 0.6
"""Height of the columns of a blob's body, by that of the highest."""
ROWS = 8
"""Rows with depth from which its change from row to row is measured."""


@dataclass(frozen=True)
class Blobs:
    """Connected dark pixels of a picture: `numbers` (h, w), 0 for none; `blind` (h, w): those without depth.

    `taken`: numbers of those that were found to be objects by their outline.
    """

    numbers: NDArray[np.int32]
    blind: NDArray[np.bool_]
    taken: set[int] = field(default_factory=set)

    def of(self, view: View, parts: Sequence[Pixels]) -> list[int]:
        """The number of the blob that each part belongs to, 0 for none or for one that is too large for an object."""
        found = [self._of(pixels) for pixels in parts]
        depths: dict[int, list[float]] = {}
        for number, pixels in zip(found, parts, strict=True):
            depths.setdefault(number, []).append(float(np.median(view.depth[pixels])))
        large = {n for n, far in depths.items() if n and self._is_large(n, float(np.median(far)) / view.focal[0])}
        return [0 if number in large else number for number in found]

    def _of(self, pixels: Pixels) -> int:
        counts = np.bincount(self.numbers[pixels])
        counts[0] = 0
        best = int(counts.argmax())
        return best if counts[best] >= MOSTLY * len(pixels[0]) else 0

    def _is_large(self, number: int, pixel: float) -> bool:
        rows, columns = np.nonzero(self.numbers == number)
        blind = int(np.count_nonzero(self.blind[rows, columns]))
        wide, high = float(np.ptp(columns)) * pixel, float(np.ptp(rows)) * pixel
        return blind < LEAST_BLIND or wide > WIDEST or high > HIGHEST

    def unseen(self) -> list[tuple[int, Pixels]]:
        """Numbers and pixels of the blobs most of whose outline has no depth, the picture's edge apart."""
        h, w = self.numbers.shape
        counts, blind = np.bincount(self.numbers.ravel()), np.bincount(self.numbers[self.blind], minlength=1)
        blind = np.append(blind, np.zeros(len(counts) - len(blind), np.intp))
        found = []
        for n, box in enumerate(ndimage.find_objects(self.numbers), start=1):
            if box is None or n in self.taken or blind[n] < max(LEAST_BLIND, UNSEEN * counts[n]):
                continue
            if box[0].start > 1 and box[1].start > 1 and box[0].stop < h - 1 and box[1].stop < w - 1:
                rows, columns = np.nonzero(self.numbers[box] == n)
                found.append((n, (rows + box[0].start, columns + box[1].start)))
        return found

    def hole(self, number: int) -> Pixels:
        """The pixels (rows, columns) of a blob without depth; those of a handle, which is less high, are left out."""
        blob = self.numbers == number
        heights = blob.sum(axis=0)
        rows, columns = np.nonzero(blob & self.blind & (heights > BODY * heights.max()))
        return rows, columns


def blobs(view: View) -> Blobs | None:
    """The dark blobs of a view; None where depth is lost nowhere for want of light."""
    red, green, blue = (view.rgb[..., channel] for channel in range(3))
    # The largest along an axis of three takes ten times as long.
    dark = (red < DARK) & (green < DARK) & (blue < DARK)
    blind = dark & (view.depth <= 0)
    if np.count_nonzero(blind) < LEAST_BLIND:
        return None
    numbers = ndimage.label(dark, np.ones((3, 3)))[0]
    return Blobs(numbers.astype(np.int32), blind)


def guessed(view: View, known: Pixels, hole: Pixels) -> Array:
    """Points (n, 3) [map] on the rays of a hole, as far as the pixels with depth in the rows beside them: good for
    bearings and outline, not for the shape."""
    depth = view.depth[known].astype(np.float64)
    slope, level = (0.0, float(np.median(depth)))
    if np.ptp(known[0]) >= ROWS:
        slope, level = (float(v) for v in np.polyfit(known[0].astype(np.float64), depth, 1))
    far = slope * hole[0] + level if slope or level else np.full(len(hole[0]), level)
    across = (hole[1] - view.middle[0]) / view.focal[0]
    down = (hole[0] - view.middle[1]) / view.focal[1]
    rays = np.stack([across, down, np.ones(len(far))], axis=1) * far[:, None]
    return np.asarray(rays @ view.rotation.T + view.position)
