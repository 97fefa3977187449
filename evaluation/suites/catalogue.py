"""Forty things with faces, as a household has them: what they are called, what is printed on them, how large they are.

Sizes, shades and patterns are drawn; the words are fixed, so that somebody can ask for them.
"""

from dataclasses import dataclass

import numpy as np

from common.scene import Form, ObjectSpec, Pattern
from evaluation.suites.drawn import FRUIT, MEASURES, Range, SizeRanges, colour

PACKED: dict[str, SizeRanges] = {
    **MEASURES,
    "cup": SizeRanges((0.062, 0.078), height=(0.075, 0.105), density=(250, 450)),
    "jar": SizeRanges((0.058, 0.076), height=(0.080, 0.130), density=(500, 900)),
    "carton": SizeRanges((0.055, 0.072), height=(0.130, 0.200), density=(400, 950)),
    "book": SizeRanges((0.110, 0.150), (0.018, 0.040), (0.160, 0.220), density=(500, 800)),
    "plate": SizeRanges((0.160, 0.210), height=(0.018, 0.028), density=(350, 600)),
    "orange": SizeRanges((0.062, 0.078), density=FRUIT),
}
"""Sizes of the kinds, as `evaluation.suites.drawn` has them, and of more."""
FORMS: dict[Form, tuple[Range, Range, Range]] = {
    "banana": ((0.15, 0.19), (0.050, 0.070), (0.032, 0.038)), "duck": ((0.07, 0.10), (0.055, 0.070), (0.06, 0.08)),
    "car": ((0.09, 0.13), (0.045, 0.060), (0.045, 0.055)), "boat": ((0.11, 0.14), (0.045, 0.060), (0.06, 0.08)),
    "screwdriver": ((0.17, 0.23), (0.026, 0.034), (0.026, 0.034)),
    "hammer": ((0.22, 0.28), (0.08, 0.10), (0.026, 0.032)),
}  # fmt: skip
"""Length, width and height [m] of bodies that no kind has by itself."""
BY_KIND = frozenset({"book", "mug"})
"""Kinds that are named along with what is printed: nobody asks for "the cooking"."""
PATTERNS: tuple[Pattern, ...] = ("band", "stripes", "dots", "check")


@dataclass(frozen=True)
class Item:
    """One row: the kind, what is printed, the colour words it comes in, a second colour, and what else it is."""

    kind: str
    label: str
    colours: tuple[str, ...]
    second: str = "white"
    patterns: tuple[Pattern, ...] = ("plain", "band")
    form: Form | None = None


CATALOGUE: tuple[Item, ...] = (
    Item("can", "TOMATO SOUP", ("red", "white")), Item("can", "chicken soup", ("yellow", "orange")),
    Item("can", "SWEET CORN", ("green", "yellow")), Item("can", "cola", ("red", "black")),
    Item("can", "LEMONADE", ("yellow", "green")), Item("can", "baked beans", ("blue", "orange")),
    Item("bottle", "KETCHUP", ("red",)), Item("bottle", "olive oil", ("green",), "yellow"),
    Item("bottle", "WATER", ("blue",)), Item("bottle", "shampoo", ("purple", "white"), "black"),
    Item("bottle", "APPLE JUICE", ("yellow", "green")), Item("jar", "marmalade", ("orange",)),
    Item("jar", "HONEY", ("yellow", "orange"), "black"), Item("jar", "pickles", ("green",)),
    Item("jar", "MUSTARD", ("yellow",), "red"), Item("carton", "MILK", ("white", "blue"), "blue"),
    Item("carton", "orange juice", ("orange",)), Item("carton", "OAT DRINK", ("white", "purple"), "green"),
    Item("box", "corn flakes", ("yellow", "blue"), "red"), Item("box", "CRACKERS", ("red", "orange")),
    Item("box", "green tea", ("green", "white"), "black"), Item("box", "VITAMINS", ("white", "purple"), "red"),
    Item("box", "rice", ("blue", "white"), "yellow"), Item("box", "CHOCOLATE", ("purple", "red"), "yellow"),
    Item("book", "ATLAS", ("blue", "green")), Item("book", "cooking", ("red", "yellow"), "black"),
    Item("book", "POEMS", ("purple", "black")),
    Item("mug", "", ("red", "blue", "green", "yellow"), "white", PATTERNS),
    Item("mug", "GRANDMA", ("white", "blue", "red"), "black", ("plain",)),
    Item("cup", "", ("orange", "green", "blue", "purple"), "white", PATTERNS),
    Item("bowl", "", ("white", "blue", "yellow"), "red", PATTERNS),
    Item("plate", "", ("white", "green", "blue"), "white", ("plain", "band")),
    Item("ball", "", ("red", "blue", "green"), "white", PATTERNS), Item("orange", "", ("orange",), patterns=("plain",)),
    Item("banana", "", ("yellow",), form="banana"), Item("toy", "", ("yellow", "white"), "orange", form="duck"),
    Item("toy", "", ("red", "blue", "green"), form="car"), Item("toy", "", ("blue", "red"), form="boat"),
    Item("tool", "", ("orange", "red", "blue"), form="screwdriver"), Item("tool", "", ("black", "red"), form="hammer"),
)  # fmt: skip


def draw(item: Item, rng: np.random.Generator) -> ObjectSpec:
    """One of a row: by its print it is called what is printed on it, else by colour and what it is."""
    word = item.colours[int(rng.integers(len(item.colours)))]
    ranges = FORMS[item.form] if item.form else _ranges(item.kind)
    x, y, z = (round(float(rng.uniform(*r)), 4) for r in ranges)
    if not item.form and PACKED[item.kind].depth is None:
        y = x
    if not item.form and PACKED[item.kind].height is None:
        z = x
    density = (250.0, 500.0) if item.form else PACKED[item.kind].density
    mass = float(rng.uniform(*density)) * x * y * z
    pattern = item.patterns[int(rng.integers(len(item.patterns)))]
    return ObjectSpec(
        name=_name(item, word), kind=item.kind, colour=word, size=(x, y, z),
        mass=round(max(mass, 0.02), 3), rgba=colour(word, rng), label=item.label, second=colour(item.second, rng),
        pattern="plain" if item.form else pattern, form=item.form, gloss=float(rng.choice((0.0, 0.3, 0.6))),
    )  # fmt: skip


def _name(item: Item, word: str) -> str:
    """What people call it: "tomato soup", "cooking book", "red car", "orange"."""
    if item.label:
        return f"{item.label.lower()} {item.kind}" if item.kind in BY_KIND else item.label.lower()
    what = item.form or item.kind
    return what if what == word else f"{word} {what}"


def _ranges(kind: str) -> tuple[Range, Range, Range]:
    """Depth, width and height; what is round or as high as wide is measured once."""
    measures = PACKED[kind]
    return measures.depth or measures.width, measures.width, measures.height or measures.width


def things(count: int, rng: np.random.Generator, printed: bool = False) -> list[ObjectSpec]:
    """Draw objects with names of their own; the first has print on it where that is asked for."""
    found: dict[str, ObjectSpec] = {}
    rows = [i for i in CATALOGUE if i.label] if printed else list(CATALOGUE)
    while len(found) < count:
        item = rows[int(rng.integers(len(rows)))]
        rows = list(CATALOGUE)
        spec = draw(item, rng)
        found.setdefault(spec.name, spec)
    return list(found.values())
