"""The world file: a floor plan with the objects and obstacles that the simulator puts into it.

Nothing but the simulation, the renderer and evaluators reads it: what the robot is told is its household
(`common.household`). All lengths in metres, angles in radians, everything in frame `map` (the robot's start pose is the
origin).
"""

import math
import tomllib
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from common.floor_plan import (
    Box,
    FloorPlan,
    Obstacle,
    Place,
    Receptacle,
    Rgba,
    Room,
    Strict,
    Thing,
    Vec2,
    Vec3,
    Wall,
    doubled,
    kind_fault,
)

__all__ = [
    "Box", "ObjectSpec", "Obstacle", "Place", "Receptacle", "Rgba", "Room", "Scene", "SceneError", "Vec2",
    "Vec3", "Wall", "body_name", "load_scene", "scene_path",
]  # fmt: skip
SCENES = Path(__file__).resolve().parent.parent / "services" / "sim" / "scenes"
S = TypeVar("S", bound=Strict)


class SceneError(ValueError):
    """A world or household file that cannot be used; the message names file, entry and remedy."""


class ObjectSpec(Thing, frozen=True, kw_only=True):
    """An object that the simulation builds: its mass [kg], and on which receptacle it stands ("": on any)."""

    mass: float
    on: str = ""


def body_name(spec: Thing) -> str:
    """The body of an object in the simulation's model."""
    return spec.name.replace(" ", "_")


class Scene(FloorPlan, frozen=True, kw_only=True):
    """A whole apartment with everything in it."""

    objects: tuple[ObjectSpec, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()

    def object(self, name: str) -> ObjectSpec | None:
        """The object called `name` or by that alias, None if unknown."""
        return next((o for o in self.objects if name == o.name or name in o.aliases), None)

    def fault(self) -> str:
        """What makes the world impossible, in words; "" when nothing does."""
        if found := super().fault():
            return found
        for label, names in (
            ("object", [o.name for o in self.objects]),
            ("obstacle", [o.name for o in self.obstacles]),
        ):
            if twice := doubled(names):
                return f"{label} {twice!r} is defined twice"
        for spec in self.objects:
            if found := kind_fault(spec):
                return f"object {found}"
            if not (0 < spec.mass < math.inf):
                return f"object {spec.name!r} needs a positive size and mass"
            if spec.on and self.receptacle(spec.on) is None:
                return f"object {spec.name!r} is on {spec.on!r}, which is no receptacle"
        return ""


def scene_path(name: str) -> Path:
    """`apartment` -> the shipped file; anything with a suffix or slash is a path of the user's."""
    return Path(name) if "/" in name or name.endswith(".toml") else SCENES / f"{name}.toml"


def load_scene(name: str) -> Scene:
    """Read and check a world.

    Raises:
        SceneError: no such file, bad TOML, an unknown key, a wrong type or an impossible layout.
    """
    path = scene_path(name)
    return checked(parse(read(path), Scene, path), path)


def read(path: Path) -> dict[str, Any]:
    """The TOML of a world or household file.

    Raises:
        SceneError: no such file, or bad TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        known = ", ".join(sorted(p.stem for p in SCENES.glob("*.toml")))
        raise SceneError(f"no scene file {path}; shipped scenes: {known}") from None
    except OSError as error:
        raise SceneError(f"{path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: not valid TOML: {error}") from None


def parse(raw: dict[str, Any], kind: type[S], path: Path) -> S:
    """The struct that a file's tables stand for.

    Raises:
        SceneError: an unknown key or a wrong type.
    """
    try:
        return msgspec.convert(raw, kind, strict=False)
    except msgspec.ValidationError as error:
        raise SceneError(f"{path}: {error}") from None


P = TypeVar("P", bound=FloorPlan)


def checked(plan: P, path: Path) -> P:
    """The plan itself.

    Raises:
        SceneError: it is impossible.
    """
    if found := plan.fault():
        raise SceneError(f"{path}: {found}")
    return plan
