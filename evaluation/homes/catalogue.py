"""Catalogue of furniture for drawn homes, by room, in the sizes that are sold.

Sizes are ranges over the current catalogues of large furniture stores (widths, depths and heights of their
best-selling tables, desks, sideboards, beds, sofas, shelves), rounded to centimetres.
"""

from dataclasses import dataclass
from typing import Literal

from common.floor_plan import ReceptacleKind, Rgba

Range = tuple[float, float]
WOOD: Rgba = (0.55, 0.42, 0.30, 1.0)
CLOTH: Rgba = (0.38, 0.45, 0.54, 1.0)
WHITE: Rgba = (0.88, 0.88, 0.87, 1.0)
DARK: Rgba = (0.12, 0.12, 0.14, 1.0)
LEAF: Rgba = (0.25, 0.45, 0.25, 1.0)
"""Colours (red, green, blue, opacity, 0 to 1); drawn, for looks alone."""


@dataclass(frozen=True)
class Piece:
    """A piece of furniture: `width` along the wall, `depth` off it and `height` [m].

    With a `kind` things are put on or into it; of a bin `height` is its walls'. `stands`: with its back at a wall,
    free in the room at any angle, or flat on the `floor`, whatever stands on it. `chance`: how many rooms of its type
    have it. `chairs`: most around it. `back`: height [m] of a back rest above the seat.
    """

    name: str
    width: Range
    depth: Range
    height: Range
    kind: ReceptacleKind | None = None
    stands: Literal["wall", "free", "floor"] = "wall"
    chance: float = 1.0
    aliases: tuple[str, ...] = ()
    colour: str = ""
    rgba: Rgba = WOOD
    chairs: int = 0
    back: float = 0.0


CHAIR = Piece("chair", (0.40, 0.46), (0.42, 0.48), (0.44, 0.47), stands="free", back=0.40)
CATALOGUE: dict[str, tuple[Piece, ...]] = {
    "living room": (
        Piece("sofa", (1.60, 2.20), (0.82, 0.95), (0.40, 0.46), rgba=CLOTH, back=0.40),
        Piece("coffee table", (0.90, 1.20), (0.50, 0.65), (0.42, 0.50), "table", stands="free", aliases=("table",)),
        Piece("bookshelf", (0.80, 1.40), (0.30, 0.40), (0.60, 0.80), "shelf", aliases=("shelf",)),
        Piece("sideboard", (1.20, 1.60), (0.40, 0.48), (0.70, 0.82), "counter", chance=0.6),
        Piece("television", (1.00, 1.40), (0.10, 0.20), (0.90, 1.15), chance=0.7, rgba=DARK),
        Piece("toy box", (0.36, 0.44), (0.36, 0.44), (0.28, 0.36), "bin", colour="yellow", aliases=("basket",)),
        Piece("plant", (0.28, 0.40), (0.28, 0.40), (0.70, 1.40), chance=0.6, rgba=LEAF),
    ),
    "kitchen": (
        Piece("counter", (1.60, 2.40), (0.58, 0.64), (0.74, 0.90), "counter", aliases=("worktop",)),
        Piece("kitchen table", (1.00, 1.40), (0.70, 0.85), (0.71, 0.76), "table", stands="free", chairs=2,
              aliases=("dining table",)),
        Piece("fridge", (0.55, 0.65), (0.60, 0.68), (1.40, 1.90), rgba=WHITE),
        Piece("bin", (0.30, 0.38), (0.30, 0.38), (0.34, 0.44), "bin", colour="grey", aliases=("rubbish bin", "trash")),
        Piece("recycling bin", (0.30, 0.38), (0.30, 0.38), (0.34, 0.44), "bin", colour="green", aliases=("recycling",)),
    ),
    "bedroom": (
        Piece("bed", (1.40, 1.80), (2.00, 2.10), (0.40, 0.55), rgba=CLOTH),
        Piece("bedside table", (0.40, 0.52), (0.38, 0.50), (0.48, 0.60), "table", aliases=("nightstand",)),
        Piece("dresser", (0.80, 1.20), (0.42, 0.50), (0.72, 0.84), "counter", aliases=("chest of drawers",)),
        Piece("wardrobe", (0.80, 1.50), (0.56, 0.62), (1.90, 2.10), chance=0.8),
    ),
    "study": (
        Piece("desk", (1.10, 1.50), (0.60, 0.72), (0.71, 0.76), "table", chairs=1),
        Piece("study shelf", (0.80, 1.20), (0.32, 0.40), (0.60, 0.80), "shelf"),
        Piece("plant", (0.28, 0.40), (0.28, 0.40), (0.70, 1.40), chance=0.4, rgba=LEAF),
    ),
    "bathroom": (
        Piece("washing machine", (0.58, 0.62), (0.55, 0.62), (0.84, 0.86), rgba=WHITE, chance=0.8),
        Piece("washstand", (0.60, 0.90), (0.44, 0.50), (0.78, 0.86), "counter"),
        Piece("bath", (1.50, 1.70), (0.70, 0.75), (0.55, 0.60), rgba=WHITE, chance=0.7),
    ),
    "guest room": (
        Piece("guest bed", (0.90, 1.40), (2.00, 2.05), (0.40, 0.50), rgba=CLOTH),
        Piece("guest table", (0.60, 0.90), (0.50, 0.60), (0.50, 0.74), "table"),
        Piece("guest wardrobe", (0.80, 1.00), (0.56, 0.60), (1.90, 2.10), chance=0.5),
    ),
    "corridor": (Piece("shoe cabinet", (0.60, 0.90), (0.18, 0.26), (0.75, 0.95), chance=0.5),),
}  # fmt: skip
EXTRAS: dict[str, tuple[Piece, ...]] = {
    "living room": (
        Piece("rug", (1.20, 2.00), (0.80, 1.40), (0.006, 0.015), stands="floor", rgba=(0.50, 0.22, 0.20, 1.0)),
        Piece("high shelf", (0.60, 0.90), (0.30, 0.38), (0.90, 1.05), "shelf", chance=0.7),
        Piece("low shelf", (0.80, 1.20), (0.32, 0.40), (0.28, 0.42), "shelf"),
    ),
    "bedroom": (Piece("bedside rug", (1.00, 1.40), (0.60, 0.90), (0.006, 0.015), stands="floor", rgba=CLOTH),),
    "bathroom": (Piece("laundry basket", (0.32, 0.42), (0.32, 0.42), (0.40, 0.52), "bin", chance=0.7),),
}  # fmt: skip
"""What irregular homes have besides."""
