"""The suite `homes`: a home, things and a command that nobody has seen, the map given exactly."""

from evaluation.blocks import random
from evaluation.case import Case
from evaluation.drawn import things
from evaluation.homes.home import draw_home
from evaluation.unknown import fetch

IN_A_HOME = (5, 10)
"""Fewest and most things. Chosen: as many as the surfaces of the smallest homes hold."""


def homes(seed: int) -> Case:
    """A drawn home with drawn things that no household lists, and a fetch of one of them."""
    rng = random(seed, 25)
    count = int(rng.integers(*IN_A_HOME))
    return fetch(seed, "homes", lambda: things(count, rng), rng, draw_home(seed, ()), ())
