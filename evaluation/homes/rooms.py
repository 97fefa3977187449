"""The shell of a drawn home: rooms, the walls between them and the doors. Pure.

A rectangle is cut into rooms, sometimes on both sides of a corridor. Doors make every room reachable; some neighbours
have no wall between them (open plan). Of an irregular home a corner is missing, and the living room goes round one.
Lengths in metres, in a frame of the home's own with its corner at the origin.
"""

from dataclasses import dataclass, field
from itertools import combinations, pairwise

import numpy as np
from scipy.sparse import csgraph

from common.floor_plan import Room, Vec2, Wall

LEAST_SIDE = 2.6
"""Side [m] that a room has at least: a bed of 2.0 m and 0.6 m to pass."""
FIRST_AREA, NEXT_AREA = (17.0, 28.0), (8.5, 14.5)
"""Floor [m2] of the first room and of each further one. Source: flats of 1 to 6 rooms have some 25 to 100 m2."""
CORRIDOR_WIDTH = (1.30, 1.60)
"""Width [m] of a corridor: 1.2 is the least of building codes for homes that a wheelchair passes."""
DOOR_WIDTH = (0.97, 1.22)
"""Gap [m] between the ends of the walls' middle lines: the passage is less by the wall's thickness, 0.85 to 1.10."""
DOOR_MARGIN = 0.25
"""Distance [m] of a door from the corners of its room at least."""
EXTRA_DOOR, OPEN_PLAN, CORRIDOR = 0.25, 0.2, 0.6
"""Chance of a door that is not needed, of no wall in place of a door, and of a corridor from four rooms on."""
STUB = 0.35
"""Length [m] of the pieces of wall that are left at the sides of an open plan."""
JOINED_FROM, JOINED_LEAST = 3, 1.8
"""Rooms from which on an irregular home's living room is two of them in one, and width [m] at which they join."""
NAMES = ("living room", "kitchen", "bedroom", "study", "bathroom", "guest room")
"""Names in the order in which a home gets rooms."""


class NoHome(ValueError):
    """A draw that is no valid home: too small for its rooms, or with places that the robot cannot reach."""


@dataclass(frozen=True)
class Door:
    """A gap of `width` [m] at `middle`; `along` is the axis (0: x, 1: y) of its wall."""

    middle: Vec2
    along: int
    width: float


@dataclass
class Shell:
    """Rooms, walls and doors; `corridor` is the name of the room that is one, "" without.

    The two rooms `joined` (by their numbers) are one, with nothing in between.
    """

    size: Vec2
    rooms: list[Room]
    walls: list[Wall] = field(default_factory=list)
    doors: list[Door] = field(default_factory=list)
    corridor: str = ""
    joined: tuple[int, int] | None = None


def draw_shell(rng: np.random.Generator, rooms: int, irregular: bool = False) -> Shell:
    """The shell of a home of so many rooms (1 to 6), a corridor not counted.

    Raises:
        NoHome: the area drawn is too small.
    """
    notched = irregular and rooms > 1
    cut = rooms + notched
    area = float(rng.uniform(*FIRST_AREA) + sum(rng.uniform(*NEXT_AREA) for _ in range(cut - 1)))
    length = float(np.sqrt(area * rng.uniform(1.0, 1.7)))
    corridor = rooms >= 4 and rng.random() < CORRIDOR
    breadth = area / length + (sum(CORRIDOR_WIDTH) / 2 if corridor else 0.0)
    low, high = (0.0, 0.0), (length, breadth)
    if corridor:
        width, shift = rng.uniform(*CORRIDOR_WIDTH), rng.uniform(0.45, 0.55)
        edge = (breadth - width) * shift
        near = _cut(rng, low, (length, edge), cut // 2)
        far = _cut(rng, (0.0, edge + width), high, cut - cut // 2)
        parts = [*near, *far, ((0.0, edge), (length, edge + width))]
    else:
        parts = _cut(rng, low, high, cut)
    if len(parts) - corridor < cut:
        raise NoHome(f"{area:.0f} m2 are no {rooms} rooms")
    corner = _corner(parts, high) if notched else None
    parts = [part for part in parts if part != corner]
    count = len(parts) - corridor
    largest = sorted(range(count), key=lambda i: -_area(parts[i]))
    names = [""] * count
    for name, i in zip(NAMES, largest, strict=False):
        names[i] = name
    if corridor:
        names.append("corridor")
    shell = Shell(
        high, [Room(name=n, low=a, high=b) for n, (a, b) in zip(names, parts, strict=True)],
        corridor="corridor" if corridor else "",
    )  # fmt: skip
    if irregular and rooms >= JOINED_FROM:
        shell.joined = _joined(shell)
    _wall_up(rng, shell)
    if corner is not None:
        sides = pairwise(_around(*corner))
        shell.walls += [
            Wall(start=a, end=b) for a, b in sides if not any(a[k] == b[k] in (0.0, high[k]) for k in (0, 1))
        ]
    return shell


def _around(low: Vec2, high: Vec2) -> list[Vec2]:
    """The corners of a rectangle, the first one again in the end."""
    return [low, (high[0], low[1]), high, (low[0], high[1]), low]


def _corner(parts: list[tuple[Vec2, Vec2]], size: Vec2) -> tuple[Vec2, Vec2]:
    """The smallest part in a corner of the home that is no corridor along a side: it will lie outside."""
    in_corner = [
        (low, high) for low, high in parts
        if all(low[k] == 0.0 or high[k] == size[k] for k in (0, 1))
        and not any(low[k] == 0.0 and high[k] == size[k] for k in (0, 1))
    ]  # fmt: skip
    if not in_corner:
        raise NoHome("no part is a corner alone")
    return min(in_corner, key=_area)


def _joined(shell: Shell) -> tuple[int, int] | None:
    """The living room and a neighbour on which it makes the longest way round a corner, if any."""
    first = next(i for i, room in enumerate(shell.rooms) if room.name == NAMES[0])
    found: list[tuple[float, int]] = []
    for i, room in enumerate(shell.rooms):
        border = _shared(shell.rooms[first], room) if i != first and room.name != shell.corridor else None
        if border is not None and _length(border) > JOINED_LEAST:
            low, high = united(shell.rooms[first], room)
            spare = _area((low, high)) - sum(_area((r.low, r.high)) for r in (shell.rooms[first], room))
            found.append((spare, i))
    return (first, max(found)[1]) if found else None


def united(a: Room, b: Room) -> tuple[Vec2, Vec2]:
    """The corners of the rectangle around two rooms."""
    low, high = (tuple(pick(p, q) for p, q in zip(u, v, strict=True)) for pick, u, v in (
        (min, a.low, b.low), (max, a.high, b.high),
    ))  # fmt: skip
    return (low[0], low[1]), (high[0], high[1])


def _area(part: tuple[Vec2, Vec2]) -> float:
    return (part[1][0] - part[0][0]) * (part[1][1] - part[0][1])


def _cut(rng: np.random.Generator, low: Vec2, high: Vec2, rooms: int) -> list[tuple[Vec2, Vec2]]:
    """Rooms (low, high) of a rectangle: it is cut in two across its longer side until there are enough."""
    sides = (high[0] - low[0], high[1] - low[1])
    axis = int(sides[1] > sides[0])
    if rooms == 1 or sides[axis] < 2 * LEAST_SIDE:
        return [(low, high)]
    first = rooms // 2
    share = float(rng.uniform(0.42, 0.58)) + (first / rooms - 0.5)
    at = float(np.clip(sides[axis] * share, LEAST_SIDE, sides[axis] - LEAST_SIDE)) + low[axis]
    a_high = (at, high[1]) if axis == 0 else (high[0], at)
    b_low = (at, low[1]) if axis == 0 else (low[0], at)
    return _cut(rng, low, a_high, first) + _cut(rng, b_low, high, rooms - first)


def _shared(a: Room, b: Room) -> tuple[Vec2, Vec2] | None:
    """The piece of wall that two rooms share, None when they only touch at a corner or not at all."""
    for axis in (0, 1):
        other = 1 - axis
        for line in {a.low[axis], a.high[axis]} & {b.low[axis], b.high[axis]}:
            low, high = max(a.low[other], b.low[other]), min(a.high[other], b.high[other])
            if high - low > 1e-6:
                return ((line, low), (line, high)) if axis == 0 else ((low, line), (high, line))
    return None


def _wall_up(rng: np.random.Generator, shell: Shell) -> None:
    """Walls around the home and between its rooms, with as many doors as make every room reachable, and some more."""
    shell.walls += [Wall(start=a, end=b) for a, b in pairwise(_around((0.0, 0.0), shell.size))]
    borders: dict[tuple[int, int], tuple[Vec2, Vec2]] = {}
    doors = np.zeros((len(shell.rooms), len(shell.rooms)))
    for i, j in combinations(range(len(shell.rooms)), 2):
        border = _shared(shell.rooms[i], shell.rooms[j])
        if border is None:
            continue
        borders[i, j] = border
        if _length(border) > DOOR_WIDTH[1] + 2 * DOOR_MARGIN:
            # Rooms on a corridor open to it rather than into each other.
            doors[i, j] = float(rng.random()) + (0.1 if _to_corridor(shell, i, j) else 2.0)
    if shell.joined:
        doors[min(shell.joined), max(shell.joined)] = 0.01
    needed = {(int(i), int(j)) for i, j in zip(*csgraph.minimum_spanning_tree(doors).nonzero(), strict=True)}
    for pair, border in borders.items():
        if shell.joined and set(pair) == set(shell.joined):
            continue
        hall = _to_corridor(shell, *pair)
        if pair not in needed and not (doors[pair] and not hall and rng.random() < EXTRA_DOOR):
            shell.walls.append(Wall(start=border[0], end=border[1]))
        elif not hall and rng.random() < OPEN_PLAN:
            _open(shell, border, STUB, _length(border) - STUB)
        else:
            gap = float(rng.uniform(*DOOR_WIDTH))
            begin = float(rng.uniform(DOOR_MARGIN, _length(border) - gap - DOOR_MARGIN))
            _open(shell, border, begin, begin + gap)


def _to_corridor(shell: Shell, i: int, j: int) -> bool:
    """True when one of two rooms is the corridor."""
    return bool(shell.corridor) and shell.corridor in (shell.rooms[i].name, shell.rooms[j].name)


def _length(border: tuple[Vec2, Vec2]) -> float:
    return abs(border[1][0] - border[0][0]) + abs(border[1][1] - border[0][1])


def _open(shell: Shell, border: tuple[Vec2, Vec2], begin: float, end: float) -> None:
    """The wall of a border with a gap from `begin` to `end` [m] along it."""
    start, stop = border
    along = int(stop[1] > start[1])

    def at(distance: float) -> Vec2:
        return (start[0], start[1] + distance) if along else (start[0] + distance, start[1])

    shell.walls += [Wall(start=start, end=at(begin)), Wall(start=at(end), end=stop)]
    shell.doors.append(Door(at((begin + end) / 2), along, end - begin))
