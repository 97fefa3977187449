"""Filter for text read on packs: drops words that stand on nearly every pack. Pure."""

import difflib

from common.naming.names import normalise

READABLE = 4
"""Letters of a word from which it is more than a chance of the reader."""
DIFFERENT = 0.5
"""Share of its letters that differ from each other, above which it is a word. Chosen: bands and edges are read as rows
of the same letter, CCCO; COCOA has more."""
ALIKE = 0.8
"""Share of its letters, as difflib counts, by which a word as read is one of these. Chosen: one in five is wrong."""
_PRINTED = """
    nutrition nutritional facts information ingredients serving servings suggestion suggested size calories energy
    amount total saturated unsaturated trans cholesterol carbohydrate carbohydrates dietary daily value values percent
    diet based contains allergens allergy advice traces from source best before consume keep store stored cool place
    refrigerate refrigerated after opening opened shake well product produce country made distributed manufactured
    imported packed company limited street website visit recycle recyclable please warning caution directions
    instructions preparation typical average weight volume grams about less than each with this that your more
"""
SMALL_PRINT = frozenset(_PRINTED.split())
"""Headings and phrases of the back of a pack, in English; chosen by looking at some."""


def telling(text: str) -> list[str]:
    """The words of a text that may tell what a pack is, normalised."""
    words = [w for w in normalise(text).split() if len(w) >= READABLE and not w.isdigit()]
    words = [w for w in words if len(set(w)) > DIFFERENT * len(w)]
    return [w for w in words if not difflib.get_close_matches(w, SMALL_PRINT, n=1, cutoff=ALIKE)]
