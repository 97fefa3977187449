"""Where the base has already stood for an object: sent before the same object again, it stands somewhere else."""

import math

from common.geometry import Pose2
from services.navigation.goals import Choices

PENALTY = 1.0
"""Penalty of standing where it stood [m of way]; chosen: more than two approach poses of one object differ by."""
REACH = 0.4
"""Distance from which on a pose is another one [m]; chosen: two steps between approach poses."""


class ApproachHistory:
    """Forgotten when the base is sent elsewhere. A goal repeated under its own id is no new wish."""

    def __init__(self) -> None:
        self._item, self._poses = "", list[tuple[str, Pose2]]()

    def goal_sent(self, item: str) -> None:
        """A goal before an item, or "" for anything else."""
        if item != self._item:
            self._item, self._poses = item, []

    def arrived(self, goal_id: str, pose: Pose2 | None) -> None:
        """A goal has been reached."""
        if self._item and pose is not None:
            self._poses.append((goal_id, pose))

    def penalised(self, goal_id: str, choices: Choices) -> Choices:
        """The choices, those near where other goals ended with a penalty."""
        tried = [pose for other, pose in self._poses if other != goal_id]
        return [(cost + sum(_repetition(pose, old) for old in tried), pose) for cost, pose in choices]


def _repetition(pose: Pose2, old: Pose2) -> float:
    return PENALTY * max(0.0, 1 - math.dist(pose[:2], old[:2]) / REACH)
