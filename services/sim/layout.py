"""Layout of the objects for a seed: on surfaces, near an edge that the robot can reach, apart from each other."""

import math
from dataclasses import dataclass

import numpy as np

from common.geometry import SIDES
from common.kinds import kind_of
from common.scene import ObjectSpec, Receptacle, Scene, SceneError

EDGE_NEAR, EDGE_FAR = 0.10, 0.22
"""Distances [m] of an object's middle from the edge of its surface, within the arm's reach."""
SPACING = 0.17
"""Least distance [m] of two objects' middles: the open hand is 0.15 m wide."""
TRIES = 400
"""Draws of a spot before a surface counts as full."""
LIFT = 0.0005
"""How far [m] above its surface an object is let go: a contact of its own at the first step, and no fall."""
_ROLL = {"upright": 0.0, "side": math.pi / 2, "upside down": math.pi}


@dataclass(frozen=True)
class Placement:
    """An object's centre [m] and yaw [rad] in frame map, and the surface it stands on."""

    spec: ObjectSpec
    position: tuple[float, float, float]
    yaw: float
    on: str

    @property
    def quat(self) -> tuple[float, float, float, float]:
        """Its orientation (w, x, y, z): laid on its side or turned over, then turned by `yaw`."""
        roll, along_x = _ROLL[self.spec.pose], _rolls_about_x(self.spec)
        c, s, cr, sr = math.cos(self.yaw / 2), math.sin(self.yaw / 2), math.cos(roll / 2), math.sin(roll / 2)
        return (c * cr, c * sr, s * sr, s * cr) if along_x else (c * cr, -s * sr, c * sr, s * cr)


def _rolls_about_x(spec: ObjectSpec) -> bool:
    """Whether it goes over about its x axis, so that a handle, which points along x, lies beside the body.

    A box goes over so that it lies on its largest side.
    """
    return kind_of(spec.kind).shape != "box" or spec.size[1] < spec.size[0]


def _height(spec: ObjectSpec) -> float:
    """Height of an object's centre above its surface [m]."""
    axis = {"upright": 2, "upside down": 2, "side": 1 if _rolls_about_x(spec) else 0}[spec.pose]
    return spec.size[axis] / 2


def _radius(spec: ObjectSpec) -> float:
    """Radius of the circle that an object covers [m]."""
    return max(spec.size if spec.pose == "side" else spec.size[:2]) / 2


def _spot(rng: np.random.Generator, r: Receptacle, spec: ObjectSpec) -> tuple[float, float] | None:
    """A point of the surface close to one of its approachable edges."""
    sides = r.approach or SIDES
    ax, ay = sides[int(rng.integers(len(sides)))]
    half = np.array(r.size) / 2
    radius = _radius(spec)
    along = half[1] if ax else half[0]
    depth = half[0] if ax else half[1]
    near = max(EDGE_NEAR, radius + 0.03)
    inset = rng.uniform(near, max(near, min(EDGE_FAR, 2 * depth - near)))
    room = along - radius - 0.06
    if room <= 0 or depth - inset < -depth + radius:
        return None
    shift = rng.uniform(-room, room)
    local = (ax * (depth - inset), shift) if ax else (shift, ay * (depth - inset))
    x, y = r.outline.to_map(*local)
    return float(x), float(y)


def place_objects(scene: Scene, seed: int) -> list[Placement]:
    """The layout of a seed, the same each time.

    Raises:
        SceneError: an object finds no free spot.
    """
    rng = np.random.default_rng([seed, 7])
    surfaces = [r for r in scene.receptacles if r.spawn and r.approach and r.kind != "bin"]
    taken = [(*o.position, _radius(o)) for o in scene.objects if o.position is not None]
    placements = []
    for spec in scene.objects:
        if spec.position is not None:
            placements.append(_fixed(scene, spec, rng))
            continue
        choices = surfaces
        if spec.on:
            own = scene.surface(spec.on)
            choices = [own] if own is not None else []
        if not choices:
            raise SceneError(f"scene {scene.name}: no surface for {spec.name!r}; add one with spawn = true")
        for _ in range(TRIES):
            receptacle = choices[int(rng.integers(len(choices)))]
            spot = _spot(rng, receptacle, spec)
            radius = _radius(spec)
            if spot and all(
                math.hypot(spot[0] - x, spot[1] - y) > max(SPACING, radius + other + 0.09) for x, y, other in taken
            ):
                break
        else:
            raise SceneError(f"scene {scene.name}: no room left for {spec.name!r}; fewer objects or larger surfaces")
        taken.append((*spot, radius))
        height = receptacle.center[2] + _height(spec) + LIFT
        turn = rng.uniform(-math.pi, math.pi)
        yaw = float(turn) if spec.yaw is None else spec.yaw
        placements.append(Placement(spec, (*spot, height), yaw, receptacle.name))
    return placements


def _fixed(scene: Scene, spec: ObjectSpec, rng: np.random.Generator) -> Placement:
    """Placement of an object whose place the world's file gives."""
    surface, (x, y) = scene.surface(spec.on), spec.position or (0.0, 0.0)
    assert surface is not None  # load_scene has seen to it
    yaw = float(rng.uniform(-math.pi, math.pi)) if spec.yaw is None else spec.yaw
    return Placement(spec, (x, y, surface.center[2] + _height(spec) + LIFT), yaw, spec.on)
