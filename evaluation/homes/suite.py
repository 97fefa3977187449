"""The suites `homes`, a home, things and a command that nobody has seen, the map given exactly, and `aged`, the same
some months after the map was made."""

import msgspec

from evaluation.blocks import random
from evaluation.case import Case
from evaluation.drawn import things
from evaluation.homes.aged import aged as grown_old
from evaluation.homes.home import draw_home
from evaluation.unknown import fetch

IN_A_HOME = (5, 10)
"""Fewest and most things. Chosen: as many as the surfaces of the smallest homes hold."""

LIMIT = 900.0
"""Robot time [s] of a case with people: half as much again as without."""


def homes(seed: int) -> Case:
    """A drawn home with drawn things that no household lists, and a fetch of one of them."""
    rng = random(seed, 25)
    count = int(rng.integers(*IN_A_HOME))
    return fetch(seed, "homes", lambda: things(count, rng), rng, draw_home(seed, ()), ())


def aged(seed: int) -> Case:
    """Such a home with boxes and chairs that its map does not have, and people who walk about."""
    case = homes(seed)
    assert case.scene is not None
    world = grown_old(case.scene, random(seed, 26))
    return msgspec.structs.replace(case, suite="aged", scene=world, limit=LIMIT)
