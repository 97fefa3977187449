"""A fault: a finger jams as it should close."""

from typing import Any

from common.robot.model import subtree
from common.time.lockstep import DT
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.physical.injector import Injector
from services.sim.physics import Physics

JAMMED = "right_"
"""What the names of the bodies of the jammed finger begin with."""
JAM, STIFF_REF, STIFF_IMP = 500.0, (0.004, 1.0), (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Dry friction [Nm] of a jammed finger: a hundred times what the gripper's motor can do. MuJoCo's default friction
constraint creeps by 0.3 m/s under that motor; this solref and solimp leave under 0.1 mm/s."""
HELD_UP = 0.3
"""Seconds that a hand told to close has to stand open before its finger counts as jammed; by then a free one has closed
by 20 mm."""
STAYS = 0.005
"""Most that the width [m] of a jammed hand changes, half of what is free on both sides of the smallest gap."""


class Jam(Injector):
    """Holds one finger where it is, just before it should close."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        model = physics.model
        finger = [b for b in subtree(model, "gripper") if model.body(b).name.startswith(JAMMED)]
        self._dofs = [int(d) for d in range(model.nv) if int(model.dof_bodyid[d]) in finger]
        self._free = self._friction()
        self._until: float | None = None
        self._open = self._told = 0.0
        self._struck = False

    def step(self, now: float, state: str) -> str:
        physics = self.physics
        if self._until is None:
            if self.arrived():
                self._brake((JAM, STIFF_REF, STIFF_IMP))
                self._until, self._open, self._told = float("inf"), physics.width(), 0.0
            return ""
        if now >= self._until:
            self._brake(self._free)
            self._until, self.over = None, self._struck
            return ""
        self._told = self._told + DT if self.closing() else 0.0
        if self._struck or self._told < HELD_UP:
            return ""
        width = physics.width()
        self._struck = self._open - width < STAYS and self.touched() < 2
        # One that came too late is let go at once, for the next grasp.
        self._until = now + self.fault.seconds if self._struck else now
        told = f"told to close for {self._told:.1f} s, a finger stays: {1000 * width:.0f} mm open"
        return told if self._struck else ""

    def _friction(self) -> tuple[Any, Any, Any]:
        model = self.physics.model
        return tuple(a[self._dofs].copy() for a in (model.dof_frictionloss, model.dof_solref, model.dof_solimp))

    def _brake(self, values: tuple[Any, Any, Any]) -> None:
        model = self.physics.model
        for array, value in zip((model.dof_frictionloss, model.dof_solref, model.dof_solimp), values, strict=True):
            array[self._dofs] = value
