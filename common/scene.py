"""The world file: a floor plan with the objects and obstacles that the simulator puts into it.

Nothing but the simulation, the renderer and evaluators reads it: what the robot is told is its household
(`common.household`). All lengths in metres, angles in radians, everything in frame `map` (the robot's start pose is the
origin).
"""

import math
from pathlib import Path
from typing import Annotated, Literal

import msgspec

from common.files.body_file import BodyError, extents
from common.floor_plan import (
    Box,
    FloorPlan,
    Place,
    Receptacle,
    Rgba,
    Room,
    Strict,
    Vec2,
    Vec3,
    Wall,
    doubled,
)
from common.geometry import SIDES
from common.plan_tables import SCENES, SceneError, checked, parse, read
from common.thing import Thing

__all__ = [
    "Box", "ObjectSpec", "Obstacle", "Place", "Receptacle", "Rgba", "Room", "Scene", "SceneError", "Vec2",
    "Vec3", "Wall", "body_name", "load_scene", "scene_path",
]  # fmt: skip

FLOOR = "floor"
"""What `on` says of an object that stands on the floor."""
Pose = Literal["upright", "side", "upside down"]
Pattern = Literal["plain", "band", "stripes", "dots", "check"]
Form = Literal["banana", "duck", "car", "boat", "screwdriver", "hammer", "spoon", "brush"]


class Obstacle(Strict, frozen=True):
    """Something in the simulated world that the robot's map does not have.

    It stands at `position`, turned by `yaw`; `size` is its full extent. With a `path` it goes from there along these
    points at `speed`: after `start` seconds, and, if `near` is set, once the robot is so near to its place or path.
    `repeat`: to and fro for ever, else it stays at the end. `polite`: it waits while the robot is in its way.
    `social`: a person who walks the path to and fro as people do, round others, the robot and furniture.
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
    social: bool = False
    placed: bool = True
    rgba: Rgba = (0.55, 0.35, 0.60, 1.0)


class ObjectSpec(Thing, frozen=True, kw_only=True):
    """An object that the simulation builds, with its mass [kg].

    `on`: the receptacle, piece of furniture or `floor` that it stands on; "" for whichever receptacle the seed draws.
    `position` (x, y) [map] and `yaw` [rad] are drawn as well where they are not given. `pose`: how it rests.

    What it looks like: `label` is printed on it; `pattern` in the colour `second`, which rims and lids have too.
    `gloss` [0 matt .. 1 like a mirror] and `transparent` are what a depth camera has its trouble with. `form` is a body
    of `services/sim/things/forms.py` that no kind has by itself. `model` is an MJCF file with the whole body, whose
    extents and mass count where none are given, and whose axis `up` points upwards when it stands.
    """

    size: Vec3 = (0.0, 0.0, 0.0)
    rgba: Rgba = (0.8, 0.8, 0.8, 1.0)
    mass: float = 0.0
    on: str = ""
    position: Vec2 | None = None
    yaw: float | None = None
    pose: Pose = "upright"
    gloss: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.0
    transparent: bool = False
    label: str = ""
    pattern: Pattern = "plain"
    second: Rgba | None = None
    form: Form | None = None
    model: str = ""
    up: Literal["x", "y", "z"] = "z"


def body_name(spec: Thing) -> str:
    """The body of an object in the simulation's model."""
    return spec.name.replace(" ", "_")


class Lamp(Strict, frozen=True, kw_only=True):
    """A lamp at `position` [map] that shines downwards, in shares of red, green and blue times `brightness` [0..1]."""

    position: Vec3
    colour: Vec3 = (1.0, 1.0, 1.0)
    brightness: float = 0.35


class Finish(Strict, frozen=True, kw_only=True):
    """What floor, walls and the tops of tables are covered with; "": in one colour, the floor in squares."""

    floor: Literal["", "wood", "tile", "carpet", "stone"] = ""
    walls: Literal["", "plaster", "stripes", "brick"] = ""
    tables: Literal["", "wood", "cloth", "stone"] = ""


_MARKS = frozenset('<>&"/')
"""What XML would have to be told twice, and what parts a robot's name from its part's."""


class Scene(FloorPlan, frozen=True, kw_only=True):
    """A whole apartment with everything in it. Without `lamps` each room has one in the middle of its ceiling."""

    objects: tuple[ObjectSpec, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()
    lamps: tuple[Lamp, ...] = ()
    finish: Finish = Finish()

    def object(self, name: str) -> ObjectSpec | None:
        """The object called `name` or by that alias, None if unknown."""
        return next((o for o in self.objects if name == o.name or name in o.aliases), None)

    def surface(self, name: str) -> Receptacle | None:
        """The receptacle of that name, or the floor or the top of a piece of furniture as one."""
        if found := self.receptacle(name):
            return found
        if name == FLOOR:
            (left, below), (right, above) = self.low, self.high
            middle, size = ((left + right) / 2, (below + above) / 2, 0.0), (right - left, above - below)
            return Receptacle(name=FLOOR, kind="table", center=middle, size=size)
        box = next((f for f in self.furniture if f.name == name), None)
        if box is None:
            return None
        (x, y, z), (sx, sy, sz) = box.center, box.size
        return Receptacle(
            name=name, kind="table", center=(x, y, z + sz / 2), size=(sx, sy), yaw=box.yaw, approach=SIDES
        )

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
        for name in self._in_model():
            if marks := sorted(_MARKS & set(name)):
                return f"name {name!r} has {' '.join(marks)} in it, which no model's name may have: leave it out"
        for spec in self.objects:
            if found := spec.fault():
                return f"object {found}"
            if not (0 < spec.mass < math.inf) and not (spec.model and spec.mass == 0):
                return f"object {spec.name!r} needs a positive size and mass"
            surface = self.surface(spec.on)
            if spec.on and surface is None:
                return f"object {spec.name!r} is on {spec.on!r}, which is no receptacle or furniture"
            if spec.position is not None and not spec.on:
                return f"object {spec.name!r} has a position and needs `on`: the surface at that place"
            if spec.position is not None and surface is not None and not surface.contains(*spec.position):
                return f"object {spec.name!r} has its position {spec.position} [map] beside {spec.on!r}"
            if spec.on == FLOOR and spec.position is None:
                return f"object {spec.name!r} is on the floor and needs a position"
        return ""

    def _in_model(self) -> list[str]:
        """Names that the simulation's model has of it."""
        things, furniture = [o.name for o in self.objects], [f.name for f in self.furniture]
        return [self.name, *things, *furniture, *(o.name for o in self.obstacles), *(r.name for r in self.receptacles)]


def scene_path(name: str) -> Path:
    """`apartment` -> the shipped file; anything with a suffix or slash is a path of the user's."""
    return Path(name) if "/" in name or name.endswith(".toml") else SCENES / f"{name}.toml"


def load_scene(name: str) -> Scene:
    """Read and check a world.

    Raises:
        SceneError: no such file, bad TOML, an unknown key, a wrong type or an impossible layout.
    """
    path = scene_path(name)
    return checked(_with_bodies(parse(read(path), Scene, path), path), path)


def _with_bodies(scene: Scene, path: Path) -> Scene:
    """The scene with body files found beside its own, and their extents.

    Raises:
        SceneError: a body file that cannot be used.
    """
    objects = []
    for spec in scene.objects:
        if not spec.model:
            objects.append(spec)
            continue
        file = (path.parent / spec.model).resolve()
        try:
            size = spec.size if any(spec.size) else extents(file, spec.up)
        except BodyError as error:
            raise SceneError(f"{path}: object {spec.name!r}: {error}") from None
        objects.append(msgspec.structs.replace(spec, model=str(file), size=size))
    return msgspec.structs.replace(scene, objects=tuple(objects))
