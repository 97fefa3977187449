"""The flat and the settings by which everyday sentences are judged; tests/data/sentences.tsv describes it."""

import msgspec

from common import config
from common.household import load_household
from common.messages import WorldObject
from services.planner.config import PlannerConfig

CONFIG = config.load("planner", PlannerConfig, config.DEFAULT_DIR, {})
PLAINLY = msgspec.structs.replace(CONFIG, guess=False)
"""Settings of a planner that does not guess, so that no guess is learnt from."""
HOME = load_household("apartment")
NOW = 500.0
"""Time [s] at which a sentence is said, a minute after all was seen (chosen)."""
MUG, CAN, BLOCK, BOTTLE, BOX = (
    (0.08, 0.08, 0.095), (0.066, 0.066, 0.115), (0.05, 0.05, 0.05), (0.064, 0.064, 0.21), (0.06, 0.08, 0.13),
)  # fmt: skip
BALL, APPLE, BOWL = (0.066, 0.066, 0.066), (0.072, 0.072, 0.072), (0.14, 0.14, 0.06)
"""Extents [m] of the things, those of the shipped apartment."""


def _object(
    label: str, on: str, x: float, y: float, z: float, size: tuple[float, float, float], names: str = "", text: str = ""
) -> WorldObject:
    colour, kind = ("red", "apple") if label == "apple" else label.split()
    return WorldObject(
        label=label, kind=kind, colour=colour, position=(x, y, z + size[2] / 2), size=size, on=on,
        seen_at=NOW - 60.0, names=[names] if names else [], text=text, colours=[colour],
    )  # fmt: skip


FLAT = [
    _object("red mug", "living table", -1.9, -2.2, 0.5, MUG),
    _object("green can", "living table", -1.6, -2.3, 0.5, CAN),
    _object("white box", "living table", -1.1, -2.3, 0.5, BOX), _object("blue mug", "counter", 3.8, -3.1, 0.76, MUG),
    _object("red can", "counter", 4.2, -3.1, 0.76, CAN), _object("yellow bowl", "counter", 4.7, -3.1, 0.76, BOWL),
    _object("blue bottle", "counter", 5.1, -3.1, 0.76, BOTTLE),
    _object("apple", "kitchen table", 5.0, -0.7, 0.72, APPLE),
    _object("yellow block", "kitchen table", 5.4, -0.7, 0.72, BLOCK),
    _object("white mug", "desk", -2.6, 2.7, 0.72, MUG),
    _object("orange box", "desk", -2.6, 3.2, 0.72, BOX, names="vitamin box"),
    _object("red ball", "bookshelf", 1.2, 1.74, 0.7, BALL),
    _object("blue block", "bookshelf", 1.7, 1.74, 0.7, (0.04, 0.04, 0.04)),
    _object("green bottle", "bedside table", 4.7, 4.18, 0.55, BOTTLE),
    _object("white can", "dresser", 6.7, 1.5, 0.74, CAN, text="TOMATO SOUP"),
    _object("white bottle", "dresser", 6.7, 2.0, 0.74, (0.07, 0.07, 0.26)),
]  # fmt: skip
"""The flat that the head of sentences.tsv describes."""
