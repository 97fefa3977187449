"""Views of the floor of rooms, for what was said to lie there. Pure."""

import math
from functools import cached_property, lru_cache

import numpy as np

from common.floor_grid import Cells, static_distances
from common.floor_plan import Room
from common.free_sides import floor_from_home
from common.geometry import Mask, Pose2
from common.viewpoints import LIFT, REACH, Viewpoints

SPACING, CLEAR = 0.25, 0.10
"""Distance between sample points of the floor, and from them to walls and furniture [m]. Chosen: a view shows some
fifty, and what lies against a wall has its middle there."""
APART, HEADINGS = 10, 8
"""From one spot of free floor to the next from which the floor is looked at [cells], 50 cm, and directions from each
[count]. Chosen: a picture is wider than both."""


class FloorViews(Viewpoints):
    """The floor of `rooms` as points, and poses to see it from all around; cameras as of other `viewpoints`."""

    def __init__(self, viewpoints: Viewpoints, rooms: tuple[Room, ...]) -> None:
        super().__init__(viewpoints.plan, viewpoints.camera)
        cells = Cells(self.plan, SPACING)
        at = cells.centres()[static_distances(cells, self.plan) >= CLEAR]
        within = [np.zeros(len(at), bool), *(room.outline.signed_distances(*at.T) < 0.0 for room in rooms)]
        at = at[np.any(within, axis=0)]
        self.points = np.column_stack([at, np.full(len(at), LIFT)])

    @cached_property
    def _views(self) -> list[tuple[Pose2, Mask]]:
        cells, free = floor_from_home(self.plan)
        spots = cells.centres()[::APART, ::APART][free[::APART, ::APART]]
        near = [(x, y) for x, y in spots.tolist() if (np.hypot(*(self.points[:, :2] - (x, y)).T) < REACH).any()]
        turns = [math.remainder(math.tau * k / HEADINGS, math.tau) for k in range(HEADINGS)]
        poses = [(round(x, 3), round(y, 3), round(turn, 3)) for x, y in near for turn in turns]
        return [(pose, shown) for pose in poses if (shown := self.visible(pose)).any()]


@lru_cache(maxsize=8)
def floor_views(viewpoints: Viewpoints, rooms: tuple[Room, ...]) -> FloorViews:
    """The views of the floor of those rooms, made once."""
    return FloorViews(viewpoints, rooms)
