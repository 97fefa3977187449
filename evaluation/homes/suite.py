"""The suites `homes`, a home, things and a command that nobody has seen, the map given exactly, `aged`, the same some
months after the map was made, and `lost`, where the robot is not where it was left."""

import math

import msgspec

from evaluation.case import Case
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.homes.aged import aged as grown_old
from evaluation.homes.floor import Floor
from evaluation.homes.home import draw_home
from evaluation.suites.blocks import random
from evaluation.suites.drawn import things
from evaluation.suites.unknown import fetch

IN_A_HOME = (5, 10)
"""Fewest and most things. Chosen: as many as the surfaces of the smallest homes hold."""

LIMIT = 900.0
"""Robot time [s] of a case with people: half as much again as without."""

SPOTS = 4
"""Places of which in every other case the farthest from home is taken: a random one is often in the same room."""
DRIVEN = (0.3, 1.5)
"""How far the robot drives before it is carried away [m]: less than it drives for any command."""


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


def lost(seed: int) -> Case:
    """A home as it is mapped; the robot is switched on elsewhere in it, or carried away while it drives."""
    case, rng = homes(seed), random(seed, 27)
    home = case.scene
    assert home is not None
    floor = Floor.of(home)
    within = floor.reached((home.home.x, home.home.y))
    spots = [floor.somewhere(rng, within) for _ in range(SPOTS)]
    x, y = max(spots, key=lambda spot: math.hypot(*spot)) if rng.random() < 0.5 else spots[0]
    after = float(rng.uniform(*DRIVEN)) if rng.random() < 0.5 else 0.0
    pose = (round(x, 3), round(y, 3), round(float(rng.uniform(-math.pi, math.pi)), 3))
    name = "carried away" if after else "switched on elsewhere"
    kidnap = PhysicalFault(kind="kidnap", after=after, pose=pose)
    return msgspec.structs.replace(case, suite="lost", name=name, fault="kidnap", physical=(kidnap,), limit=LIMIT)
