"""The scene file: floor plan, furniture, named places, receptacles and the kinds of objects.

One TOML file describes an apartment for every service: the simulator builds its world from it,
navigation its static map, speech and planner their vocabulary. All lengths in metres, angles in
radians, everything in frame `map` (the robot's start pose is the origin).
"""

import math
import tomllib
from pathlib import Path
from typing import Literal

import msgspec

SCENES = Path(__file__).resolve().parent.parent / "services" / "sim" / "scenes"

Vec2 = tuple[float, float]
Vec3 = tuple[float, float, float]
Rgba = tuple[float, float, float, float]
ObjectKind = Literal["mug", "can", "bottle", "apple", "block", "box", "bowl", "ball"]
NO_UPRIGHT: frozenset[str] = frozenset({"apple", "ball", "block"})
"""Kinds that have no upright: what rolls, and cubes. Every other kind stands or has been toppled."""
ReceptacleKind = Literal["table", "counter", "shelf", "bin", "tray", "sink"]
# How furniture is built: a table's legs and how far inside the top's edge they stand, how far a cabinet's body stays
# behind its top, the thickness of a bin's walls [m].
LEG, LEG_INSET, BODY_INSET, BIN_WALL = 0.05, 0.04, 0.01, 0.015


class SceneError(ValueError):
    """A scene file that cannot be used; the message names file, entry and remedy."""


class _Strict(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    pass


class Wall(_Strict, frozen=True):
    """A straight wall from `start` to `end`; doors are gaps between walls."""

    start: Vec2
    end: Vec2
    thickness: float = 0.12
    height: float = 2.4


class Box(_Strict, frozen=True):
    """A box of furniture: `size` is the full extent, `center` its middle, `yaw` about z."""

    name: str
    center: Vec3
    size: Vec3
    yaw: float = 0.0
    rgba: Rgba = (0.7, 0.6, 0.5, 1.0)


class Receptacle(_Strict, frozen=True):
    """A surface or container that holds objects.

    `center` is the middle of the usable surface (z = its height, or the inner floor of a bin), `size` its
    usable extent along its own x and y. `approach` lists the directions (unit steps in its own frame) from
    which the robot has free floor. `furniture` names the boxes that make it up. `depth` is the wall height of a bin.
    """

    name: str
    kind: ReceptacleKind
    center: Vec3
    size: Vec2
    yaw: float = 0.0
    depth: float = 0.0
    approach: tuple[Vec2, ...] = ()
    aliases: tuple[str, ...] = ()
    spawn: bool = True
    colour: str = ""

    def covers(self, x: float, y: float) -> bool:
        """True when the point (x, y) [map] lies within the usable extent."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        dx, dy = x - self.center[0], y - self.center[1]
        return abs(c * dx + s * dy) <= self.size[0] / 2 and abs(c * dy - s * dx) <= self.size[1] / 2


class Room(_Strict, frozen=True):
    """A named axis-aligned room between corners `low` and `high`."""

    name: str
    low: Vec2
    high: Vec2
    aliases: tuple[str, ...] = ()


class Place(_Strict, frozen=True):
    """A named standing pose of the base."""

    name: str
    x: float
    y: float
    theta: float = 0.0
    aliases: tuple[str, ...] = ()


class ObjectSpec(_Strict, frozen=True):
    """An object that may be picked up. `size` is its full extent (x, y, z) standing upright."""

    name: str
    kind: ObjectKind
    colour: str
    size: Vec3
    mass: float
    rgba: Rgba
    aliases: tuple[str, ...] = ()
    on: str = ""


def body_name(spec: ObjectSpec) -> str:
    """The body of an object in the simulation's model."""
    return spec.name.replace(" ", "_")


class Obstacle(_Strict, frozen=True):
    """Something in the simulated world that the robot's map does not have.

    It stands at `position`, turned by `yaw`; `size` is its full extent. With a `path` it goes from there along these
    points at `speed`: after `start` seconds, and, if `near` is set, once the robot is so near to its place or path.
    `repeat`: to and fro for ever, else it stays at the end. `polite`: it waits while the robot is in its way.
    With `placed = false` it is there only when `sim.obstacles` names it.
    """

    name: str
    position: Vec2
    kind: Literal["box", "cylinder"] = "cylinder"
    size: Vec3 = (0.4, 0.4, 1.65)
    yaw: float = 0.0
    path: tuple[Vec2, ...] = ()
    speed: float = 0.6
    start: float = 0.0
    near: float = 0.0
    repeat: bool = False
    polite: bool = True
    placed: bool = True
    rgba: Rgba = (0.55, 0.35, 0.60, 1.0)


class Scene(_Strict, frozen=True):
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

    def surface_at(self, x: float, y: float) -> Receptacle | None:
        """The receptacle whose usable surface is over or under the point (x, y)."""
        return next((r for r in self.receptacles if r.covers(x, y)), None)

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
        if min(spec.size) <= 0 or spec.mass <= 0 or not all(map(math.isfinite, (*spec.size, spec.mass))):
            raise SceneError(f"{path}: object {spec.name!r} needs a positive size and mass")
        if spec.on and scene.receptacle(spec.on) is None:
            raise SceneError(f"{path}: object {spec.name!r} is on {spec.on!r}, which is no receptacle")
    if scene.delivery and scene.receptacle(scene.delivery) is None:
        raise SceneError(f"{path}: delivery {scene.delivery!r} is no receptacle")
