"""A fault: the object is pushed out from between the fingers before they close."""

from typing import Any

import numpy as np

from common.support import MARGIN
from common.time.lockstep import DT
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.physical.injector import Injector
from evaluation.faults.physical.jam import HELD_UP
from services.sim.physics import Physics

SHOVE, SHOVE_SPEED, BEYOND = 0.03, 0.5, 0.045
"""The least shove [m] and its speed [m/s], at which a bottle rocks and does not fall; over before the fingers close.
An object is pushed so far [m] beyond its own half width from the pinch point: pads that reach 19 mm close beside it,
also when it rocks back by 15 mm."""
SHOVING = 0.3
"""Longest that a shove lasts [s]."""


class Shove(Injector):
    """Pushes the object, upright, out from between the fingers just before they close."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        joint = physics.model.body_jntadr[self.body]
        self._dof = int(physics.model.jnt_dofadr[joint])
        self._from: Any = None
        self._way: Any = None
        self._beyond = 0.0
        self._closed_at: float | None = None
        self._pushing = 0

    def step(self, now: float, state: str) -> str:
        if self._from is None:
            if self.arrived():
                self._begin()
            return ""
        gone = float(np.linalg.norm((self.thing() - self._from)[:2]))
        if self._pushing:
            self._push(gone)
        return self._seen(now, gone)

    def _begin(self) -> None:
        pinch, thing = self.pinch(), self.thing()
        turn = self.physics.data.site_xmat[self._pinch].reshape(3, 3)
        half = max(self.spec.size[:2]) / 2
        ways = [v[:2] / np.linalg.norm(v[:2]) for v in (turn[:, 2], turn[:, 0], -turn[:, 0]) if abs(v[2]) < 0.9]
        for way in ways:
            far = max(SHOVE, half + BEYOND - float((thing - pinch)[:2] @ way))
            if self._free(thing[:2] + far * way, half):
                self._from, self._way, self._beyond = thing, way, half + BEYOND
                self._in_hand = self.in_hand()
                self._pushing = round(SHOVING / DT)
                return

    def _free(self, at: Any, half: float) -> bool:
        """True when a point is on the same surface and nothing else stands there."""
        physics = self.physics
        x, y = (float(v) for v in self.thing()[:2])
        on = [r for r in physics.scene.receptacles if r.contains(x, y, MARGIN)]
        stays = all(
            r.contains(float(at[0] + dx), float(at[1] + dy), MARGIN)
            for r in on
            for dx in (-half, half)
            for dy in (-half, half)
        )
        others = [
            (physics.data.xpos[physics.bodies[p.spec.name]][:2], max(p.spec.size[:2]) / 2)
            for p in physics.placements
            if p.spec.name != self.spec.name
        ]
        return stays and all(np.linalg.norm(where - at) > half + size + 0.01 for where, size in others)

    def _push(self, gone: float) -> None:
        """Push the object on until it is clear of the hand, which may still be coming."""
        self._pushing -= 1
        ahead = float((self.thing() - self.pinch())[:2] @ self._way)
        on = self._pushing > 0 and (gone < SHOVE or ahead < self._beyond)
        speed = SHOVE_SPEED if on else 0.0
        self._pushing = self._pushing if on else 0
        dof = self._dof
        self.physics.data.qvel[dof : dof + 2] = speed * self._way
        self.physics.data.qvel[dof + 3 : dof + 6] = 0.0

    def _seen(self, now: float, gone: float) -> str:
        """Once the fingers have closed; another try where they did not come, or still found the object."""
        if self._closed_at is None:
            self._closed_at = now if self.closing() else None
        elif now - self._closed_at > HELD_UP:
            off = float(np.linalg.norm(self.in_hand() - self._in_hand))
            self.over = min(gone, off) >= 0.9 * SHOVE
            self._from, self._closed_at = None, None
        width, pads = self.physics.width(), self.touched()
        told = f"shoved {1000 * gone:.0f} mm as the fingers came: closed to {1000 * width:.0f} mm, {pads} pads touch it"
        return told if self.over else ""
