"""Panes of glass and other barriers that no sensor sees: lines through the places where they held the base up. Pure."""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from common.approach import FOOTPRINT
from common.files.map_file import OCCUPIED
from common.floor_plan import Vec2, Wall
from common.geometry import from_segment
from services.mapping.grid import RESOLUTION, Cells, Grid

PANE = 2.5
"""Distance [m] of two places up to which one thing held the robot up, and up to which from there the frame of its pane
is looked for. Chosen: the widest doors of glass that are usual."""
APART = 0.15
"""Distance [m] of two places from which on they tell a direction; chosen: three cells."""
BEFORE = FOOTPRINT + RESOLUTION / 2
"""From the base's middle to a pane that holds it up [m]: its bumper, and half of a cell."""
THICKNESS = 0.05
"""Of a pane [m]: a cell."""
HEIGHT = 2.0
"""Of a pane [m]; chosen: above the robot."""


class Met(NamedTuple):
    """A place where the base was held up: its middle [map], and the point `ahead` of it that it ran into."""

    here: Vec2
    ahead: Vec2


def panes(barriers: Sequence[Met], states: NDArray[np.uint8], grid: Grid) -> list[tuple[Vec2, Vec2]]:
    """Lines (start, end) [map] before two poses at which one pane may have held the robot up, up to its frame.

    Those farthest apart tell it best; what was met on their line tells of no other. A round bumper is at both as far
    from the pane, at whatever angle it met it. The frame is what is occupied; where there is none the line ends where
    the robot was.
    """
    found: list[tuple[Vec2, Vec2]] = []
    for one, other in sorted(combinations(barriers, 2), key=lambda pair: -math.dist(pair[0].here, pair[1].here)):
        (ax, ay), (bx, by) = one.here, other.here
        way = math.dist(one.here, other.here)
        if not APART <= way <= PANE:
            continue
        step = ((bx - ax) / way, (by - ay) / way)
        sides = [(m.ahead[1] - m.here[1]) * step[0] - (m.ahead[0] - m.here[0]) * step[1] for m in (one, other)]
        if sides[0] * sides[1] <= 0.0:
            continue
        off = math.copysign(BEFORE, sides[0])
        dx, dy = -step[1] * off, step[0] * off
        ends = (ax + dx, ay + dy), (bx + dx, by + dy)
        if not any(all(from_segment(*end, *line) < APART for end in ends) for line in found):
            back = -step[0], -step[1]
            found.append((_frame(ends[0], back, states, grid), _frame(ends[1], step, states, grid)))
    return found


def _frame(point: Vec2, step: Vec2, states: NDArray[np.uint8], grid: Grid) -> Vec2:
    """The first point that way that is occupied, the point itself where there is none within PANE."""
    along = np.arange(0.0, PANE, RESOLUTION / 2)
    line = np.array(point) + along[:, None] * np.array(step)
    met = np.nonzero(grid.at(line, states == OCCUPIED))[0]
    return (float(line[met[0], 0]), float(line[met[0], 1])) if len(met) else point


def shut(barriers: Sequence[Met], lines: Sequence[tuple[Vec2, Vec2]], grid: Grid) -> Cells:
    """Mask (rows, columns) of the cells on the lines and at the places that were run into."""
    found = np.zeros(grid.shape, bool)
    for a, b in (*((met.ahead, met.ahead) for met in barriers), *lines):
        count = math.ceil(2 * math.dist(a, b) / RESOLUTION) + 1
        found[grid.cells(np.linspace(a, b, count))] = True
    return found


def glass(lines: Sequence[tuple[Vec2, Vec2]]) -> list[Wall]:
    """The lines as walls of glass, for the floor plan."""
    ends = [tuple((round(x, 3), round(y, 3)) for x, y in line) for line in lines]
    return [Wall(start=a, end=b, thickness=THICKNESS, height=HEIGHT, glass=True) for a, b in ends]
