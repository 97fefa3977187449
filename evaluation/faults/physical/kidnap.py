"""A fault: the robot is carried elsewhere, without its wheels turning."""

import math

from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.physical.injector import Injector
from services.sim.physics import Physics
from services.sim.service import SimService


class Kidnap(Injector):
    """Puts the base elsewhere after it has driven `after` metres with an empty hand; 0: before its first step."""

    simulation: SimService

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        self._driven, self._was = 0.0, self._base()

    def step(self, now: float, state: str) -> str:
        here = self._base()
        self._driven += math.dist(here, self._was)
        self._was = here
        if self._driven < self.fault.after or self.closing():
            return ""
        self.over = True
        self.simulation.carry(self.fault.pose)
        x, y, _ = self.fault.pose
        return f"carried {math.dist(here, (x, y)):.1f} m to ({x:.2f}, {y:.2f}) after {self._driven:.1f} m"

    def _base(self) -> tuple[float, float]:
        x, y, *_ = self.physics.joints.tolist()
        return x, y
