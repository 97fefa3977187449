"""Where the base has already stood for an item: asked again before the same thing, it stands somewhere else."""

import math

from common.geometry import Pose2
from services.navigation.goals import Choices

PENALTY, REACH = 1.0, 0.4  # of standing again where it stood [m]; no more of it from this far away on [m]


class Stood:
    """Forgets when it is sent elsewhere. A goal repeated under its own id is no new wish."""

    def __init__(self) -> None:
        self._item, self._poses = "", list[tuple[str, Pose2]]()

    def sent(self, item: str) -> None:
        """A goal: before an item, or "" for anything else."""
        if item != self._item:
            self._item, self._poses = item, []

    def arrived(self, goal_id: str, pose: Pose2 | None) -> None:
        """A goal before the item has been reached."""
        if self._item and pose is not None:
            self._poses.append((goal_id, pose))

    def apart(self, goal_id: str, choices: Choices) -> Choices:
        """The choices, those near where other goals ended with a penalty."""
        tried = [pose for other, pose in self._poses if other != goal_id]
        return [(cost + sum(_again(pose, old) for old in tried), pose) for cost, pose in choices]


def _again(pose: Pose2, old: Pose2) -> float:
    return PENALTY * max(0.0, 1 - math.dist(pose[:2], old[:2]) / REACH)
