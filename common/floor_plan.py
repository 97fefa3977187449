"""What a building is made of: walls, furniture, receptacles, rooms and places.

All lengths in metres, angles in radians, everything in frame `map`.
"""

import math
from collections import Counter
from collections.abc import Iterable
from typing import Literal

import msgspec

from common.geometry import Rectangle

Vec2 = tuple[float, float]
Vec3 = tuple[float, float, float]
Rgba = tuple[float, float, float, float]
ReceptacleKind = Literal["table", "counter", "shelf", "bin", "tray", "sink"]
DRIVEN_OVER, PASSED_UNDER = 0.02, 1.45
"""How high [m] a rug is at most, which the base drives over (its bumper is 27 mm above the floor), and from where on
furniture hangs above the robot."""
SUNK = 0.05
"""How far [m] below a surface the centre of what rests on it may be seen: the error of its height."""
TALLEST = 0.35
"""How far [m] above a surface the centre of what rests on it is looked for: beyond half of the tallest object."""
ROUNDING = 1e-9
"""What the edge of a room is off by in arithmetic [m]."""
SIGHTING_ERROR = 0.02
"""How far [m] over the edge of a surface the centre of what rests on it may be seen: the error at arm's length."""


class Strict(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    pass


class Wall(Strict, frozen=True):
    """A straight wall from `start` to `end`; doors are gaps between walls. One of `glass` is not seen by a lidar."""

    start: Vec2
    end: Vec2
    thickness: float = 0.12
    height: float = 2.4
    glass: bool = False

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

    @property
    def top(self) -> float:
        """Height [m] of its upper side."""
        return self.center[2] + self.size[2] / 2


class Receptacle(Strict, frozen=True):
    """A surface or container that holds objects.

    `center` is the middle of the usable surface (z = its height, or the inner floor of a bin), `size` its
    usable extent along its own x and y. `approach` lists the directions (unit steps in its own frame) from
    which the robot has free floor; a file that leaves it out has those that are free by its plan. `depth` is the wall
    height of a bin.
    With `named = false` its name is an identifier, and it is called by its kind and room until a person names it.
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
    named: bool = True

    @property
    def outline(self) -> Rectangle:
        """The usable extent on the floor plan."""
        return Rectangle(self.center[0], self.center[1], self.size[0], self.size[1], self.yaw)

    @property
    def spoken(self) -> str:
        """How people say where a thing is: `on the table`, `in the bin`."""
        return f"{'in' if self.depth else 'on'} the {self.name}"

    def contains(self, x: float, y: float, margin: float = 0.0) -> bool:
        """True when the point (x, y) [map] lies within the usable extent, or at most `margin` [m] beyond its sides."""
        return self.outline.contains(x, y, margin)


class Room(Strict, frozen=True):
    """A room between corners `low` and `high`, then turned by `yaw` about its middle.

    With `named = false` it is called by a number.
    """

    name: str
    low: Vec2
    high: Vec2
    yaw: float = 0.0
    aliases: tuple[str, ...] = ()
    named: bool = True

    @property
    def outline(self) -> Rectangle:
        """The floor that it has."""
        (x0, y0), (x1, y1) = self.low, self.high
        return Rectangle((x0 + x1) / 2, (y0 + y1) / 2, x1 - x0, y1 - y0, self.yaw)

    @property
    def middle(self) -> Vec2:
        """The middle of its floor."""
        return self.outline.x, self.outline.y

    def contains(self, x: float, y: float) -> bool:
        """True when the point (x, y) [map] lies within it or on its edge."""
        return self.outline.contains(x, y, ROUNDING)


class Place(Strict, frozen=True):
    """A named standing pose of the base."""

    name: str
    x: float
    y: float
    theta: float = 0.0
    aliases: tuple[str, ...] = ()


class FloorPlan(Strict, frozen=True, kw_only=True):
    """A building as a map has it: what stands firmly in it, and how people call its parts.

    `home` is where the robot starts, `delivery` the receptacle that it brings things to.
    """

    name: str
    low: Vec2
    high: Vec2
    home: Place
    walls: tuple[Wall, ...] = ()
    furniture: tuple[Box, ...] = ()
    rooms: tuple[Room, ...] = ()
    places: tuple[Place, ...] = ()
    receptacles: tuple[Receptacle, ...] = ()
    delivery: str = ""

    def receptacle(self, name: str) -> Receptacle | None:
        """The receptacle called `name` or by that alias, None if unknown."""
        return next((r for r in self.receptacles if name == r.name or name in r.aliases), None)

    def surface_at(
        self,
        x: float,
        y: float,
        z: float | None = None,
        margin: float = 0.0,
        below: float = SUNK,
        above: float = math.inf,
    ) -> Receptacle | None:
        """The receptacle whose usable surface is under the point (x, y, z) [map]; without `z` at whatever height.

        Distances in metres: the point is at most `margin` beyond the surface's sides, `below` under it and `above` over
        it, or in a bin between its walls.
        """
        for r in self.receptacles:
            if r.contains(x, y, margin) and (
                z is None or r.center[2] - below <= z <= max(r.center[2] + above, r.depth)
            ):
                return r
        return None

    def resting_place(self, position: Vec3) -> Receptacle | None:
        """The receptacle on or in which an object with its centre at `position` [map] was seen to rest."""
        return self.surface_at(*position, margin=SIGHTING_ERROR, above=TALLEST)

    @property
    def standing(self) -> list[Box]:
        """The furniture that is in the base's way: no rug, and nothing that hangs above the robot."""
        return [f for f in self.furniture if f.top > DRIVEN_OVER and f.top - f.size[2] < PASSED_UNDER]

    @property
    def footprints(self) -> list[Rectangle]:
        """Where receptacles and furniture stand on the floor plan."""
        return [r.outline for r in self.receptacles] + [f.outline for f in self.standing]

    def room_at(self, x: float, y: float) -> Room | None:
        """The room that contains the point (x, y), the smallest one: in the corner of an L there may be another."""
        there = [r for r in self.rooms if r.contains(x, y)]
        return min(there, key=lambda r: r.outline.length * r.outline.width, default=None)

    def fault(self) -> str:
        """What makes the plan impossible, in words; "" when nothing does."""
        for label, names in (
            ("receptacle", [r.name for r in self.receptacles]), ("place", [p.name for p in self.places]),
            ("room", [r.name for r in self.rooms]),
        ):  # fmt: skip
            if twice := doubled(names):
                return f"{label} {twice!r} is defined twice"
        if not (self.low[0] < self.high[0] and self.low[1] < self.high[1]):
            return f"low {self.low} is not below and left of high {self.high}"
        if self.delivery and self.receptacle(self.delivery) is None:
            return f"delivery {self.delivery!r} is no receptacle"
        return ""


def doubled(names: Iterable[str]) -> str:
    """The first name that is there more than once, "" when none is."""
    return next((name for name, count in Counter(names).items() if count > 1), "")
