"""The scene file: floor plan, furniture, named places, receptacles and the kinds of objects.

One TOML file describes an apartment for every service: the simulator builds its world from it,
navigation its static map, speech and planner their vocabulary. All lengths in metres, angles in
radians, everything in frame `map` (the robot's start pose is the origin).
"""

import math
import tomllib
from pathlib import Path

import msgspec

from common.floor_plan import Box, Obstacle, Place, Receptacle, Rgba, Room, Strict, Vec2, Vec3, Wall
from common.geometry import Rectangle
from common.kinds import KINDS

__all__ = [
    "Box", "ObjectSpec", "Obstacle", "Place", "Receptacle", "Rgba", "Room", "Scene", "SceneError", "Vec2",
    "Vec3", "Wall", "body_name", "load_scene", "scene_path",
]  # fmt: skip
SCENES = Path(__file__).resolve().parent.parent / "services" / "sim" / "scenes"

SUNK = 0.05
"""How far [m] below a surface the centre of what rests on it may be seen: the error of its height."""
TALLEST = 0.35
"""How far [m] above a surface the centre of what rests on it is looked for: beyond half of the tallest object."""
SIGHTING_ERROR = 0.02
"""How far [m] over the edge of a surface the centre of what rests on it may be seen: the error at arm's length."""


class SceneError(ValueError):
    """A scene file that cannot be used; the message names file, entry and remedy."""


class ObjectSpec(Strict, frozen=True):
    """An object that may be picked up: `kind` is one of `common.kinds`, `size` its full extent (x, y, z) upright."""

    name: str
    kind: str
    colour: str
    size: Vec3
    mass: float
    rgba: Rgba
    aliases: tuple[str, ...] = ()
    on: str = ""


def body_name(spec: ObjectSpec) -> str:
    """The body of an object in the simulation's model."""
    return spec.name.replace(" ", "_")


class Scene(Strict, frozen=True):
    """A whole apartment."""

    name: str
    low: Vec2
    high: Vec2
    home: Place
    walls: tuple[Wall, ...] = ()
    furniture: tuple[Box, ...] = ()
    rooms: tuple[Room, ...] = ()
    places: tuple[Place, ...] = ()
    receptacles: tuple[Receptacle, ...] = ()
    objects: tuple[ObjectSpec, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()
    delivery: str = ""

    def receptacle(self, name: str) -> Receptacle | None:
        """The receptacle called `name` or by that alias, None if unknown."""
        return next((r for r in self.receptacles if name == r.name or name in r.aliases), None)

    def object(self, name: str) -> ObjectSpec | None:
        """The object called `name` or by that alias, None if unknown."""
        return next((o for o in self.objects if name == o.name or name in o.aliases), None)

    def surface_at(
        self,
        x: float,
        y: float,
        z: float | None = None,
        margin: float = 0.0,
        below: float = SUNK,
        above: float = math.inf,
    ) -> Receptacle | None:
        """The receptacle whose usable surface is under the point (x, y, z) [map]; without `z` at whatever height.

        Distances in metres: the point is at most `margin` beyond the surface's sides, `below` under it and `above` over
        it, or in a bin between its walls.
        """
        for r in self.receptacles:
            if r.contains(x, y, margin) and (
                z is None or r.center[2] - below <= z <= max(r.center[2] + above, r.depth)
            ):
                return r
        return None

    def resting_place(self, position: Vec3) -> Receptacle | None:
        """The receptacle on or in which an object with its centre at `position` [map] was seen to rest."""
        return self.surface_at(*position, margin=SIGHTING_ERROR, above=TALLEST)

    @property
    def footprints(self) -> list[Rectangle]:
        """Where receptacles and furniture stand on the floor plan."""
        return [r.outline for r in self.receptacles] + [f.outline for f in self.furniture]

    def room_at(self, x: float, y: float) -> Room | None:
        """The room that contains the point (x, y)."""
        inside = (r for r in self.rooms if r.low[0] <= x <= r.high[0] and r.low[1] <= y <= r.high[1])
        return next(inside, None)


def scene_path(name: str) -> Path:
    """`apartment` -> the shipped file; anything with a suffix or slash is a path of the user's."""
    return Path(name) if "/" in name or name.endswith(".toml") else SCENES / f"{name}.toml"


def load_scene(name: str) -> Scene:
    """Read and check a scene.

    Raises:
        SceneError: no such scene, bad TOML, an unknown key, a wrong type or an impossible layout.
    """
    path = scene_path(name)
    try:
        raw = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        known = ", ".join(sorted(p.stem for p in SCENES.glob("*.toml")))
        raise SceneError(f"no scene file {path}; shipped scenes: {known}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: not valid TOML: {error}") from None
    try:
        scene = msgspec.convert(raw, Scene, strict=False)
    except msgspec.ValidationError as error:
        raise SceneError(f"{path}: {error}") from None
    _check(scene, path)
    return scene


def _check(scene: Scene, path: Path) -> None:
    for label, names in (
        ("receptacle", [r.name for r in scene.receptacles]),
        ("object", [o.name for o in scene.objects]),
        ("place", [p.name for p in scene.places]),
        ("obstacle", [o.name for o in scene.obstacles]),
    ):
        doubled = sorted({n for n in names if names.count(n) > 1})
        if doubled:
            raise SceneError(f"{path}: {label} {doubled[0]!r} is defined twice")
    for spec in scene.objects:
        if spec.kind not in KINDS:
            raise SceneError(f"{path}: object {spec.name!r} is a {spec.kind!r}; known kinds: {', '.join(KINDS)}")
        if min(spec.size) <= 0 or spec.mass <= 0 or not all(map(math.isfinite, (*spec.size, spec.mass))):
            raise SceneError(f"{path}: object {spec.name!r} needs a positive size and mass")
        if spec.on and scene.receptacle(spec.on) is None:
            raise SceneError(f"{path}: object {spec.name!r} is on {spec.on!r}, which is no receptacle")
    if scene.delivery and scene.receptacle(scene.delivery) is None:
        raise SceneError(f"{path}: delivery {scene.delivery!r} is no receptacle")
