"""What the robot is told of its home: the floor plan as a map, what people call things, and perhaps some objects.

What is really there the robot has to see: things may stand in the house that no household lists, and what it lists may
be away. The world that the simulator builds is another file (`common.scene`), which no service of the robot opens.
"""

from pathlib import Path

import msgspec

from common.config import config_dir
from common.floor_plan import FloorPlan, doubled
from common.installation import shipped
from common.naming.words import Words, words_path
from common.plan_tables import SCENES, SceneError, checked, parse, read
from common.scene import Scene
from common.thing import Thing

HOUSEHOLDS = shipped("config") / "households"
WORLD_KEYS = frozenset({"objects", "obstacles"})
"""What only a world has: a file with one of these is a world that is told as it is."""


class Household(FloorPlan, frozen=True, kw_only=True):
    """A home as it is known: `things` are objects that are known by size and colour, and need not be there."""

    things: tuple[Thing, ...] = ()
    words: Words = Words()

    def thing(self, name: str) -> Thing | None:
        """The known object called `name` or by that alias, None if there is none."""
        return next((t for t in self.things if name == t.name or name in t.aliases), None)

    def fault(self) -> str:
        """What makes the household impossible, in words; "" when nothing does."""
        if found := super().fault() or self.words.fault():
            return found
        if twice := doubled(t.name for t in self.things):
            return f"thing {twice!r} is defined twice"
        return next((f"thing {found}" for t in self.things if (found := t.fault())), "")


def mapped(plan: FloorPlan, words: Words | None = None) -> Household:
    """A household with this floor plan and these words, in which no object is known."""
    shared = {name: getattr(plan, name) for name in FloorPlan.__struct_fields__}
    return Household(**shared, words=words or Words())


def told(world: Scene, words: Words | None = None) -> Household:
    """A household of which all is known as it is in this world: the world's objects are its things."""
    things = tuple(Thing(**{n: getattr(o, n) for n in Thing.__struct_fields__}) for o in world.objects)
    return msgspec.structs.replace(mapped(world, words), things=things)


def household_path(name: str) -> Path:
    """`apartment` -> the shipped household, or else the shipped scene; anything with a suffix or slash is a path."""
    if "/" in name or name.endswith(".toml"):
        return Path(name)
    own = HOUSEHOLDS / f"{name}.toml"
    return own if own.exists() else SCENES / f"{name}.toml"


def load_household(name: str, directory: Path | None = None) -> Household:
    """Read and check a household; a world's file stands for one that lists all of its objects.

    `directory`: where the words of the configuration are; None: `config_dir()`.

    Raises:
        SceneError: no such file, bad TOML, an unknown key, a wrong type or an impossible entry.
    """
    path = household_path(name)
    raw, words = read(path), load_words(directory or config_dir())
    if WORLD_KEYS & raw.keys():
        return told(checked(parse(raw, Scene, path), path), words)
    own = parse(raw, Household, path)
    given = {n: getattr(own, n) for n in Household.__struct_fields__}
    return checked(Household(**given | {"words": words.added(own.words)}), path)


def load_words(directory: Path) -> Words:
    """The words of a configuration directory.

    Raises:
        SceneError: bad TOML, an unknown key, a wrong type or an unknown kind.
    """
    path = words_path(directory)
    words = parse(read(path), Words, path)
    if found := words.fault():
        raise SceneError(f"{path}: {found}")
    return words
