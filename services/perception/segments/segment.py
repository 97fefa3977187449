"""A segment of a view, and what the pixels around it say: something hides a part of it, or it goes on. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Mask
from services.perception.shapes.measurement import Measurement
from services.perception.views.view import View, Window

DEPTH_NOISE = 0.0015
"""Standard deviation [m] of depth at 1 m, growing with the square of the distance (stereo cameras' data sheets)."""
RIM = 3
"""Width [pixels] of the band around a segment in which something nearer is looked for."""
NEARER = 0.03
"""How much nearer [m] than the segment a neighbour must be to hide a part of it."""
HIDDEN, HIDDEN_END = 0.06, 0.25
"""Shares of that band, and of the band at its left or right end, from which the segment counts as cut."""


@dataclass(frozen=True)
class Surface:
    """A horizontal surface as it was seen: `height` [m] measured, `name` "" for the floor."""

    name: str
    height: float


@dataclass(frozen=True)
class Segment:
    """One object on a surface: its pixels (rows, columns) and their points (n, 3) in frame map.

    `cut`: the picture's edge or something nearer hides a part of it; `ends`: its right and its left end are in view.
    `dark` (n, 3): about where its pixels without depth are, that belong to its outline and tell nothing of its shape.
    `shape`: what its outline says that it is, where there is too little depth.
    """

    surface: Surface
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    points: NDArray[np.float64]
    cut: bool
    ends: tuple[bool, bool]
    dark: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 3)))
    shape: Measurement | None = None

    @property
    def top(self) -> float:
        """Its height [m] over the surface."""
        return float(self.points[:, 2].max()) - self.surface.height


def renumbered(names: NDArray[np.intp]) -> NDArray[np.intp] | None:
    """Names of pieces (n,) as numbers from 0 on; None where there is but one piece."""
    kept, found = np.unique(names, return_inverse=True)
    return found.reshape(-1).astype(np.intp) if len(kept) > 1 else None


def spread(segment: Segment, patches: Sequence[tuple[NDArray[np.intp], NDArray[np.intp]]]) -> NDArray[np.intp]:
    """Number (n,) of the patch of each pixel of a segment; what belongs to none joins the nearest in the picture."""
    top, left = int(segment.rows.min()), int(segment.columns.min())
    numbered = np.full((int(np.ptp(segment.rows)) + 1, int(np.ptp(segment.columns)) + 1), -1)
    for n, (rows, columns) in enumerate(patches):
        numbered[rows - top, columns - left] = n
    nearest = ndimage.distance_transform_edt(numbered < 0, return_distances=False, return_indices=True)
    found = numbered[tuple(nearest)][segment.rows - top, segment.columns - left]
    return np.asarray(found, np.intp)


def covered(view: View, rows: NDArray[np.intp], columns: NDArray[np.intp], own: Mask) -> tuple[bool, bool, bool]:
    """Whether something nearer, or the robot itself (`own`), covers a part of the segment, its left, its right end."""
    window, mask = _around(view, rows, columns)
    depth, left = view.depth[window], window[1].start
    rim = ndimage.binary_dilation(mask, iterations=RIM) & ~mask
    own_depth = view.depth[rows, columns]
    nearest = float(own_depth[own_depth > 0].min())
    nearer = rim & (own[window] | (depth > 0) & (depth < nearest - NEARER))
    first, last = int(columns.min()) - left, int(columns.max()) - left

    def much(part: slice, share: float) -> bool:
        return bool(np.count_nonzero(nearer[:, part]) > share * np.count_nonzero(rim[:, part]))

    return (
        much(slice(None), HIDDEN),
        much(slice(0, first + RIM), HIDDEN_END),
        much(slice(last + 1 - RIM, None), HIDDEN_END),
    )


def with_top(view: View, segment: Segment, own: Mask, low: float, high: float) -> Segment:
    """A segment with what the picture shows right above it, from `low` to `high` [m, map]; `own` (h, w): the robot."""
    (left, near), (right, far) = segment.points[:, :2].min(axis=0), segment.points[:, :2].max(axis=0)
    columns = slice(int(segment.columns.min()), int(segment.columns.max()) + 1)
    x, y, z = np.moveaxis(view.points[: int(segment.rows.max()), columns], -1, 0)
    over = (x >= left) & (x <= right) & (y >= near) & (y <= far) & (z >= low) & (z < high)
    over &= (view.depth[: over.shape[0], columns] > 0) & ~own[: over.shape[0], columns]
    over[segment.rows[segment.rows < over.shape[0]], segment.columns[segment.rows < over.shape[0]] - columns.start] = (
        False
    )
    rows, across = np.nonzero(over)
    across = across + columns.start
    points = np.concatenate([segment.points, view.points[rows, across].astype(np.float64)])
    return replace(
        segment, rows=np.append(segment.rows, rows), columns=np.append(segment.columns, across), points=points
    )


def goes_on(view: View, segment: Segment, over_it: Mask, clearance: float, jump: float) -> float:
    """Share of the band around a segment in which its surface goes on beyond where objects are looked for: then it is
    a part of the furniture or a wall.

    `over_it` (h, w): where they are looked for; `clearance` [m]: height over the surface from which points count;
    `jump` [m]: step of depth at which a surface ends.
    """
    window, mask = _around(view, segment.rows, segment.columns)
    band = ndimage.binary_dilation(mask, iterations=RIM) & ~mask
    depth = view.depth[window]
    nearest = ndimage.distance_transform_edt(~mask, return_distances=False, return_indices=True)
    on = band & ~over_it[window] & (depth > 0) & (np.abs(depth - depth[tuple(nearest)]) < jump)
    on &= view.points[window][..., 2] > segment.surface.height + clearance
    return float(np.mean(on[band])) if band.any() else 0.0


def _around(view: View, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> tuple[Window, Mask]:
    """The window of the picture around some pixels, RIM wider, and which of its pixels they are."""
    top, left = max(0, int(rows.min()) - RIM), max(0, int(columns.min()) - RIM)
    window = (slice(top, int(rows.max()) + RIM + 1), slice(left, int(columns.max()) + RIM + 1))
    mask = np.zeros(view.depth[window].shape, bool)
    mask[rows - top, columns - left] = True
    return window, mask
