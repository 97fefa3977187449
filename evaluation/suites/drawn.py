"""Random objects that no household lists: kind, size, colour and mass as in shops, and as the hand can hold."""

import colorsys
from dataclasses import dataclass
from typing import get_args

import msgspec
import numpy as np

from common.floor_plan import Rgba
from common.scene import Finish, Lamp, ObjectSpec, Scene

Range = tuple[float, float]


@dataclass(frozen=True)
class SizeRanges:
    """Ranges [m] of width, depth and height of a kind, and of its mass as density [kg/m^3] of its bounding box.

    No `depth`: as deep as wide. No `height`: as high as wide. `colours`: the words that it comes in, all if empty.
    """

    width: Range
    depth: Range | None = None
    height: Range | None = None
    density: Range = (250.0, 700.0)
    colours: tuple[str, ...] = ()


FRUIT = (700.0, 950.0)
"""Density of fruit [kg/m^3]; chosen: below that of water, in which apples float."""
MEASURES: dict[str, SizeRanges] = {
    "mug": SizeRanges((0.066, 0.080), height=(0.075, 0.110), density=(450, 750)),
    "can": SizeRanges((0.052, 0.074), height=(0.085, 0.150), density=(300, 800)),
    "bottle": SizeRanges((0.055, 0.074), height=(0.160, 0.250), density=(300, 750)),
    "apple": SizeRanges((0.062, 0.076), density=FRUIT, colours=("red", "green", "yellow")),
    "ball": SizeRanges((0.045, 0.072), density=(150, 400)),
    "block": SizeRanges((0.036, 0.060), density=(400, 700)),
    "box": SizeRanges((0.080, 0.140), (0.042, 0.068), (0.110, 0.190), density=(150, 450)),
    "bowl": SizeRanges((0.120, 0.165), height=(0.048, 0.068), density=(250, 450)),
}
"""Sizes of household goods (supermarket and kitchen shelves) whose narrowest side the hand of 85 mm takes."""
LAID = ("mug", "can", "bottle", "box")
"""Kinds that stand and may be found lying."""
ALIKE = ({"mug"}, {"can"}, {"bottle"}, {"apple", "ball"}, {"block", "box"}, {"bowl"})
"""Of one colour, a world has one of each group: what a person would call by the same words is no fair command."""
HUES: dict[str, tuple[Range, Range, Range]] = {
    "red": ((-0.015, 0.015), (0.75, 0.92), (0.55, 0.85)), "orange": ((0.065, 0.085), (0.80, 0.95), (0.85, 0.98)),
    "yellow": ((0.135, 0.160), (0.70, 0.90), (0.80, 0.95)), "green": ((0.30, 0.40), (0.60, 0.85), (0.35, 0.65)),
    "blue": ((0.58, 0.64), (0.65, 0.90), (0.50, 0.80)), "purple": ((0.75, 0.80), (0.50, 0.75), (0.40, 0.65)),
    "white": ((0.0, 1.0), (0.0, 0.05), (0.88, 0.97)), "black": ((0.0, 1.0), (0.0, 0.15), (0.06, 0.12)),
}  # fmt: skip
"""Hue, saturation and value [0..1] of what people call by a colour word, well within it: Berlin and Kay, "Basic Color
Terms", 1969; the values are chosen."""


def colour(word: str, rng: np.random.Generator) -> Rgba:
    """A shade that people call by the word."""
    hue, saturation, value = (float(rng.uniform(*HUES[word][i])) for i in range(3))
    red, green, blue = colorsys.hsv_to_rgb(hue % 1.0, saturation, value)
    return round(red, 3), round(green, 3), round(blue, 3), 1.0


def surroundings(plan: Scene, rng: np.random.Generator) -> Scene:
    """The plan under other lamps, warm or cold, with floors, walls and tables of other kinds."""
    lamps = []
    for room in plan.rooms:
        (left, below), (right, above) = room.low, room.high
        warm = float(rng.uniform(0.0, 0.25))
        for _ in range(int(rng.integers(1, 3))):
            x, y = float(rng.uniform(left + 0.5, right - 0.5)), float(rng.uniform(below + 0.5, above - 0.5))
            lit = round(float(rng.uniform(0.20, 0.40)), 3)
            shade = (1.0, round(1.0 - 0.4 * warm, 3), round(1.0 - warm, 3))
            lamps.append(Lamp(position=(round(x, 2), round(y, 2), 3.2), colour=shade, brightness=lit))
    chosen = {f.name: f.type for f in msgspec.structs.fields(Finish)}
    finish = {name: get_args(kinds)[int(rng.integers(len(get_args(kinds))))] for name, kinds in chosen.items()}
    return msgspec.structs.replace(plan, lamps=tuple(lamps), finish=msgspec.convert(finish, Finish))


def thing(kind: str, word: str, rng: np.random.Generator) -> ObjectSpec:
    """An object of a kind and a colour word; it is called by both."""
    measures = MEASURES[kind]
    width = float(rng.uniform(*measures.width))
    depth = float(rng.uniform(*measures.depth)) if measures.depth else width
    height = float(rng.uniform(*measures.height)) if measures.height else width
    mass = float(rng.uniform(*measures.density)) * width * depth * height
    size = (round(depth, 4), round(width, 4), round(height, 4))
    return ObjectSpec(
        name=f"{word} {kind}", kind=kind, colour=word, size=size, mass=round(mass, 3), rgba=colour(word, rng)
    )


def things(count: int, rng: np.random.Generator, first: tuple[str, ...] = ()) -> list[ObjectSpec]:
    """Draw objects that differ in their words; the first is of one of the kinds `first`, if there are any."""
    found: list[ObjectSpec] = []
    taken: set[tuple[int, str]] = set()
    while len(found) < count:
        kinds = first if first and not found else tuple(MEASURES)
        kind = kinds[int(rng.integers(len(kinds)))]
        words = MEASURES[kind].colours or tuple(HUES)
        word = words[int(rng.integers(len(words)))]
        group = next(n for n, names in enumerate(ALIKE) if kind in names)
        if (group, word) not in taken:
            taken.add((group, word))
            found.append(thing(kind, word, rng))
    return found
