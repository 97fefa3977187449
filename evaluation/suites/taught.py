"""The suite of things that a person shows once and asks for later: elsewhere, in other light, among look-alikes."""

import msgspec
import numpy as np

from common.scene import ObjectSpec
from evaluation.case import Case, Line, Showing
from evaluation.suites import catalogue
from evaluation.suites.blocks import VLA, WORDINGS, flat, random
from evaluation.suites.catalogue import CATALOGUE, Item
from evaluation.suites.drawn import surroundings
from evaluation.suites.unknown import IN_A_WORLD, nothing_listed, with_room
from judge.effects import Effect
from judge.evidence import Want

STANDS = ("can", "bottle", "jar", "carton", "box", "mug", "cup")
"""Kinds that stand before the robot when they are shown, and that the hand takes."""
NICKNAMES = ("lucky {}", "grandmother's {}", "vitamin {}", "picnic {}", "night {}", "sunrise", "treasure", "breakfast")
"""What people call a thing of theirs: with the word for its kind, and without."""
LOOK_ALIKES = (2, 4)
"""Fewest and most (less one) things of the same kind and the same ground colour."""
SAME_SIZE = 0.04
"""Share by which a look-alike's size differs at most."""
ABSENT = 0.2
"""Share of the cases in which the thing itself is not there any more: then it is to be missed, aloud."""
CLICKED = 0.3
"""Share of the cases in which it is shown by a click on the map, others by voice."""
BEFORE = (0.60, 0.72)
"""Distance [m] from the robot's centre at which it is shown, on the tray before it."""


def taught(seed: int) -> Case:
    """A thing is shown and named in one world, and asked for by that name in another."""
    rng = random(seed, 26)
    rows = [item for item in CATALOGUE if item.kind in STANDS]
    item = rows[int(rng.integers(len(rows)))]
    thing = catalogue.draw(item, rng)
    name = NICKNAMES[int(rng.integers(len(NICKNAMES)))].format(item.kind)
    showing = _showing(thing, name, seed, rng)
    absent = bool(rng.random() < ABSENT)
    plan = surroundings(flat(), rng)

    def draw() -> list[ObjectSpec]:
        alike = _look_alikes(thing, item, rng)
        taken = {thing.name, *(o.name for o in alike)}
        others = [o for o in catalogue.things(int(rng.integers(*IN_A_WORLD)), rng) if o.name not in taken]
        return [*([] if absent else [thing]), *alike, *others[: IN_A_WORLD[1] - len(alike)]]

    world = with_room(plan, draw, seed, "taught")
    command = WORDINGS[int(rng.integers(len(WORDINGS)))].replace("the {}", "my {}").format(name)
    stay = tuple(Effect("remains", o.name, o.on) for o in world.objects if o.position is not None)
    return Case(
        suite="taught", seed=seed, name="absent" if absent else item.kind, command=command, lines=(Line(command),),
        thing=thing.name, wants=() if absent else (Want(thing.name, (plan.delivery,)),), effects=stay, scene=world,
        expect="reported" if absent else "delivered", household=nothing_listed(plan), settings=(VLA,), showing=showing,
    )  # fmt: skip


def _showing(thing: ObjectSpec, name: str, seed: int, rng: np.random.Generator) -> Showing:
    """The thing on the tray before the robot, others elsewhere; its print, if any, faces the robot more or less."""
    plan = surroundings(flat(), rng)
    x, y = (round(float(v), 3) for v in (rng.uniform(*BEFORE), rng.uniform(-0.12, 0.12)))
    yaw = round(float(rng.uniform(-0.7, 0.7)) + np.pi, 3)
    shown = msgspec.structs.replace(thing, position=(x, y), yaw=yaw, on=plan.delivery)
    others = [o for o in catalogue.things(4, rng) if o.name != thing.name]
    world = msgspec.structs.replace(plan, objects=(shown, *others))
    clicked = bool(rng.random() < CLICKED)
    return Showing(
        scene=world, household=nothing_listed(plan), name=name, seed=seed,
        sentence="" if clicked else f"this is my {name}", at=(x, y, 0.0) if clicked else None,
    )  # fmt: skip


def _look_alikes(thing: ObjectSpec, item: Item, rng: np.random.Generator) -> list[ObjectSpec]:
    """Things of its kind, ground colour and nearly its size, with another print or pattern."""
    kin = [row for row in CATALOGUE if row.kind == item.kind and row.label != item.label]
    found = []
    for n in range(int(rng.integers(*LOOK_ALIKES))):
        other = catalogue.draw(kin[int(rng.integers(len(kin)))] if kin else item, rng)
        low, high = 1.0 - SAME_SIZE, 1.0 + SAME_SIZE
        x, y, z = (round(v * float(rng.uniform(low, high)), 4) for v in thing.size)
        size = (x, x if thing.size[0] == thing.size[1] else y, z)
        if (other.label, other.pattern) != (thing.label, thing.pattern):
            found.append(
                msgspec.structs.replace(
                    other, name=f"look-alike {n + 1}", colour=thing.colour, rgba=thing.rgba, size=size
                )
            )
    return found
