"""Random homes: a flat with furniture and objects from a seed. Pure."""

import math
from typing import TypeVar

import msgspec
import numpy as np

from common.floor_plan import Box, Place, Receptacle, Room, Vec2, Wall
from common.geometry import Pose2, to_frame, wrap
from common.scene import ObjectSpec, Scene
from evaluation.homes.catalogue import EXTRAS
from evaluation.homes.furnish import Furnished, furnish
from evaluation.homes.rooms import NoHome, Shell, draw_shell, united

T = TypeVar("T", Box, Receptacle)
ROOMS = (1, 6)
"""Fewest and most rooms of a home."""
DRAWS = 60
"""Shells that are drawn until one can be furnished; some one in three cannot."""
IRREGULAR = 1 / 3
"""Share of homes in the shape of an L, with an L of a room from three rooms on, rugs, a low and a high shelf."""
OUTER_WALL = 0.12
"""Thickness of the walls around [m]."""


def draw_home(seed: int, objects: tuple[ObjectSpec, ...], rooms: int = 0) -> Scene:
    """The home of a seed with these objects laid out by the simulator's seed; `rooms` 0 draws their number too.

    The robot starts at the origin of frame `map`, in the living room before the delivery tray.

    Raises:
        NoHome: no home with so many rooms was found.
    """
    rng = np.random.default_rng([seed, 18])
    count = rooms or int(rng.integers(ROOMS[0], ROOMS[1] + 1))
    # From a stream of its own: the other homes stay as they were before there were irregular ones.
    irregular = bool(np.random.default_rng([seed, 19]).random() < IRREGULAR)
    for _ in range(DRAWS):
        try:
            found = furnish(rng, draw_shell(rng, count, irregular), EXTRAS if irregular else {})
        except NoHome:
            continue
        if any(r.spawn for r in found.receptacles):
            return _as_scene(found, f"home {seed}", objects)
    raise NoHome(f"no home of {count} rooms for seed {seed}")


def _as_scene(found: Furnished, name: str, objects: tuple[ObjectSpec, ...]) -> Scene:
    """The home in the robot's frame: turned by a multiple of 90 degrees, so that rooms stay along the axes."""
    home = found.home

    def at(point: Vec2) -> Vec2:
        x, y = to_frame(home, point)
        return round(x, 3), round(y, 3)

    def stood(one: T) -> T:
        x, y = at(one.center[:2])
        return msgspec.structs.replace(one, center=(x, y, round(one.center[2], 3)), yaw=_turned(one.yaw, home))

    def corners(low: Vec2, high: Vec2) -> tuple[Vec2, Vec2]:
        (ax, ay), (bx, by) = at(low), at(high)
        return (min(ax, bx), min(ay, by)), (max(ax, bx), max(ay, by))

    def room(r: Room) -> Room:
        low, high = corners(r.low, r.high)
        return Room(name=r.name, low=low, high=high, aliases=r.aliases)

    def place(p: Place) -> Place:
        x, y = at((p.x, p.y))
        return Place(name=p.name, x=x, y=y, theta=p.theta, aliases=p.aliases)

    low, high = corners((0.0, 0.0), found.shell.size)
    return Scene(
        name=name, low=low, high=high, home=Place(name="home", x=0.0, y=0.0, theta=0.0, aliases=("start", "the dock")),
        delivery=found.tray.name,
        walls=tuple(Wall(start=at(w.start), end=at(w.end), thickness=OUTER_WALL) for w in found.shell.walls),
        rooms=tuple(map(room, _rooms(found.shell))), places=tuple(map(place, found.places)),
        furniture=tuple(map(stood, found.furniture)),
        receptacles=tuple(map(stood, (found.tray, *found.receptacles))), objects=objects,
    )  # fmt: skip


def _rooms(shell: Shell) -> list[Room]:
    """The rooms; two that are joined are one, with the rectangle around both."""
    if not shell.joined:
        return shell.rooms
    first, other = (shell.rooms[i] for i in shell.joined)
    low, high = united(first, other)
    rest = [r for r in shell.rooms if r not in (first, other)]
    return [msgspec.structs.replace(first, low=low, high=high), *rest]


def _turned(yaw: float, home: Pose2) -> float:
    return round(wrap(yaw - home[2]), 4) if abs(wrap(yaw - home[2]) + math.pi) > 1e-6 else round(math.pi, 4)
