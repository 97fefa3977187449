"""A picture with the arm's pose at its time, and the mount of the camera that took it."""

from dataclasses import dataclass

import numpy as np

from common.geometry import Array
from common.messages import Rgbd

STEP = 3
"""Every which row and column of a picture is used."""
TRUE_OFFSET, TRUE_TURN = 0.001, np.radians(0.1)
"""Error of a mount [m, rad] that does not matter: it moves what is seen at 1 m by 3 mm, half of what a grasp bears."""


@dataclass(frozen=True)
class Shot:
    """A picture and the arm's joints (7,) [rad] and the gripper's width [m] when it was taken."""

    image: Rgbd
    joints: Array
    width: float


@dataclass(frozen=True)
class Mount:
    """Where a camera sits, seen from where its drawing has it, in its optical frame (x right, y down, z forward).

    `offset` (3,) [m], `turn` (3,) [rad, a rotation vector]; the deviations (3,) are those of the mean over pictures,
    by leaving out each in turn. `residual` [m]: median distance of what was measured from the arm's surface.
    """

    offset: Array
    turn: Array
    offset_deviation: Array
    turn_deviation: Array
    residual: float
    pictures: int

    def as_drawn(self) -> bool:
        """True within `TRUE_OFFSET` and `TRUE_TURN` and twice the deviation of where the camera is taken to be."""
        off, by = float(np.linalg.norm(self.offset)), 2 * float(np.linalg.norm(self.offset_deviation))
        turned, about = float(np.linalg.norm(self.turn)), 2 * float(np.linalg.norm(self.turn_deviation))
        return off < TRUE_OFFSET + by and turned < TRUE_TURN + about
