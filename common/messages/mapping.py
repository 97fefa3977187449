"""Mapping: the growing map of an unknown home, and how far its exploration is."""

from typing import Literal

from common.messages.base import Message

MappingPhase = Literal["idle", "exploring", "returning", "saving", "done", "failed"]


class MapGrid(Message):
    """The map so far, and where the wheels' frame lies in it.

    `cells` is zlib of uint8, row by row from the south-west corner (`x`, `y`): 0 free, 1 occupied, 2 unknown; a cell
    has `resolution` [m]. `odom` is the pose of frame `odom` in frame `map` [m, m, rad].
    """

    t: float
    x: float
    y: float
    resolution: float
    width: int
    height: int
    cells: bytes
    odom: tuple[float, float, float]


class MappingStatus(Message):
    """`area` is the free floor [m2], `frontiers` the places that are still to be looked at, `surfaces` those found.

    `saved` is the directory that the map was last written to, `saves` how often it was.
    """

    t: float
    phase: MappingPhase
    area: float = 0.0
    frontiers: int = 0
    surfaces: int = 0
    keyframes: int = 0
    loops: int = 0
    pictures: int = 0
    saved: str = ""
    saves: int = 0
    detail: str = ""


class MappingGoal(Message):
    """`save` writes the map as it is, `finish` drives home and writes it."""

    goal: str
    id: str = ""
    attempt: int = 1
