"""The suites of objects that the robot was not told about: of random sizes and colours, in crowds, lying.

The household has the floor plan and words, and lists no thing. What is wanted is named by a colour and a kind that
nothing else in the world has.
"""

import math
from collections.abc import Callable, Iterable, Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from common.config import config_dir
from common.household import Household, load_words, mapped
from common.kinds import kind_of
from common.scene import ObjectSpec, Receptacle, Scene, SceneError
from evaluation.case import Case, Line
from evaluation.suites import catalogue, groceries
from evaluation.suites.blocks import VLA, WORDINGS, flat, random
from evaluation.suites.drawn import LAID, surroundings, thing, things
from judge.effects import Effect
from judge.evidence import Want
from services.sim.layout import Placement, place_objects

IN_A_WORLD = (7, 12)
"""Fewest and most objects of a world."""
GAP = (0.015, 0.05)
"""Nearest and farthest [m] that a neighbour stands from the one that is wanted."""
NEIGHBOURS = (2, 4)
"""Fewest and most things that stand about the one that is wanted [count]."""
TALLEST = 1.2
"""Height of a box that lies by its other extents, at least: without print nothing else tells how it is to stand.
Chosen: the error of what is measured."""
TRIES = 60
"""Draws [count] before a world is given up as too small for its objects."""
LEAST = 3
"""Fewest objects of a world with little room [count]: what the suite `new` asks for."""
EDGE = 0.02
"""How far [m] from the edge of its surface a neighbour stands at least."""


def sizes(seed: int) -> Case:
    """A case with objects of random sizes and colours that stand apart."""
    rng = random(seed, 21)
    return fetch(seed, "sizes", lambda: things(int(rng.integers(*IN_A_WORLD)), rng), rng)


def lying(seed: int) -> Case:
    """A case in which the wanted object lies on its side."""
    rng = random(seed, 22)

    def draw() -> list[ObjectSpec]:
        laid, *others = things(int(rng.integers(*IN_A_WORLD)), rng, LAID)
        while laid.kind == "box" and laid.size[2] < TALLEST * max(laid.size[:2]):
            laid = thing(laid.kind, laid.colour, rng)
        return [msgspec.structs.replace(laid, pose="side"), *others]

    return fetch(seed, "lying", draw, rng)


def clutter(seed: int) -> Case:
    """Two to four neighbours stand 1.5 to 5 cm from the one that is wanted; they may be moved, and stand in the end."""
    rng = random(seed, 23)

    def draw() -> list[ObjectSpec]:
        wanted, *others = things(int(rng.integers(*IN_A_WORLD)), rng)
        count = int(rng.integers(NEIGHBOURS[0], NEIGHBOURS[1] + 1))
        return [*crowd(flat(), wanted, others[:count], seed, rng), *others[count:]]

    return fetch(seed, "clutter", draw, rng)


def labels(seed: int) -> Case:
    """Groceries, crockery, toys and tools with faces; one is asked for by what is printed on it."""
    rng = random(seed, 24)
    plan = surroundings(flat(), rng)
    return fetch(seed, "labels", lambda: catalogue.things(int(rng.integers(*IN_A_WORLD)), rng, printed=True), rng, plan)


def scanned(seed: int) -> Case:
    """Groceries, crockery and books that were scanned, asked for by print or by colour and kind.

    Raises:
        AssetsMissing: the extra `things` is not installed.
    """
    rng = random(seed, 25)
    plan = surroundings(flat(), rng)
    return fetch(seed, "things", lambda: groceries.things(int(rng.integers(*IN_A_WORLD)), rng), rng, plan)


def fetch(
    seed: int,
    suite: str,
    draw: Callable[[], list[ObjectSpec]],
    rng: np.random.Generator,
    plan: Scene | None = None,
    settings: tuple[str, ...] = (VLA,),
) -> Case:
    """The case of a world whose first object is wanted. A draw for which there is no room is drawn again.

    What stands too high for the arm is to be reported. `plan` is the flat without its objects, None: the shipped one.
    """
    plan = plan or flat()
    world = with_room(plan, draw, seed, suite)
    wanted = world.objects[0]
    stay = tuple(Effect("remains", o.name, o.on) for o in world.objects[1:] if o.position is not None)
    command = WORDINGS[int(rng.integers(len(WORDINGS)))].format(wanted.name)
    return Case(
        suite=suite, seed=seed, name=wanted.kind, command=command, lines=(Line(command),), thing=wanted.name,
        wants=(Want(wanted.name, (plan.delivery,)),), effects=stay, scene=world, household=nothing_listed(plan),
        settings=settings, expect="reported" if wanted.name in too_high(world, seed) else "delivered",
    )  # fmt: skip


def too_high(world: Scene, seed: int) -> set[str]:
    """Names of the objects that stand on surfaces from which the arm does not take their kind."""
    found = set()
    for placed in place_objects(world, seed):
        surface = world.surface(placed.on)
        if surface is not None and placed.spec.pose == "upright":
            high = surface.center[2] > kind_of(placed.spec.kind).highest
            found |= {placed.spec.name} if high else set()
    return found


def with_room(plan: Scene, draw: Callable[[], Iterable[ObjectSpec]], seed: int, suite: str) -> Scene:
    """The flat with the first draw of objects for all of which there is room; after `TRIES` draws with fewer each time.

    Raises:
        SceneError: there is no room for `LEAST` either.
    """
    for n in range(TRIES + IN_A_WORLD[1]):
        objects = tuple(draw())
        most = len(objects) if n < TRIES else max(LEAST, len(objects) - (n - TRIES) - 1)
        world = msgspec.structs.replace(plan, objects=objects[:most])
        try:
            place_objects(world, seed)
        except SceneError:
            continue
        return world
    raise SceneError(f"{suite}, seed {seed}: no room for {LEAST} objects")


def nothing_listed(plan: Scene) -> Household:
    """The household of these suites: floor plan and configured words, and no objects."""
    return mapped(plan, load_words(config_dir()))


def crowd(
    plan: Scene, wanted: ObjectSpec, neighbours: Sequence[ObjectSpec], seed: int, rng: np.random.Generator
) -> list[ObjectSpec]:
    """The wanted object where the seed puts it, and its neighbours around it, each `GAP` from it and from the others.

    A neighbour for which there is no room on the surface is left out.
    """
    (placed,) = place_objects(msgspec.structs.replace(plan, objects=(wanted,)), seed)
    surface = plan.surface(placed.on)
    assert surface is not None
    found = [_at(wanted, placed.position[:2], placed.yaw, placed.on)]
    for spec in neighbours:
        for _ in range(TRIES):
            one = _beside(placed, spec, rng)
            clear = all(_gap(one, other) >= GAP[0] for other in found[1:])
            if clear and _on(surface, one):
                found.append(one)
                break
    return found


def _at(spec: ObjectSpec, position: tuple[float, float], yaw: float, on: str) -> ObjectSpec:
    x, y = position
    return msgspec.structs.replace(spec, position=(round(x, 4), round(y, 4)), yaw=round(yaw, 4), on=on)


def _beside(placed: Placement, spec: ObjectSpec, rng: np.random.Generator) -> ObjectSpec:
    """A neighbour at a random side, its nearest point `GAP` from the placed object's outline."""
    angle, yaw = (float(v) for v in rng.uniform(-math.pi, math.pi, 2))
    gap, (x, y) = float(rng.uniform(*GAP)), placed.position[:2]
    around = _at(placed.spec, (x, y), placed.yaw, placed.on)
    low, high = 0.0, 0.5
    while high - low > 1e-4:
        middle = (low + high) / 2
        at = _at(spec, (x + middle * math.cos(angle), y + middle * math.sin(angle)), yaw, placed.on)
        low, high = (middle, high) if _gap(at, around) < gap else (low, middle)
    return _at(spec, (x + high * math.cos(angle), y + high * math.sin(angle)), yaw, placed.on)


def outline(spec: ObjectSpec) -> NDArray[np.float64]:
    """Corners (n, 2) [map], counter-clockwise, of the convex outline of an object that stands, with its handle."""
    (x, y), yaw, kind = spec.position or (0.0, 0.0), spec.yaw or 0.0, kind_of(spec.kind)
    depth, width = spec.size[0] / 2, spec.size[1] / 2
    if kind.shape == "box":
        points = np.array([(depth, width), (-depth, width), (-depth, -width), (depth, -width)])
    else:
        angles = np.arange(32) * math.tau / 32
        points = np.stack([np.cos(angles), np.sin(angles)], 1) * depth
        if kind.handle:
            points = np.append(points, [(depth + kind.handle, 0.0)], axis=0)
            points = points[ConvexHull(points).vertices]
    c, s = math.cos(yaw), math.sin(yaw)
    return np.asarray(points @ np.array([(c, s), (-s, c)]) + (x, y))


def _gap(a: ObjectSpec, b: ObjectSpec) -> float:
    """Distance [m] of two outlines, at most: of the widest strip along a side that parts them; 0 where they overlap."""
    one, two = outline(a), outline(b)
    apart = 0.0
    for first, second in ((one, two), (two, one)):
        side = np.roll(first, -1, axis=0) - first
        normal = np.stack([side[:, 1], -side[:, 0]], 1) / np.linalg.norm(side, axis=1)[:, None]
        beyond = ((second[None] - first[:, None]) * normal[:, None]).sum(2).min(1)
        apart = max(apart, float(beyond.max()))
    return apart


def _on(surface: Receptacle, spec: ObjectSpec) -> bool:
    """The whole outline is on the surface."""
    return all(surface.contains(float(x), float(y), -EDGE) for x, y in outline(spec))
