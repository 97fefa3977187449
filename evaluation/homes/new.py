"""The suite `new`: the robot maps an unknown home and then carries out commands by its own map."""

import math
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from common import messages as m
from common.files.map_file import HOUSEHOLD
from common.floor_plan import Room
from common.household import load_household
from common.household_edits import edited
from common.scene import ObjectSpec, Scene
from evaluation.case import Case, Line
from evaluation.homes.explore import explore
from evaluation.homes.home import draw_home
from evaluation.homes.map_errors import compare
from evaluation.stack import Stack
from evaluation.suites.blocks import VLA, WORDINGS, random
from evaluation.suites.drawn import things
from evaluation.suites.unknown import too_high, with_room
from judge.effects import Effect
from judge.evidence import Want
from judge.goal import Goal
from services.sim.layout import place_objects

IN_A_HOME = (6, 10)
"""Fewest and most things. Chosen: three are asked for, and as many are beside."""
MISSIONS_LIMIT = 2400.0
"""Robot time [s] of all missions: four times that of one."""
SPOKEN = 0.5
"""Share of the homes in which people speak; in the others they type."""


class NotMapped(Exception):
    """Exploration has left no map; the message says why."""


def new(seed: int) -> Case:
    """An unknown home is explored; then two fetches, a room to go to and to be named, a thing taken to that name.

    In a home of one room the last mission is a fetch as well.
    """
    rng = random(seed, 32)
    home = draw_home(seed, ())
    count = int(rng.integers(*IN_A_HOME))
    world = with_room(home, lambda: things(count, rng), seed, "new")
    room, goals = _room(rng, world)
    on = {p.spec.name: p.on for p in place_objects(world, seed)}
    high = too_high(world, seed)
    order = sorted(world.objects, key=lambda o: (o.name in high, on[o.name] in goals))
    taken, (first, second) = order[0], order[1:3]
    lines = (
        _fetch(rng, first, world.delivery, "ready"),
        Line(f"go to {{{room.name}}}", "ended", goal=Goal(effects=(Effect("ends", room.name),))),
        Line(
            f"this is the {room.name}", "ended",
            goal=Goal(effects=(Effect("says", f"the {room.name} from now on"),)),
        ),
        _fetch(rng, second, world.delivery, "ended"),
        # Where all things are in the one room that has surfaces, nothing can be taken there.
        _fetch(rng, taken, world.delivery, "ended") if on[taken.name] in goals else Line(
            f"take the {taken.name} to the {room.name}", "ended", goal=Goal(wants=(Want(taken.name, goals),)),
            thing=taken.name,
        ),
    )  # fmt: skip
    wanted = [w for line in lines if line.goal for w in line.goal.wants]
    stay = tuple(Effect("remains", o.name, on[o.name]) for o in order[3:])
    return Case(
        suite="new", seed=seed, name=f"{len(home.rooms)} rooms", command=lines[0].text, lines=lines,
        thing=first.name, wants=tuple(wanted), expect="shown", scene=world, limit=MISSIONS_LIMIT, settings=(VLA,),
        effects=stay, explores=True,
        spoken=bool(rng.random() < SPOKEN),
    )  # fmt: skip


def _fetch(rng: np.random.Generator, spec: ObjectSpec, to: str, when: str) -> Line:
    words = WORDINGS[int(rng.integers(len(WORDINGS)))].format(spec.name)
    return Line(words, when, goal=Goal(wants=(Want(spec.name, (to,)),)), thing=spec.name)


def _room(rng: np.random.Generator, world: Scene) -> tuple[Room, tuple[str, ...]]:
    """The room that is gone to and named, and what things may be put on there: one with surfaces other than that of the
    start if any.

    The top of a washing machine, or of a bath as homes are drawn, is a surface like others to who only sees it.
    """
    surfaces = {
        room: tuple(r.name for r in world.receptacles if r.spawn and world.room_at(*r.center[:2]) == room)
        for room in world.rooms
    }
    start = world.room_at(world.home.x, world.home.y)
    fitting = [room for room in world.rooms if surfaces[room]]
    others = [room for room in fitting if room != start] or fitting
    room = others[int(rng.integers(len(others)))]
    tops = tuple(b.name for b in world.furniture if world.room_at(*b.center[:2]) == room)
    return room, (*surfaces[room], *tops)


def mapped_first(case: Case, tell: Callable[[float, str], None]) -> tuple[Case, dict[str, Any]]:
    """Explore the home of a case: the case with the household made there, and how mapping went, for the report.

    Raises:
        NotMapped: there is no map to live with.
    """
    assert case.scene is not None
    with tempfile.TemporaryDirectory(prefix="map-") as kept:

        def told(stack: Stack, status: m.MappingStatus) -> None:
            tell(stack.now, f"mapping {status.area:.0f} m2")

        explored = explore(case.scene, case.seed, Path(kept), tell=told, settings=case.settings)
        if not (Path(kept) / HOUSEHOLD).exists():
            raise NotMapped(explored.status.detail or explored.status.phase)
        made = load_household(str(Path(kept) / HOUSEHOLD))
    row = {
        "phase": explored.status.phase, "seconds": round(explored.seconds, 1), "area": explored.status.area,
        "hits": explored.hits, **compare(made, case.scene).row(),
    }  # fmt: skip
    lines = in_words_of(case, edited(made, m.HouseholdEdits()).rooms)
    return msgspec.structs.replace(case, household=made, lines=lines), row


def in_words_of(case: Case, made: tuple[Room, ...]) -> tuple[Line, ...]:
    """The lines of a case with rooms called as they are on a map."""
    assert case.scene is not None
    names = {room.name: _called(room, case.scene, made) for room in case.scene.rooms}
    return tuple(msgspec.structs.replace(line, text=line.text.format_map(names)) for line in case.lines)


def _called(room: Room, world: Scene, made: tuple[Room, ...]) -> str:
    """What people who see the map call a room of the world: the one with its standing pose, else the nearest middle."""
    place = next(p for p in world.places if p.name == room.name)

    def off(other: Room) -> tuple[bool, float]:
        return not other.contains(place.x, place.y), math.dist(other.middle, (place.x, place.y))

    name = min(made, key=off).name if made else room.name
    return name if name.startswith("room ") else f"the {name}"
