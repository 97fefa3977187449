"""Faults that only change the scene, and watch for their effect: objects too heavy or too wide, obstacles."""

import math
from functools import cached_property
from itertools import pairwise
from typing import Any

import mujoco
import numpy as np

from common.robot.model import Hand
from common.time.lockstep import DT
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.physical.injector import Injector
from evaluation.shortest import ShortestPaths
from services.sim.physics import Physics

PULLED = 20.0
"""Force [N] with which the pads pull an object up, which shows that the hand tried to lift it: five times the weight of
the heaviest object of the scenes, and a third of the lightest one that is too heavy."""
NEAR = 1.0
"""Distance [m] of the base within which an object is in reach and an obstacle has to be avoided."""
AT_REST, DROVE = 0.02, 0.3
"""Speed of the base [m/s] below which it rests, and for how long [s] when a drive is over."""


class Heavy(Injector):
    """Watches for the hand to close on the object and to pull it up."""

    _grasped: Any = None

    def step(self, now: float, state: str) -> str:
        if not self.closing():
            self._grasped = None
            return ""
        if self._grasped is None:
            self._grasped = self.thing() if self.touched() == 2 else None
            return ""
        pull = self._pull()
        if pull < PULLED:
            return ""
        self.over = True
        mass, rise = float(self.physics.model.body_mass[self.body]), float(self.thing()[2] - self._grasped[2])
        return f"{mass:.1f} kg grasped and pulled up with {pull:.0f} N: it rose {1000 * rise:.0f} mm"

    def _pull(self) -> float:
        """Upward force [N] of the pads on the object."""
        model, data = self.physics.model, self.physics.data
        pads, force, up = set().union(*self.physics.pads), np.zeros(6), 0.0
        for number in range(data.ncon):
            contact = data.contact[number]
            one, two = (int(g) for g in contact.geom)
            if not (pads & {one, two} and self.body in model.geom_bodyid[[one, two]]):
                continue
            # A contact's force is that on its second geom.
            mujoco.mj_contactForce(model, data, number, force)
            on_thing = 1.0 if model.geom_bodyid[two] == self.body else -1.0
            up += on_thing * float(contact.frame.reshape(3, 3)[:, 2] @ force[:3])
        return up


class Wide(Injector):
    """Watches for the robot to stand before the object, about to grab it."""

    def step(self, now: float, state: str) -> str:
        gap = float(np.linalg.norm(self.thing()[:2] - self.physics.joints[:2]))
        narrowest, opening = min(self.spec.size), Hand(self.physics.model).open
        self.over = state == "GRABBING" and gap < NEAR and narrowest > opening
        return f"{1000 * narrowest:.0f} mm wide before a hand of {1000 * opening:.0f} mm" if self.over else ""


class InTheWay(Injector):
    """Watches for the robot to come upon the obstacle while it drives, or to drive another way because of it.

    A robot that sees an obstacle from afar goes round in time: then it lay on the shortest path of a drive.
    """

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        self._since: tuple[float, float] | None = None
        self._resting = 0.0

    @cached_property
    def _plan(self) -> ShortestPaths:
        return ShortestPaths(self.physics.scene)

    def step(self, now: float, state: str) -> str:
        if state not in ("NAVIGATING", "RETURNING", "GROUNDING"):
            self._since = None
            return ""
        found = self.physics.obstacles.report(self.physics.data)[self.fault.thing]
        x, y = found["position"][:2]
        here = (float(self.physics.joints[0]), float(self.physics.joints[1]))
        gap = math.dist((x, y), here)
        if gap < NEAR:
            self.over = True
            return f"the {self.fault.thing} {gap:.2f} m from the robot's middle"
        moving = float(np.hypot(*self.physics.rates[:2])) > AT_REST
        self._resting = 0.0 if moving else self._resting + DT
        if moving and self._since is None:
            self._since = here
        if self._since is None or self._resting < DROVE:
            return ""
        start, self._since = self._since, None
        path = self._plan.path(start, [here])
        self.over = any(_from_line((x, y), a, b) < max(found["size"][:2]) / 2 for a, b in pairwise(path))
        return f"the {self.fault.thing} on the shortest path of a drive, which went round it" if self.over else ""


def _from_line(point: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    """Distance [m] of a point from the line from `a` to `b`."""
    along = np.subtract(b, a)
    share = float(np.clip(np.dot(np.subtract(point, a), along) / max(float(along @ along), 1e-9), 0.0, 1.0))
    return float(np.linalg.norm(np.subtract(point, a) - share * along))
