"""Homes that have changed since they were mapped: things stand about, others are gone, people walk about. Pure."""

import math

import msgspec
import numpy as np

from common.floor_plan import Box, Vec2
from common.geometry import Mask, Rectangle
from common.scene import Obstacle, Scene
from evaluation.homes.floor import CELL, PASSAGE, Floor
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

LEFT = (1, 3)
"""Fewest and most boxes, baskets and chairs that stand about."""
SIZES = {"box": ((0.30, 0.60), (0.25, 0.45), (0.25, 0.60)), "chair": ((0.40, 0.48), (0.40, 0.50), (0.80, 0.95))}
"""Width, depth and height [m] of what stands about: moving boxes, laundry baskets, chairs."""
LIGHT, GONE = ("chair", "plant", "television"), 0.4
"""Furniture that people carry about, by how its name begins, and the share of it that is no longer in the home."""
PEOPLE = (1, 2)
"""Fewest and most people who walk about [count]: a small household."""
SPEED = (0.5, 0.9)
"""Walking speed at home [m/s]: below the 1.3 of people in the street."""
SPOTS = (2, 4)
"""Fewest and most places between which somebody walks."""
STRIDE = 10
"""Points of a path [count, of 5 cm] for one of a person's."""
NOT_AT = 1.2
"""Distance [m] from the robot's start within which nobody begins and nothing stands."""
TRIES = 40
"""Draws for each thing and each person [count]; chosen: what has found no room by then is left out."""


def aged(home: Scene, rng: np.random.Generator) -> Scene:
    """The home with objects that its map does not have, such that the robot still gets everywhere it got before."""
    floor = Floor.of(home)
    before = floor.reached((home.home.x, home.home.y))
    left: list[Obstacle] = []
    for n in range(int(rng.integers(LEFT[0], LEFT[1] + 1))):
        for _ in range(TRIES):
            one = _something(rng, floor, before, n)
            trial = floor.copy()
            trial.take(Rectangle(*one.position, one.size[0], one.size[1], one.yaw))
            if math.hypot(*one.position) > NOT_AT and _still_home(home, trial):
                floor, left = trial, [*left, one]
                break
    after = floor.reached((home.home.x, home.home.y))
    planner = _planner(home, left)
    count = int(rng.integers(PEOPLE[0], PEOPLE[1] + 1)) if (after & floor.beyond(NOT_AT)).any() else 0
    people = [_somebody(rng, floor, after, planner, n) for n in range(count)]
    light = sorted({b.name.removesuffix(" back") for b in home.furniture if b.name.startswith(LIGHT)})
    gone = {name for name in light if rng.random() < GONE}
    stays = tuple(b for b in home.furniture if b.name.removesuffix(" back") not in gone)
    return msgspec.structs.replace(home, furniture=stays, obstacles=(*left, *people))


def _something(rng: np.random.Generator, floor: Floor, within: Mask, number: int) -> Obstacle:
    kind = ("box", "chair")[int(rng.integers(2))]
    size = tuple(round(float(rng.uniform(*r)), 3) for r in SIZES[kind])
    x, y = floor.somewhere(rng, within)
    return Obstacle(
        name=f"{kind} {number + 1} that stands about", kind="box", position=(x, y), size=(size[0], size[1], size[2]),
        yaw=round(float(rng.uniform(-math.pi, math.pi)), 3), rgba=(0.60, 0.48, 0.34, 1.0),
    )  # fmt: skip


def _still_home(home: Scene, floor: Floor) -> bool:
    """True when the robot gets to every room and before every receptacle."""
    reached = floor.reached((home.home.x, home.home.y))
    places = all(reached[floor.cell((p.x, p.y))] for p in home.places)
    return places and all(floor.approaches(r.outline, reached) for r in home.receptacles)


def _planner(home: Scene, left: list[Obstacle]) -> PathPlanner:
    """Paths for people round all that stands there."""
    boxes = tuple(Box(name=o.name, center=(*o.position, o.size[2] / 2), size=o.size, yaw=o.yaw) for o in left)
    full = msgspec.structs.replace(home, furniture=home.furniture + boxes)
    return PathPlanner(Costmap(full, CELL, 1.0), PASSAGE - CELL, 2 * PASSAGE)


def _somebody(rng: np.random.Generator, floor: Floor, within: Mask, planner: PathPlanner, number: int) -> Obstacle:
    """A person who walks between places as the floor allows, and starts away from the robot."""
    spots: list[Vec2] = []
    count = int(rng.integers(SPOTS[0], SPOTS[1] + 1))
    while len(spots) < count:
        spot = floor.somewhere(rng, within)
        if math.hypot(*spot) > NOT_AT:
            spots.append(spot)
    path = [spots[0]]
    for spot in spots[1:]:
        steps = planner.path(planner.field(*path[-1]), path[-1], spot) or []
        path += [(round(x, 3), round(y, 3)) for x, y in [*steps[STRIDE:-1:STRIDE], spot]]
    return Obstacle(
        name=f"person {number + 1}", position=path[0], path=tuple(path[1:]), social=True,
        speed=round(float(rng.uniform(*SPEED)), 2), start=round(float(rng.uniform(0.0, 20.0)), 1),
    )  # fmt: skip
