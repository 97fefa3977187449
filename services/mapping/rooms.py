"""Rooms: parts of the floor that hang together by doors only. Pure.

Source: Bormann et al., "Room segmentation: survey, implementation, and analysis", ICRA 2016 (distance transform).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.floor_plan import Room, Wall
from services.mapping.grid import FREE, OCCUPIED, RESOLUTION, Grid

DOOR = 0.65
"""Half of the width [m] up to which a passage between two walls is a door."""
HIGH = 0.95
"""Height [m] from which on what stands there may be a wall behind furniture, of which the lidar sees nothing: above
tables, counters and the backs of sofas."""
LEAST_AREA = 2.5
"""Floor [m2] of a room, at least."""


def find_rooms(grid: Grid, states: NDArray[np.uint8], walls: Sequence[Wall]) -> list[Room]:
    """Rectangles around the rooms, the one with the robot's home first; they may overlap a little."""
    middles = grid.points((np.arange(max(grid.shape)), np.arange(max(grid.shape))))
    xs, ys = middles[: grid.shape[1], 0], middles[: grid.shape[0], 1]
    tall = grid.covered & (grid.highest > HIGH)
    for wall in walls:
        tall |= wall.footprint.grown(RESOLUTION / 2).signed_distances(xs[None, :], ys[:, None]) < 0.0
    distance = ndimage.distance_transform_edt(~tall) * RESOLUTION
    floor = (states == FREE) | ((states == OCCUPIED) & ~tall)
    labels, count = ndimage.label(floor & (distance > DOOR))
    if not count:
        return []
    sizes = np.bincount(labels.ravel(), minlength=count + 1) * RESOLUTION**2
    seeds = np.where(sizes[labels] > 0.15, labels, 0)
    # Every other cell of the floor belongs to the room whose middle is nearest.
    _, (rows, columns) = ndimage.distance_transform_edt(seeds == 0, return_indices=True)
    grown = np.where(floor, seeds[rows, columns], 0)
    boxes = []
    for n in np.unique(grown[grown > 0]):
        rows, columns = np.nonzero((grown == n) & (states == FREE))
        if len(rows) * RESOLUTION**2 < LEAST_AREA:
            continue
        points = grid.points((rows, columns))
        low, high = np.quantile(points, 0.01, axis=0) - RESOLUTION, np.quantile(points, 0.99, axis=0) + RESOLUTION
        away = float(np.hypot(points[:, 0], points[:, 1]).min())
        boxes.append((away, tuple(map(float, low.round(2))), tuple(map(float, high.round(2)))))
    ordered = enumerate(sorted(boxes), 1)
    return [Room(name=f"room {i}", low=low, high=high, named=False) for i, (_, low, high) in ordered]  # type: ignore[arg-type]
