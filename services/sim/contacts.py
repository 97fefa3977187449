"""What the robot has run into since the world was laid out: furniture, walls and obstacles; for evaluators."""

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from services.sim.obstacles import PREFIX


@dataclass
class Touch:
    """One part of the robot against one thing."""

    robot: str
    thing: str
    kind: str
    first: float
    last: float
    ticks: int = 0


class Contacts:
    """Objects to grasp and the floor do not count."""

    def __init__(self, model: Any, robot_bodies: set[int]) -> None:
        body = model.geom_bodyid
        self._robot = np.isin(body, list(robot_bodies))
        solid = (model.body_weldid[body] == 0) | (model.body_mocapid[body] >= 0)
        self._thing = solid & (model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE)
        self._names = [_name(model, g) for g in range(model.ngeom)]
        self._parts = [model.body(int(b)).name for b in body]
        self._touches: dict[tuple[int, int], Touch] = {}

    def forget(self) -> None:
        self._touches = {}

    def note(self, data: Any, now: float) -> None:
        """Take down who touches what at this moment."""
        geoms = data.contact.geom[: data.ncon]
        one, two = geoms[:, 0], geoms[:, 1]
        hits = (self._robot[one] & self._thing[two]) | (self._robot[two] & self._thing[one])
        if not hits.any():
            return
        for a, b in set(map(tuple, geoms[hits].tolist())):
            part, thing = (a, b) if self._robot[a] else (b, a)
            kind, name = self._names[thing]
            touch = self._touches.get((part, thing))
            if touch is None:
                touch = self._touches[part, thing] = Touch(self._parts[part], name, kind, now, now)
            touch.last, touch.ticks = now, touch.ticks + 1

    def report(self) -> list[dict[str, Any]]:
        """Oldest first: {robot, thing, kind: furniture or obstacle, first, last, seconds}."""
        found = sorted(self._touches.values(), key=lambda t: t.first)
        return [
            {"robot": t.robot, "thing": t.thing, "kind": t.kind, "first": t.first, "last": t.last,
             "seconds": t.ticks * 0.01}
            for t in found
        ]  # fmt: skip


def _name(model: Any, geom: int) -> tuple[str, str]:
    """Kind and name of what a geom belongs to."""
    body = model.body(int(model.geom_bodyid[geom])).name
    if body.startswith(PREFIX):
        return "obstacle", body.removeprefix(PREFIX)
    return "furniture", model.geom(geom).name or f"geom_{geom}"
