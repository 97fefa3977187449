"""A fault: the object slides in the hand while it is carried."""

from typing import Any

import numpy as np

from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.physical.injector import Injector
from services.sim.physics import Physics

SHARE = 0.3
"""The share of an object's weight that lowered friction can still hold: it slides whatever its pose."""
SLID = 0.01
"""Travel in the hand [m] that counts as sliding: five times the slip of a good grasp at its worst."""


class Slip(Injector):
    """Takes the pads' friction away for a while as the object is carried; again if it has not slid by then."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        self._pads = [g for side in physics.pads for g in side]
        self._friction = physics.model.geom_friction[self._pads].copy()
        self._driven = 0.0
        self._last: Any = None
        self._lowered: float | None = None
        self._held_at: Any = None

    def step(self, now: float, state: str) -> str:
        if self._lowered is not None:
            return self._watch(now)
        if not self.closing() or self.touched() < 2:
            self._last = None
            return ""
        base = self.physics.joints[:2].copy()
        self._driven += 0.0 if self._last is None else float(np.linalg.norm(base - self._last))
        self._last = base
        if self._driven >= self.fault.after:
            self._lower(now)
        return ""

    def _lower(self, now: float) -> None:
        physics = self.physics
        weight = float(physics.model.body_mass[self.body]) * 9.81
        force = max(abs(physics.finger_force()), 1.0)
        # Two pads; torsional and rolling friction in proportion.
        share = SHARE * weight / (2 * force) / self._friction[:, :1]
        physics.model.geom_friction[self._pads] = self._friction * share
        self._lowered, self._held_at = now, self.in_hand()

    def _watch(self, now: float) -> str:
        assert self._lowered is not None
        slid = float(np.linalg.norm(self.in_hand() - self._held_at))
        # Pads bounce on what slides between them: it is lost once it has left the hand.
        lost = self.touched() == 0 and not self._between()
        if not lost and now - self._lowered < self.fault.seconds:
            return ""
        self.physics.model.geom_friction[self._pads] = self._friction
        self.over = lost or slid >= SLID
        # Nothing slid: once more after the next stretch of the way.
        self._lowered, self._driven = None, 0.0
        if not self.over:
            return ""
        return f"friction lowered in transit; {'lost' if lost else 'still held'} after sliding {1000 * slid:.0f} mm"
