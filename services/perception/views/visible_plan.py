"""What of the floor plan a view can show, and which points lie over it. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from common.floor_plan import Box, FloorPlan
from common.geometry import Rectangle

WALL_MARGIN = 0.035
"""How far [m] from a wall's face its own points are measured: four standard deviations of depth at 2.3 m."""
FAR_WALL_MARGIN = 0.075
"""The same beyond the depth `segmentation.FAR`: four standard deviations of its noise at 3.5 m."""
FLOOR_MARGIN = 0.05
"""Margin [m] around furniture in which nothing on the floor is looked for: its legs and edges are seen there. Chosen:
what fell before a table lies nearer than 0.1; what goes on into furniture is none anyway."""
ROUNDING = 0.001
"""More than single precision errs by [m]."""
SAME_TOP = 0.05
"""Difference [m] of height up to which a receptacle and a piece of furniture have the same upper side."""
LOWEST_TOP, NARROWEST = 0.12, 0.15
"""Height [m] and width [m] of the lowest and narrowest furniture on which objects are looked for."""


@dataclass(frozen=True)
class Cloud:
    """Some pixels of a view (n,), counted row by row, with their points."""

    pixels: NDArray[np.intp]
    x: NDArray[np.float32]
    y: NDArray[np.float32]
    z: NDArray[np.float32]

    def kept(self, chosen: NDArray[np.bool_]) -> "Cloud":
        few = np.flatnonzero(chosen)
        return Cloud(self.pixels.take(few), self.x.take(few), self.y.take(few), self.z.take(few))

    def joined(self, other: "Cloud") -> "Cloud":
        """Both, if neither has a pixel of the other."""
        if not len(other.pixels):
            return self
        pairs = zip(self._axes, other._axes, strict=True)
        return Cloud(np.append(self.pixels, other.pixels), *(np.append(a, b) for a, b in pairs))

    @property
    def _axes(self) -> tuple[NDArray[np.float32], ...]:
        return self.x, self.y, self.z

    def outside(self, boxes: Sequence[Rectangle]) -> "Cloud":
        """Those that lie in none of the rectangles."""
        rest = self
        for box in boxes:
            if len(rest.pixels) and rest._may_meet(box) and (within := inside(rest.x, rest.y, box)).any():
                rest = rest.kept(~within)
        return rest

    def _may_meet(self, box: Rectangle) -> bool:
        x, y, sx, sy, _ = box
        radius = math.hypot(sx, sy) / 2 + ROUNDING
        left, right, low, high = self._bounds
        return left < x + radius and right > x - radius and low < y + radius and high > y - radius

    @cached_property
    def _bounds(self) -> tuple[float, float, float, float]:
        """Least and greatest x and y [m]."""
        return float(self.x.min()), float(self.x.max()), float(self.y.min()), float(self.y.max())


def inside(x: NDArray[np.float32], y: NDArray[np.float32], box: Rectangle) -> NDArray[np.bool_]:
    """Which of the points lie in a rectangle on the floor plan, at any height."""
    c, s = abs(math.cos(box.yaw)), abs(math.sin(box.yaw))
    aside, along = (c * box.length + s * box.width) / 2 + ROUNDING, (s * box.length + c * box.width) / 2 + ROUNDING
    # Most points are far from most rectangles, which the one around it along the axes tells at less expense.
    near = (x > box.x - aside) & (x < box.x + aside) & (y > box.y - along) & (y < box.y + along)
    few = np.flatnonzero(near)
    u, v = box.to_local(x.take(few), y.take(few))
    near[few] = (np.abs(u) < box.length / 2) & (np.abs(v) < box.width / 2)
    return near


def corners(box: Rectangle, low: float, high: float) -> NDArray[np.float64]:
    """The corners (8, 3) of what stands on a rectangle between two heights."""
    u, v = box.length / 2, box.width / 2
    plan = [box.to_map(a, b) for a in (-u, u) for b in (-v, v)]
    return np.array([(*corner, z) for corner in plan for z in (low, high)])


class Nearby:
    """What of the floor plan a view can show: surfaces, wall strips, and the floor that furniture takes."""

    def __init__(self, floor_plan: FloorPlan, x: float, y: float, reach: float) -> None:
        def close(box: Rectangle) -> bool:
            return math.hypot(box.x - x, box.y - y) < reach + math.hypot(box.length, box.width) / 2

        self.receptacles = [r for r in floor_plan.receptacles if close(r.outline)]
        ends = [w.footprint for w in floor_plan.walls]
        self.walls = [w for wall in ends if close(w := wall.grown(WALL_MARGIN))]
        self.far_walls = [w for wall in ends if close(w := wall.grown(FAR_WALL_MARGIN))]
        taken = [*ends, *floor_plan.footprints]
        self.boxes = [b for box in taken if close(b := box.grown(FLOOR_MARGIN))]
        self.furniture = [f for f in floor_plan.furniture if close(f.outline)]

    def tops(self, below: float) -> list[tuple[Box, list[Rectangle]]]:
        """Furniture that ends lower than `below` [m] and is no receptacle, such as a bed, each with what stands on it:
        a sofa's back stands on its seat."""
        surfaces = [(r.center[2], r.outline) for r in self.receptacles]
        found = []
        for f in self.furniture:
            top = f.top
            used = any(abs(z - top) < SAME_TOP and box.contains(f.center[0], f.center[1]) for z, box in surfaces)
            if LOWEST_TOP < top < below and min(f.size[:2]) > NARROWEST and not used:
                found.append((f, [o.outline.grown(WALL_MARGIN) for o in self.furniture if o.top > top + SAME_TOP]))
        return found
