"""What the hand holds, and how."""

from dataclasses import dataclass

import numpy as np

from services.manipulation.arm_model import Array
from services.manipulation.grasp import Grasp, Target

HELD_SHRINK = 0.008
USUAL_SIZE = (0.06, 0.06, 0.10)  # of something in the hand that nobody described [m]


@dataclass(frozen=True)
class Held:
    """What is in the gripper: the pose it was grasped with, relative to the object's underside centre.

    What lay is held as if it had stood, so that it is put down upright; `as_found` is for where that cannot be.
    """

    label: str
    kind: str
    rotation: Array
    offset: Array
    size: tuple[float, float, float]
    width: float
    yaw: float
    as_found: "Held | None" = None

    def box(self) -> tuple[Array, Array]:
        """Half extents and centre of the object in the pinch frame."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        turned = self.rotation.T @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        half = np.abs(turned) @ (np.array(self.size) / 2) - HELD_SHRINK
        center = self.rotation.T @ (np.array([0, 0, self.size[2] / 2]) - self.offset)
        return np.maximum(half, 0.004), center


def lying_rotation(axis: float) -> Array:
    """Rotation (3, 3) of a thing that lies with its upper end towards `axis` [rad], from how it stands."""
    c, s = np.cos(axis), np.sin(axis)
    return np.array([[0.0, -s, c], [0.0, c, s], [-1.0, 0.0, 0.0]])


def grasped(target: Target, grasp: Grasp) -> Held:
    """What the hand will hold, and how, when it has closed."""
    hand, (x, y, z) = grasp.pose, target.position
    bottom = np.array([x, y, target.bottom])
    plain = Held(target.label, target.kind, hand.rotation, hand.position - bottom, target.size, grasp.width, target.yaw)
    if grasp.axis is None:
        return plain
    turn = lying_rotation(grasp.axis)
    length, across, up = target.size
    foot = np.array([x - length / 2 * np.cos(grasp.axis), y - length / 2 * np.sin(grasp.axis), z])
    offset = turn.T @ (hand.position - foot)
    return Held(
        target.label, target.kind, turn.T @ hand.rotation, offset, (up, across, length), grasp.width, 0.0, plain
    )
