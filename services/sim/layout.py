"""Where the objects stand for a seed: on surfaces, near an edge the robot can stand at, apart from each other."""

import math
from dataclasses import dataclass

import numpy as np

from common.scene import ObjectSpec, Receptacle, Scene, SceneError

EDGE_NEAR, EDGE_FAR = 0.10, 0.22
SPACING = 0.17
TRIES = 400


@dataclass(frozen=True)
class Placement:
    """An object's centre [m] and yaw [rad] in frame map, and the receptacle it stands on."""

    spec: ObjectSpec
    position: tuple[float, float, float]
    yaw: float
    on: str


def _spot(rng: np.random.Generator, r: Receptacle, spec: ObjectSpec) -> tuple[float, float] | None:
    """A point of the surface close to one of its approachable edges."""
    ax, ay = r.approach[int(rng.integers(len(r.approach)))]
    half = np.array(r.size) / 2
    radius = max(spec.size[0], spec.size[1]) / 2
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
    taken: list[tuple[float, float, float]] = []
    placements = []
    for spec in scene.objects:
        choices = [r for r in surfaces if not spec.on or r.name == spec.on]
        if not choices:
            raise SceneError(f"scene {scene.name}: no surface for {spec.name!r}; add one with spawn = true")
        for _ in range(TRIES):
            receptacle = choices[int(rng.integers(len(choices)))]
            spot = _spot(rng, receptacle, spec)
            radius = max(spec.size[0], spec.size[1]) / 2
            if spot and all(
                math.hypot(spot[0] - x, spot[1] - y) > max(SPACING, radius + other + 0.09) for x, y, other in taken
            ):
                break
        else:
            raise SceneError(f"scene {scene.name}: no room left for {spec.name!r}; fewer objects or larger surfaces")
        taken.append((*spot, radius))
        height = receptacle.center[2] + spec.size[2] / 2 + 0.0005
        placements.append(Placement(spec, (*spot, height), float(rng.uniform(-math.pi, math.pi)), receptacle.name))
    return placements
