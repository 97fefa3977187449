"""What a view shows of one object: its pixels, cut out by its box. Pure."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, Mask, quat_matrix
from common.messages import Vec3, WorldObject
from services.perception.naming.sides import Lens
from services.perception.views.view import View

MARGIN = 0.012
"""How far [m] beyond an object's measured box its pixels are taken. Chosen: the error of its position."""
FOOT = 0.004
"""Height [m] above what it stands on from which pixels are the object's. Chosen: the depth noise near by."""
MIN_PIXELS = 60
"""Fewest pixels that say anything of colours. Chosen: an eighth of a can at 2 m."""
BORDER = 3
"""Pixels around the object that a crop shows beside it: letters that touch the edge are read worse."""


@dataclass(frozen=True)
class Crop:
    """`rgb` (h, w, 3) with the object's pixels in `mask` (h, w); `along` (n,) is where each of these, row by row, lies
    along the object's own axis, 0 at its foot and 1 at its top.

    `size`: full extents [m], the first two in no order, the last along the axis; `distance` [m] from the camera;
    `bearing`: unit vector (3,) from the object to the camera in frame map; `seen`: share of the box's outline that
    shows the object, 0 to 1; `box`: its left, top, right and bottom [pixels] in the picture. `lens` and `believed`:
    where the crop was taken from, and of what.
    """

    rgb: NDArray[np.uint8]
    mask: Mask
    along: Array
    size: Vec3
    distance: float
    bearing: Array
    seen: float
    box: tuple[int, int, int, int] = (0, 0, 0, 0)
    lens: Lens | None = None
    believed: WorldObject | None = None

    @property
    def colours(self) -> NDArray[np.uint8]:
        """The object's pixels (n, 3), row by row."""
        return self.rgb[self.mask]

    @property
    def pixels_per_metre(self) -> float:
        """How finely what faces the camera is shown [1/m]."""
        return self.lens.focal[0] / self.distance if self.lens is not None else 0.0


def crop_of(view: View, o: WorldObject) -> Crop | None:
    """The object in the view; None when too little of it is to be seen."""
    turn, middle = quat_matrix(o.orientation), np.array(o.position)
    half = np.array(o.size) / 2
    if not (half > 0).all():
        return None
    signs = np.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)], float)
    corners = signs * (half + MARGIN) @ turn.T + middle
    u, v, depth = view.project(corners).T
    h, w = view.shape
    if depth.min() < 0.1:
        return None
    left, right = max(0, int(u.min()) - BORDER), min(w, int(u.max()) + BORDER + 1)
    top, bottom = max(0, int(v.min()) - BORDER), min(h, int(v.max()) + BORDER + 1)
    if right - left < 4 or bottom - top < 4:
        return None
    window = slice(top, bottom), slice(left, right)
    local = (view.points[window].astype(np.float64) - middle) @ turn
    mask = (np.abs(local) <= half + MARGIN).all(axis=-1) & (view.depth[window] > 0) & (local[..., 2] > FOOT - half[2])
    if np.count_nonzero(mask) < MIN_PIXELS:
        return None
    axis = 0 if o.tilt > 0.6 else 2
    along = np.clip(local[mask][:, axis] / (2 * half[axis]) + 0.5, 0.0, 1.0)
    if o.tilt > 2.0:
        along = 1.0 - along
    a, b, c = (o.size[1], o.size[2], o.size[0]) if axis == 0 else o.size
    away = view.position - middle
    distance = float(np.linalg.norm(away))
    whole = (u.max() - u.min()) * (v.max() - v.min())
    return Crop(
        rgb=view.rgb[window].copy(), mask=mask, along=along, size=(a, b, c), distance=distance,
        bearing=away / distance, seen=min(1.0, float(np.count_nonzero(mask)) / max(1.0, 0.6 * float(whole))),
        box=_box(mask, left, top), believed=o,
        lens=Lens(view.position, view.rotation, view.focal, (view.middle[0] - left, view.middle[1] - top)),
    )  # fmt: skip


def _box(mask: Mask, left: int, top: int) -> tuple[int, int, int, int]:
    """Where the pixels of a mask are in the picture that it was cut from at `left` and `top`."""
    rows, columns = np.nonzero(mask)
    return (
        left + int(columns.min()), top + int(rows.min()), left + int(columns.max()) + 1, top + int(rows.max()) + 1,
    )  # fmt: skip
