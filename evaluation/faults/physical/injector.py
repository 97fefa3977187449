"""Base class of the injectors of physical faults: poses and contacts of hand and object."""

from typing import Any

import mujoco
import numpy as np

from common.time.lockstep import DT
from evaluation.faults.physical.fault import PhysicalFault
from services.sim.physics import Physics
from services.sim.things.primitives import GROUP
from services.sim.truth import touching

ARRIVED = 0.06
"""Speed of the hand [m/s] below which it comes to rest around an object: a third of its speed on the way in."""
CLOSED = 0.5
"""Share of the gripper's stroke that is commanded, beyond which it counts as told to close."""


class Injector:
    """Injects one fault: `step` is called after every 10 ms of physics and returns what was seen of the effect."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        self.fault, self.physics = fault, physics
        model = physics.model
        self.body = physics.bodies.get(fault.thing, -1)
        if self.body >= 0:
            self.spec = next(p.spec for p in physics.placements if p.spec.name == fault.thing)
        self._pinch = model.site("pinch").id
        self._before = self.pinch()
        self.over = False

    def step(self, now: float, state: str) -> str:
        """Called after each tick, with the brain's `state`; not any more once `over`."""
        raise NotImplementedError

    # --- what the world shows
    def pinch(self) -> Any:
        """Where the fingers meet (3,) [m]."""
        return self.physics.data.site_xpos[self._pinch].copy()

    def thing(self) -> Any:
        """The object's centre (3,) [m]."""
        return self.physics.data.xpos[self.body].copy()

    def closing(self) -> bool:
        """True while the gripper is commanded to close."""
        return self.physics.fingers.wanted > CLOSED

    def touched(self) -> int:
        """Number of the fingers, 0 to 2, whose pads touch the object."""
        robot, _ = touching(self.physics)
        return sum(bool(robot[self.spec.name] & side) for side in self.physics.pads)

    def in_hand(self) -> Any:
        """The object's centre in the hand's frame (3,) [m]."""
        turn = self.physics.data.site_xmat[self._pinch].reshape(3, 3)
        return turn.T @ (self.thing() - self.pinch())

    def arrived(self) -> bool:
        """True when the open hand has come to rest with the object between its fingers."""
        at, before = self.pinch(), self._before
        self._before = at
        slow = float(np.linalg.norm(at - before)) < ARRIVED * DT
        return slow and not self.closing() and self._between()

    def _between(self) -> bool:
        """A line from one pad to the other goes through the object."""
        model, data = self.physics.model, self.physics.data
        one, two = (np.mean([data.geom_xpos[g] for g in side], axis=0) for side in self.physics.pads)
        gap = float(np.linalg.norm(two - one))
        if np.linalg.norm(self.thing() - self.pinch()) > max(self.spec.size):
            return False
        hit, objects = np.array([-1], dtype=np.int32), np.zeros(mujoco.mjNGROUP, dtype=np.uint8)
        objects[GROUP] = 1
        far = mujoco.mj_ray(model, data, one, (two - one) / gap, objects, 1, -1, hit)
        return bool(0 <= far < gap and model.geom_bodyid[hit[0]] == self.body)
