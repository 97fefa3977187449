"""What a building is made of: walls, furniture, receptacles, rooms, places and what may stand in the way.

All lengths in metres, angles in radians, everything in frame `map`.
"""

import math
from typing import Literal

import msgspec

from common.geometry import Rectangle

Vec2 = tuple[float, float]
Vec3 = tuple[float, float, float]
Rgba = tuple[float, float, float, float]
ReceptacleKind = Literal["table", "counter", "shelf", "bin", "tray", "sink"]
# How furniture is built: a table's legs and how far inside the top's edge they stand, how far a cabinet's body stays
# behind its top, the thickness of a bin's walls [m].
LEG, LEG_INSET, BODY_INSET, BIN_WALL = 0.05, 0.04, 0.01, 0.015


class Strict(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    pass


class Wall(Strict, frozen=True):
    """A straight wall from `start` to `end`; doors are gaps between walls."""

    start: Vec2
    end: Vec2
    thickness: float = 0.12
    height: float = 2.4

    @property
    def outline(self) -> Rectangle:
        """Where it stands on the floor plan."""
        dx, dy = self.end[0] - self.start[0], self.end[1] - self.start[1]
        x, y = (self.start[0] + self.end[0]) / 2, (self.start[1] + self.end[1]) / 2
        return Rectangle(x, y, math.hypot(dx, dy), self.thickness, math.atan2(dy, dx))

    @property
    def footprint(self) -> Rectangle:
        """The outline, longer by half the thickness at both ends, where it closes the corner with another wall."""
        return self.outline._replace(length=self.outline.length + self.thickness)


class Box(Strict, frozen=True):
    """A box of furniture: `size` is the full extent, `center` its middle, `yaw` about z."""

    name: str
    center: Vec3
    size: Vec3
    yaw: float = 0.0
    rgba: Rgba = (0.7, 0.6, 0.5, 1.0)

    @property
    def outline(self) -> Rectangle:
        """Where it stands on the floor plan."""
        return Rectangle(self.center[0], self.center[1], self.size[0], self.size[1], self.yaw)


class Receptacle(Strict, frozen=True):
    """A surface or container that holds objects.

    `center` is the middle of the usable surface (z = its height, or the inner floor of a bin), `size` its
    usable extent along its own x and y. `approach` lists the directions (unit steps in its own frame) from
    which the robot has free floor. `furniture` names the boxes that make it up. `depth` is the wall height of a bin.
    """

    name: str
    kind: ReceptacleKind
    center: Vec3
    size: Vec2
    yaw: float = 0.0
    depth: float = 0.0
    approach: tuple[Vec2, ...] = ()
    aliases: tuple[str, ...] = ()
    spawn: bool = True
    colour: str = ""

    @property
    def outline(self) -> Rectangle:
        """The usable extent on the floor plan."""
        return Rectangle(self.center[0], self.center[1], self.size[0], self.size[1], self.yaw)

    def contains(self, x: float, y: float, margin: float = 0.0) -> bool:
        """True when the point (x, y) [map] lies within the usable extent, or at most `margin` [m] beyond its sides."""
        return self.outline.contains(x, y, margin)


class Room(Strict, frozen=True):
    """A named axis-aligned room between corners `low` and `high`."""

    name: str
    low: Vec2
    high: Vec2
    aliases: tuple[str, ...] = ()


class Place(Strict, frozen=True):
    """A named standing pose of the base."""

    name: str
    x: float
    y: float
    theta: float = 0.0
    aliases: tuple[str, ...] = ()


class Obstacle(Strict, frozen=True):
    """Something in the simulated world that the robot's map does not have.

    It stands at `position`, turned by `yaw`; `size` is its full extent. With a `path` it goes from there along these
    points at `speed`: after `start` seconds, and, if `near` is set, once the robot is so near to its place or path.
    `repeat`: to and fro for ever, else it stays at the end. `polite`: it waits while the robot is in its way.
    With `placed = false` it is there only when `sim.obstacles` names it.
    """

    name: str
    position: Vec2
    kind: Literal["box", "cylinder"] = "cylinder"
    size: Vec3 = (0.4, 0.4, 1.65)
    yaw: float = 0.0
    path: tuple[Vec2, ...] = ()
    speed: float = 0.6
    start: float = 0.0
    near: float = 0.0
    repeat: bool = False
    polite: bool = True
    placed: bool = True
    rgba: Rgba = (0.55, 0.35, 0.60, 1.0)
