"""The free edge of a surface that the robot stands before. Pure."""

import math
from dataclasses import dataclass

import numpy as np

from common.floor_plan import Receptacle
from common.geometry import Array, Pose2, compose, inverse


@dataclass(frozen=True)
class Edge:
    """A free edge of a surface in the base frame: points p with p @ outward == offset [m], `outward` (2,).

    `middle` [m]: of its points along it, `half` its half length, `height` the surface's.
    """

    outward: Array
    offset: float
    height: float
    middle: float
    half: float

    def inset(self, x: float, y: float) -> float:
        """How far [m] inside the edge a point is."""
        return self.offset - float(self.outward @ (x, y))

    def along(self, x: float, y: float) -> float:
        """How far [m] along the edge a point is from its middle, to the left seen from outside."""
        return float(self.outward[0] * y - self.outward[1] * x) - self.middle

    def point(self, inset: float, along: float) -> tuple[float, float]:
        """The point (x, y) that is so far inside and along the edge [m]."""
        (ox, oy), out, side = self.outward, self.offset - inset, along + self.middle
        return float(out * ox - side * oy), float(out * oy + side * ox)


def facing_edge(surface: Receptacle, base: Pose2) -> Edge | None:
    """The free edge that the robot stands before; None before none."""
    x, y, turn = compose(inverse(base), (surface.center[0], surface.center[1], surface.yaw))
    c, s = math.cos(turn), math.sin(turn)
    found = []
    for ax, ay in surface.approach:
        outward = np.array([c * ax - s * ay, s * ax + c * ay])
        half = (abs(ax) * surface.size[0] + abs(ay) * surface.size[1]) / 2
        length = (abs(ay) * surface.size[0] + abs(ax) * surface.size[1]) / 2
        middle = float(outward[0] * y - outward[1] * x)
        edge = Edge(outward, float(outward @ (x, y)) + half, surface.center[2], middle, length)
        if edge.inset(0.0, 0.0) < 0:
            found.append(edge)
    return min(found, key=lambda e: e.inset(0.0, 0.0), default=None)
