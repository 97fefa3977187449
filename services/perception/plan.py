"""What of the floor plan a view can show, and which points lie over it. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from common.scene import Receptacle, Scene

WALL_MARGIN = 0.035
FLOOR_MARGIN = 0.10
# A rectangle on the floor plan: middle, yaw, size.
Box = tuple[float, float, float, float, float]


@dataclass(frozen=True)
class Cloud:
    """Some pixels of a view (n,), counted row by row, with their points."""

    pixels: NDArray[np.intp]
    x: NDArray[np.float32]
    y: NDArray[np.float32]
    z: NDArray[np.float32]

    def kept(self, chosen: NDArray[np.bool_]) -> "Cloud":
        return Cloud(self.pixels[chosen], self.x[chosen], self.y[chosen], self.z[chosen])

    def outside(self, boxes: Sequence[Box]) -> "Cloud":
        """Those that lie in none of the rectangles."""
        rest = self
        for box in boxes:
            if len(rest.pixels) and rest._may_meet(box) and (within := inside(rest.x, rest.y, box)).any():
                rest = rest.kept(~within)
        return rest

    def _may_meet(self, box: Box) -> bool:
        x, y, _, sx, sy = box
        radius = math.hypot(sx, sy) / 2 + 0.001
        return bool(
            self.x.min() < x + radius
            and self.x.max() > x - radius
            and self.y.min() < y + radius
            and self.y.max() > y - radius
        )


def box_of(r: Receptacle, margin: float) -> Box:
    return r.center[0], r.center[1], r.yaw, r.size[0] + 2 * margin, r.size[1] + 2 * margin


def inside(x: NDArray[np.float32], y: NDArray[np.float32], box: Box) -> NDArray[np.bool_]:
    """Which of the points lie in a rectangle on the floor plan, at any height."""
    middle_x, middle_y, yaw, sx, sy = box
    c, s = math.cos(yaw), math.sin(yaw)
    dx, dy = x - np.float32(middle_x), y - np.float32(middle_y)
    found: NDArray[np.bool_] = (np.abs(c * dx + s * dy) < sx / 2) & (np.abs(c * dy - s * dx) < sy / 2)
    return found


def corners(box: Box, low: float, high: float) -> NDArray[np.float64]:
    """The corners (8, 3) of what stands on a rectangle between two heights."""
    x, y, yaw, sx, sy = box
    c, s = math.cos(yaw), math.sin(yaw)
    plan = [(x + c * a - s * b, y + s * a + c * b) for a in (-sx / 2, sx / 2) for b in (-sy / 2, sy / 2)]
    return np.array([(*corner, z) for corner in plan for z in (low, high)])


class Nearby:
    """What of the floor plan a view can show: surfaces, wall strips, and the floor that furniture takes."""

    def __init__(self, scene: Scene, x: float, y: float, reach: float) -> None:
        def close(box: Box) -> bool:
            return math.hypot(box[0] - x, box[1] - y) < reach + math.hypot(box[3], box[4]) / 2

        self.receptacles = [r for r in scene.receptacles if close(box_of(r, 0.0))]
        self.walls: list[Box] = []
        self.boxes: list[Box] = []
        for wall in scene.walls:
            dx, dy = wall.end[0] - wall.start[0], wall.end[1] - wall.start[1]
            mx, my = (wall.start[0] + wall.end[0]) / 2, (wall.start[1] + wall.end[1]) / 2
            length, yaw = math.hypot(dx, dy), math.atan2(dy, dx)
            for margin, into in ((WALL_MARGIN, self.walls), (FLOOR_MARGIN, self.boxes)):
                width = wall.thickness + 2 * margin
                if close((mx, my, yaw, length + width, width)):
                    into.append((mx, my, yaw, length + width, width))
        self.boxes += [b for r in scene.receptacles if close(b := box_of(r, FLOOR_MARGIN))]
        for f in scene.furniture:
            box = (f.center[0], f.center[1], f.yaw, f.size[0] + 2 * FLOOR_MARGIN, f.size[1] + 2 * FLOOR_MARGIN)
            if close(box):
                self.boxes.append(box)
