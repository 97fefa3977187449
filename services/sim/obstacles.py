"""Boxes and people that are not on the robot's map: kinematic bodies that stand or walk along a path."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from common.approach import FOOTPRINT
from common.geometry import Rectangle
from common.runtime import StartError
from common.scene import Obstacle, Scene
from services.sim.pedestrians import Pedestrian

PREFIX = "obstacle "
DISTANCE = FOOTPRINT + 0.38
"""How far a polite one stays from the robot's middle, beside its own radius [m]; chosen."""


def chosen(scene: Scene, wanted: tuple[Obstacle | str, ...] | str) -> tuple[Obstacle, ...]:
    """The scene's own obstacles and those that `sim.obstacles` names or defines.

    Raises:
        StartError: a name that the scene does not know, or one used twice.
    """
    items: tuple[Obstacle | str, ...] = (wanted,) if isinstance(wanted, str) else wanted
    found = [] if "none" in items else [o for o in scene.obstacles if o.placed]
    known = {o.name: o for o in scene.obstacles}
    for item in items:
        if isinstance(item, Obstacle):
            found.append(item)
        elif item in known:
            found += [known[item]] if known[item] not in found else []
        elif item != "none":
            names = ", ".join(known) or "none at all"
            raise StartError(f"sim.obstacles: {item!r} is no obstacle of scene {scene.name}; it has: {names}")
    for o in found:
        if min(o.size) <= 0 or o.speed < 0 or not all(map(math.isfinite, (*o.size, *o.position, o.speed))):
            raise StartError(f"sim.obstacles: {o.name!r} needs a positive size, a speed of 0 or more and a place")
    if len({o.name for o in found}) < len(found):
        raise StartError("sim.obstacles: a name is used twice")
    return tuple(found)


def body_xml(o: Obstacle) -> str:
    """A mocap body; a cylinder wears a head, so that it looks like somebody."""
    sx, sy, sz = (v / 2 for v in o.size)
    x, y = o.position
    rgba = " ".join(f"{v:g}" for v in o.rgba)
    flags = f'rgba="{rgba}" contype="1" conaffinity="3"'
    if o.kind == "box":
        geoms = f'<geom type="box" size="{sx} {sy} {sz}" {flags}/>'
    else:
        head = min(0.11, sz / 4)
        body = sz - head
        geoms = (
            f'<geom type="cylinder" size="{sx} {body}" pos="0 0 {-head}" {flags}/>'
            f'<geom type="sphere" size="{head}" pos="0 0 {sz - head}" rgba="0.85 0.66 0.54 1" contype="1" '
            'conaffinity="3"/>'
        )
    return f'<body name="{PREFIX}{o.name}" mocap="true" pos="{x} {y} {sz}" euler="0 0 {o.yaw}">{geoms}</body>'


class Walker:
    """One obstacle that moves along a path."""

    def __init__(self, obstacle: Obstacle, mocap: int) -> None:
        self.obstacle, self.mocap = obstacle, mocap
        self._points = np.array([obstacle.position, *obstacle.path])
        legs = np.hypot(*np.diff(self._points, axis=0).T) if obstacle.path else np.zeros(1)
        self._ends = np.concatenate([[0.0], np.cumsum(legs)])
        self.moves = bool(obstacle.path) and obstacle.speed > 0 and self._ends[-1] > 0
        self._radius = max(obstacle.size[:2]) / 2
        self.reset()

    def reset(self) -> None:
        self._clock, self._travelled = 0.0, 0.0
        self._near = self.obstacle.near <= 0
        self.place: tuple[float, float] = self.obstacle.position

    def _at(self, travelled: float) -> tuple[float, float]:
        length = self._ends[-1]
        if self.obstacle.repeat:
            travelled = length - abs(travelled % (2 * length) - length)
        x, y = (float(np.interp(travelled, self._ends, column)) for column in self._points.T)
        return x, y

    def advance(self, robot: tuple[float, float], dt: float) -> bool:
        """Walk on; True when it has moved."""
        o = self.obstacle
        self._clock += dt
        if not self._near:
            self._near = bool(np.hypot(*(self._points - robot).T).min() <= o.near)
        if not self._near or self._clock < o.start or (not o.repeat and self._travelled >= self._ends[-1]):
            return False
        place = self._at(self._travelled + o.speed * dt)
        gap = math.dist(place, robot)
        if o.polite and gap < self._radius + DISTANCE and gap < math.dist(self.place, robot):
            return False
        self._travelled += o.speed * dt
        self.place = place
        return True


class Obstacles:
    """All obstacles of a world; `solids` are the rectangles that people walk round."""

    def __init__(self, obstacles: tuple[Obstacle, ...], model: Any, solids: Sequence[Rectangle] = ()) -> None:
        self._all: list[Walker | Pedestrian] = []
        solids = [*solids, *(Rectangle(*o.position, *o.size[:2], o.yaw) for o in obstacles if not o.path)]
        for o in obstacles:
            mocap = int(model.body(PREFIX + o.name).mocapid[0])
            self._all.append(Pedestrian(o, mocap, solids) if o.social and o.path else Walker(o, mocap))
        self._walkers = [w for w in self._all if w.moves]
        people = [w for w in self._all if isinstance(w, Pedestrian)]
        for person in people:
            person.others = people

    def reset(self) -> None:
        for walker in self._walkers:
            walker.reset()

    def advance(self, data: Any, robot: tuple[float, float], dt: float) -> None:
        """Walk everybody on by `dt` with the robot at `robot`."""
        for walker in self._walkers:
            if walker.advance(robot, dt):
                data.mocap_pos[walker.mocap, :2] = walker.place

    def report(self, data: Any) -> dict[str, dict[str, Any]]:
        """Name -> kind, position (3,), size."""
        return {
            w.obstacle.name: {
                "kind": w.obstacle.kind,
                "position": data.mocap_pos[w.mocap].tolist(),
                "size": list(w.obstacle.size),
            }
            for w in self._all
        }
