"""Poses at which the base has already stood before an object, so that a repeated goal leads to another pose."""

import math

from common.geometry import Pose2
from services.navigation.goals import Choices

PENALTY = 1.0
"""Penalty of standing where it stood [m of way]; chosen: more than two approach poses of one object differ by."""
REACH = 0.4
"""Distance from which on a pose is another one [m]; chosen: two steps between approach poses."""


class ApproachHistory:
    """Poses used for one object, until a goal names another. A goal repeated under its own id changes nothing."""

    def __init__(self) -> None:
        self._item, self._poses = "", list[tuple[str, Pose2]]()

    def goal_sent(self, item: str) -> None:
        """Note a new goal; `item` is the object that it leads to, "" for other goals."""
        if item != self._item:
            self._item, self._poses = item, []

    def arrived(self, goal_id: str, pose: Pose2 | None) -> None:
        """Note that a goal was reached, with the base at `pose`."""
        if self._item and pose is not None:
            self._poses.append((goal_id, pose))

    def penalised(self, goal_id: str, choices: Choices) -> Choices:
        """The choices with a penalty added to those near poses where earlier goals for the same object ended."""
        tried = [pose for other, pose in self._poses if other != goal_id]
        return [(cost + sum(_repetition(pose, old) for old in tried), pose) for cost, pose in choices]


def _repetition(pose: Pose2, old: Pose2) -> float:
    return PENALTY * max(0.0, 1 - math.dist(pose[:2], old[:2]) / REACH)
