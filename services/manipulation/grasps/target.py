"""An object as it is grasped: its pose, extents and measured surface in the base frame."""

import math
from dataclasses import dataclass, field

from common.geometry import Array
from common.kinds import Shape, kind_of
from common.messages.perception import ShapeFamily
from services.manipulation.arm.arm_model import Obstacle, Solid

LYING_FROM = 0.7
"""Tilt [rad] from which, and up to which before upside down, an object lies on its side."""
FAMILIES: dict[Shape, ShapeFamily] = {"turned": "round", "sphere": "ball", "box": "box"}
"""The family of a kind whose shape was not measured."""
SOLIDS: dict[str, Solid] = {"round": "cylinder", "bowl": "cylinder", "ball": "ellipsoid"}
"""The solid that stands for a family; for the others it is a box."""


@dataclass(frozen=True)
class Target:
    """An object in the base frame: `position` its centre, `yaw` about z, `size` full extents as it rests.

    With a `tilt` [rad] it lies: its own axis points along `yaw`, and its first extent is along that.

    `shape`: the family that was measured, "" if none was; `points` (n, 3) [m]: what was seen of its surface, from
    `position` along the axes of the base frame; `spread`: standard deviation [m] of extents and position; `measured`:
    the extents are, they were not told.
    """

    label: str
    kind: str
    position: tuple[float, float, float]
    yaw: float
    size: tuple[float, float, float]
    tilt: float = 0.0
    shape: ShapeFamily = ""
    points: Array | None = field(default=None, compare=False, repr=False)
    spread: float = 0.0
    measured: bool = False

    @property
    def family(self) -> ShapeFamily:
        """The shape that was measured, or that of its kind."""
        return self.shape or FAMILIES[kind_of(self.kind).shape]

    @property
    def solid(self) -> Solid:
        """The solid that contains it."""
        if self.lies and self.family == "long":
            return "cylinder"
        return SOLIDS.get(self.family, "box")

    def grown(self, margin: float) -> Obstacle:
        """Its solid, `margin` [m] larger on every side but the lower one."""
        x, y, z = self.size
        size = (x + 2 * margin, y + 2 * margin, z + margin)
        return Obstacle(self.position, size, self.yaw, self.solid, self.lies, self.label)

    @property
    def lies(self) -> bool:
        return LYING_FROM < self.tilt < math.pi - LYING_FROM

    @property
    def upside_down(self) -> bool:
        return self.tilt >= math.pi - LYING_FROM

    @property
    def bottom(self) -> float:
        return self.position[2] - self.size[2] / 2
