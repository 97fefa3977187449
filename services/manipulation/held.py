"""What the hand holds, and how."""

from dataclasses import dataclass

import numpy as np

from services.manipulation.arm_model import Array

HELD_SHRINK = 0.008
USUAL_SIZE = (0.06, 0.06, 0.10)  # of something in the hand that nobody described [m]


@dataclass(frozen=True)
class Held:
    """What is in the gripper: the pose it was grasped with, relative to the object's underside centre."""

    label: str
    kind: str
    rotation: Array
    offset: Array
    size: tuple[float, float, float]
    width: float
    yaw: float

    def box(self) -> tuple[Array, Array]:
        """Half extents and centre of the object in the pinch frame."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        turned = self.rotation.T @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        half = np.abs(turned) @ (np.array(self.size) / 2) - HELD_SHRINK
        center = self.rotation.T @ (np.array([0, 0, self.size[2] / 2]) - self.offset)
        return np.maximum(half, 0.004), center
