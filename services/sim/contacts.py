"""Log of what the robot and the object in its hand touch, from every physics step, for evaluators.

Of each touch between a part and a thing the log keeps the greatest force, the impulse, the duration and the depth; an
object in the hand presses with what is beyond its own weight.
The pads on what they grip, or on each other, are no touch, and neither is an object that the robot pushes: where it
ends up tells.
"""

import itertools
import math
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from common import messages as m
from services.sim.obstacles import PREFIX

GAP = 0.1
"""Time [s] without contact after which the same pair begins another touch: bouncing ends within some 50 ms."""
KEPT = 1000
"""Touches that stay in the log [count]; chosen: far more than a mission has. Whoever judges has each as it is
published, and the log is part of every checkpoint."""
PATTERNS = 4096
"""Sets of touching geoms that are remembered as read; a mission has some hundred."""

Pair = tuple[str, str, m.TouchKind]


class ContactLog:
    """The log: `step` adds the contacts of one physics step, `take` returns the entries new or changed since."""

    def __init__(
        self, model: Any, robot_bodies: set[int], pads: tuple[frozenset[int], frozenset[int]], objects: dict[str, int]
    ) -> None:
        body = model.geom_bodyid
        self._model, self._pads = model, pads
        self._robot = np.isin(body, list(robot_bodies))
        owners = {number: name for name, number in objects.items()}
        gravity = float(np.linalg.norm(model.opt.gravity))
        self._weight = {name: float(model.body_mass[number]) * gravity for name, number in objects.items()}
        self._object = [owners.get(int(b), "") for b in body]
        self._names = [_name(model, g) for g in range(model.ngeom)]
        self._parts = [model.body(int(b)).name for b in body]
        self._views: dict[int, NDArray[np.int32]] = {}
        self._read: dict[bytes, tuple[bool, tuple[tuple[int, Pair], ...]]] = {}
        self._force = np.zeros(6)
        self._ids = itertools.count()
        self.grips = False
        self.forget()

    def forget(self) -> None:
        """Empty the log, for a world that begins anew."""
        self._touches: list[m.Touch] = []
        self._current: dict[Pair, m.Touch] = {}
        self._fresh: dict[int, m.Touch] = {}

    def restore(self, touches: list[m.Touch]) -> None:
        """Replace the log by that of the process before."""
        self.forget()
        self._touches = touches

    def step(self, data: Any, now: float) -> None:
        """Log the contacts of the physics step that ends at `now` [s], while `data` has them."""
        pairs = self.look(data)
        if pairs:
            self._note(data, pairs, now)

    def look(self, data: Any) -> tuple[tuple[int, Pair], ...]:
        """Index and pair of the contacts that count; sets `grips`, True while an object touches both pads."""
        count = data.ncon
        view = self._views.get(count)
        if view is None:
            # Contacts stand at the start of MjData's arena: the view of so many stays valid for good. Looking the
            # array up anew takes longer than all that follows.
            view = self._views[count] = data.contact.geom
        pattern = view.tobytes()
        read = self._read.get(pattern)
        if read is None:
            if len(self._read) == PATTERNS:
                self._read.clear()
            read = self._read[pattern] = self._classify(view)
        self.grips, pairs = read
        return pairs

    def _classify(self, geoms: NDArray[np.int32]) -> tuple[bool, tuple[tuple[int, Pair], ...]]:
        """Whether both pads touch one object, and index and pair of those of the touching geoms (n, 2) that count."""
        rows: list[tuple[int, int]] = [(int(a), int(b)) for a, b in geoms]
        left, right = (
            {self._object[other] for a, b in rows for geom, other in ((a, b), (b, a)) if geom in pad}
            for pad in self._pads
        )
        held = (left & right) - {""}
        found = []
        for index, (a, b) in enumerate(rows):
            pair = self._pair(a, b, held) or self._pair(b, a, held)
            if pair is not None:
                found.append((index, pair))
        return bool(held), tuple(found)

    def _pair(self, part: int, thing: int, held: set[str]) -> Pair | None:
        """The pair to log for geom `part` of the robot or a held object on geom `thing`; None if it does not count."""
        if self._robot[part]:
            if self._robot[thing]:
                if any(part in pad for pad in self._pads) and any(thing in pad for pad in self._pads):
                    return None
                return self._parts[part], self._parts[thing], "self"
            if self._object[thing]:
                return None
            kind, name = self._names[thing]
            return self._parts[part], name, kind
        if self._object[part] in held and not self._robot[thing] and self._object[thing] != self._object[part]:
            return self._object[part], self._object[thing] or self._names[thing][1], "held"
        return None

    def _note(self, data: Any, pairs: tuple[tuple[int, Pair], ...], now: float) -> None:
        forces: dict[Pair, float] = {}
        depths: dict[Pair, float] = {}
        nets: dict[Pair, NDArray[np.float64]] = {}
        for index, pair in pairs:
            mujoco.mj_contactForce(self._model, data, index, self._force)
            forces[pair] = forces.get(pair, 0.0) + float(np.linalg.norm(self._force[:3]))
            depths[pair] = max(depths.get(pair, 0.0), -float(data.contact.dist[index]))
            if pair[2] == "held":
                nets[pair] = nets.get(pair, np.zeros(3)) + self._on(pair[0], data.contact[index])
        span = float(self._model.opt.timestep)
        for pair, pressed in forces.items():
            depth = depths[pair]
            force = self._beyond_weight(pair[0], nets[pair]) if pair in nets else pressed
            touch = self._current.get(pair)
            if touch is None or now - touch.last > GAP:
                part, thing, kind = pair
                touch = m.Touch(id=next(self._ids), part=part, thing=thing, kind=kind, first=now, last=now)
                self._current[pair] = touch
                self._touches.append(touch)
                if len(self._touches) > 2 * KEPT:
                    del self._touches[:-KEPT]
            touch.last, touch.seconds = now, touch.seconds + span
            touch.force, touch.impulse = max(touch.force, force), touch.impulse + force * span
            touch.depth = max(touch.depth, depth)
            self._fresh[touch.id] = touch

    def _on(self, thing: str, contact: Any) -> NDArray[np.float64]:
        """The normal force (3,) [N] of the contact just read on an object, in the world's frame: what is dragged over
        the surface that it stands on does not press on it."""
        # The normal points to the contact's second geom.
        sign = 1.0 if self._object[contact.geom[1]] == thing else -1.0
        force: NDArray[np.float64] = sign * self._force[0] * contact.frame[:3]
        return force

    def _beyond_weight(self, thing: str, net: NDArray[np.float64]) -> float:
        """Magnitude [N] of the force (3,) on an object beyond what a surface exerts that bears its weight."""
        upward = float(net[2])
        return math.hypot(float(net[0]), float(net[1]), max(0.0, upward - self._weight[thing], -upward))

    def take(self) -> list[m.Touch]:
        """The touches that began or went on since the last call."""
        fresh, self._fresh = list(self._fresh.values()), {}
        return fresh

    @property
    def touches(self) -> list[m.Touch]:
        """The newest entries since the world was laid out, oldest first: all, or at least KEPT."""
        return self._touches


def _name(model: Any, geom: int) -> tuple[m.TouchKind, str]:
    """Kind and name of what a geom that is not the robot's belongs to."""
    body = model.body(int(model.geom_bodyid[geom])).name
    if body.startswith(PREFIX):
        return "obstacle", body.removeprefix(PREFIX)
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
        return "floor", model.geom(geom).name
    return "furniture", model.geom(geom).name or f"geom_{geom}"
