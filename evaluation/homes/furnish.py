"""Furnishing of a drawn home, such that the robot still gets everywhere. Pure."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from common.floor_plan import Box, Place, Receptacle, Room, Vec2
from common.geometry import Pose2, Rectangle
from evaluation.homes.catalogue import CATALOGUE, CHAIR, Piece
from evaluation.homes.floor import Floor
from evaluation.homes.rooms import NoHome, Shell

TRIES = 40
"""Spots that are tried for one piece. Chosen: a piece that finds none in so many has no room."""
WALL_HALF = 0.06
"""Half the thickness of a wall [m]."""
GAP = (0.01, 0.06)
"""Distance [m] of a piece from the wall behind it."""
DOORWAY = 0.80
"""Depth [m] of the floor before a door that is kept free."""
TRAY = (0.36, 0.50, 0.46)
"""Extents of the delivery tray's top along and across the way to it, and its height [m]: that of the shipped flat."""
BEFORE_TRAY = 0.70
"""Distance [m] of the robot's home from the middle of the tray."""
HOME_ROOM = 0.50
"""Clearance [m] around the robot at home: it turns there on the spot."""
BACK = 0.16
"""Thickness of a back rest [m]."""
TUCKED = 0.30
"""How far [m] a chair is pushed under its table's edge at the most, or pulled out from it."""


@dataclass
class Furnished:
    """A shell with furniture and receptacles; `home` is the robot's pose before the tray."""

    shell: Shell
    home: Pose2
    tray: Receptacle
    furniture: list[Box] = field(default_factory=list)
    receptacles: list[Receptacle] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)


def furnish(rng: np.random.Generator, shell: Shell, extras: Mapping[str, tuple[Piece, ...]]) -> Furnished:
    """Furnish each room of a shell by its type and with its `extras`.

    Raises:
        NoHome: a room cannot be reached, or there is no place for the tray.
    """
    floor = Floor((0.0, 0.0), shell.size, shell.walls)
    for door in shell.doors:
        length, width = (door.width, 2 * DOORWAY) if door.along == 0 else (2 * DOORWAY, door.width)
        floor.keep(Rectangle(*door.middle, length, width))
    first = next(r for r in shell.rooms if r.name == "living room")
    home, tray = _tray(rng, floor, first)
    floor.keep(Rectangle(home[0], home[1], 2 * HOME_ROOM, 2 * HOME_ROOM))
    found = Furnished(shell, home, tray)
    for room in shell.rooms:
        for piece in (*CATALOGUE[room.name], *extras.get(room.name, ())):
            if rng.random() < piece.chance:
                floor = _put(rng, floor, found, room, piece)
    reached = floor.reached(home[:2])
    for room in shell.rooms:
        spot = floor.roomiest(room, reached)
        if spot is None:
            raise NoHome(f"{room.name}: the robot does not get there")
        found.places.append(Place(name=room.name, x=spot[0], y=spot[1], theta=float(rng.uniform(-3.1, 3.1))))
    found.receptacles = [r for r in (_approached(r, floor, reached) for r in found.receptacles) if r.approach]
    return found


def _approached(r: Receptacle, floor: Floor, reached: np.ndarray) -> Receptacle:
    sides = tuple(floor.approaches(r.outline, reached))
    return Receptacle(
        name=r.name, kind=r.kind, center=r.center, size=r.size, yaw=r.yaw, depth=r.depth, approach=sides,
        aliases=r.aliases, spawn=r.spawn, colour=r.colour,
    )  # fmt: skip


def _tray(rng: np.random.Generator, floor: Floor, room: Room) -> tuple[Pose2, Receptacle]:
    """Somewhere in the room, with the robot before it."""
    for _ in range(TRIES * 4):
        x, y = (float(rng.uniform(room.low[k] + 0.4, room.high[k] - 0.4)) for k in (0, 1))
        theta = int(rng.integers(4)) * math.pi / 2
        area = Rectangle(x, y, TRAY[0], TRAY[1], theta)
        hx, hy = area.to_map(-BEFORE_TRAY, 0.0)
        around = Rectangle(hx, hy, 2 * HOME_ROOM, 2 * HOME_ROOM)
        if floor.fits(area, room, 0.05) and floor.fits(around, room, 0.0):
            trial = floor.copy()
            trial.take(area)
            if trial.reached((hx, hy))[trial.cell((hx, hy))]:
                floor.take(area)
                top = Receptacle(
                    name="delivery tray", kind="tray", center=(x, y, TRAY[2]), size=(TRAY[0], TRAY[1]), yaw=theta,
                    approach=((-1.0, 0.0),), aliases=("tray",), spawn=False,
                )  # fmt: skip
                return (hx, hy, theta), top
    raise NoHome(f"{room.name}: no room for the delivery tray")


def _put(rng: np.random.Generator, floor: Floor, found: Furnished, room: Room, piece: Piece) -> Floor:
    """The floor with the piece on it where there is room, the same floor where there is none."""
    width, depth, height = (float(rng.uniform(*r)) for r in (piece.width, piece.depth, piece.height))
    for _ in range(TRIES):
        area = _spot(rng, room, piece, width, depth)
        if piece.stands == "floor":
            _add(found, piece, area, height)
            return floor
        if not floor.fits(area, room, 0.04):
            continue
        trial = floor.copy()
        trial.take(area)
        if not _still_reached(trial, found, area if piece.kind else None):
            continue
        _add(found, piece, area, height)
        for _ in range(int(rng.integers(piece.chairs + 1))):
            trial = _chair(rng, trial, found, room, area)
        return trial
    return floor


def _still_reached(floor: Floor, found: Furnished, new: Rectangle | None) -> bool:
    """True when the robot gets to every door, to every receptacle, and to the new one."""
    reached = floor.reached(found.home[:2])
    if not all(reached[floor.cell(d.middle)] for d in found.shell.doors):
        return False
    outlines = [r.outline for r in found.receptacles] + ([new] if new else [])
    return all(floor.approaches(o, reached) for o in outlines)


def _spot(rng: np.random.Generator, room: Room, piece: Piece, width: float, depth: float) -> Rectangle:
    """A random place for a piece: its back at a wall, or free in the room."""
    if piece.stands != "wall":
        yaw = float(rng.integers(2)) * math.pi / 2 + (float(rng.uniform(-0.5, 0.5)) if rng.random() < 0.3 else 0.0)
        # What lies flat lies in its room only, what stands is held against the walls later.
        half = math.hypot(width, depth) / 2 if piece.stands == "floor" else 0.0
        inset = [min(half, (room.high[k] - room.low[k]) / 2 - WALL_HALF) for k in (0, 1)]
        x, y = (float(rng.uniform(room.low[k] + inset[k], room.high[k] - inset[k])) for k in (0, 1))
        return Rectangle(x, y, width, depth, yaw)
    (x0, y0), (x1, y1) = room.low, room.high
    off = WALL_HALF + depth / 2 + float(rng.uniform(*GAP))
    side, along = int(rng.integers(4)), float(rng.uniform(0.0, 1.0))
    if rng.random() < 0.3:
        along = round(along)  # into a corner
    margin = width / 2 + WALL_HALF + 0.05
    x = x0 + margin + along * max(0.0, x1 - x0 - 2 * margin)
    y = y0 + margin + along * max(0.0, y1 - y0 - 2 * margin)
    spots = ((x, y1 - off, 0.0), (x1 - off, y, -math.pi / 2), (x, y0 + off, math.pi), (x0 + off, y, math.pi / 2))
    return Rectangle(*spots[side][:2], width, depth, spots[side][2])


def _add(found: Furnished, piece: Piece, area: Rectangle, height: float) -> None:
    name = _unused(found, piece.name)
    if piece.kind:
        bin_ = piece.kind == "bin"
        found.receptacles.append(
            Receptacle(
                name=name, kind=piece.kind, center=(area.x, area.y, 0.02 if bin_ else height),
                size=(area.length, area.width), yaw=area.yaw, depth=height if bin_ else 0.0, aliases=piece.aliases,
                spawn=not bin_, colour=piece.colour,
            )
        )  # fmt: skip
        return
    size = (area.length, area.width, height)
    found.furniture.append(
        Box(name=name, center=(area.x, area.y, height / 2), size=size, yaw=area.yaw, rgba=piece.rgba)
    )
    if piece.back:
        x, y = area.to_map(0.0, (area.width - BACK) / 2)
        size = (area.length, BACK, piece.back)
        middle = (x, y, height + piece.back / 2)
        found.furniture.append(Box(name=f"{name} back", center=middle, size=size, yaw=area.yaw, rgba=piece.rgba))


def _unused(found: Furnished, name: str) -> str:
    taken = {b.name for b in found.furniture} | {r.name for r in found.receptacles}
    return next(n for n in (name, *(f"{name} {i}" for i in range(2, 50))) if n not in taken)


def _chair(rng: np.random.Generator, floor: Floor, found: Furnished, room: Room, table: Rectangle) -> Floor:
    """A chair at one side of a table, its back away from it, partly under it or pulled out."""
    width, depth, height = (float(rng.uniform(*r)) for r in (CHAIR.width, CHAIR.depth, CHAIR.height))
    side = int(rng.integers(4))
    i, j = ((0, 1), (1, 0), (0, -1), (-1, 0))[side]
    off = (table.length if i else table.width) / 2 + depth / 2 + float(rng.uniform(-TUCKED, 0.1))
    x, y = table.to_map(i * off, j * off)
    area = Rectangle(x, y, width, depth, table.yaw - side * math.pi / 2)
    inside: Vec2 = (x, y)
    trial = floor.copy()
    trial.take(area)
    free = floor.fits(_beyond(area, table, i, j), room, 0.0)
    if free and all(room.low[k] < inside[k] < room.high[k] for k in (0, 1)) and _still_reached(trial, found, None):
        _add(found, CHAIR, area, height)
        return trial
    return floor


def _beyond(chair: Rectangle, table: Rectangle, i: int, j: int) -> Rectangle:
    """The part of a chair that is not under its table, a cell off its edge."""
    u, v = table.to_local(chair.x, chair.y)
    edge = (table.length if i else table.width) / 2 + 0.06
    outer = abs(u if i else v) + chair.width / 2
    middle = max(edge, outer - chair.width) / 2 + outer / 2
    x, y = table.to_map(i * middle, j * middle)
    return chair._replace(x=x, y=y, width=max(0.05, outer - max(edge, outer - chair.width)))
