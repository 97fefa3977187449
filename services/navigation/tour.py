"""The search for an object that nobody knows of: view after view, the near and the new ones first."""

import math

import numpy as np

from common.geometry import Pose2
from services.navigation.costmap import Array, Costmap
from services.navigation.planner import PathPlanner
from services.navigation.views import Seen, Views, next_view

KNOWN = 0.25


class Memory:
    """When each point of the surfaces was last looked at, over all searches: the camera must stand still for that."""

    def __init__(self, views: Views) -> None:
        self.views = views
        self.at: Array = np.full(len(views.points), -math.inf)
        self._pose: Pose2 = (math.inf, math.inf, 0.0)
        self._since = 0.0
        self._noted = False

    def look(self, pose: Pose2, now: float, patience: float) -> bool:
        """Note what has been in view for `patience` seconds; True while it has."""
        if math.dist(pose[:2], self._pose[:2]) > 0.03 or abs(math.remainder(pose[2] - self._pose[2], math.tau)) > 0.04:
            self._pose, self._since, self._noted = pose, now, False
        steady = now - self._since >= patience
        if steady and not self._noted:
            self._noted = True
            self.at[self.views.visible(pose)] = now
        return steady


class Tour:
    """One search."""

    def __init__(self, memory: Memory, now: float, recent: float) -> None:
        self._memory, self._started, self._recent = memory, now, recent
        self._tried: set[int] = set()

    @property
    def looked(self) -> int:
        """How many views were taken or tried."""
        return len(self._tried)

    def next(self, pose: Pose2, planner: PathPlanner, costmap: Costmap, radius: float) -> Pose2 | None:
        """The next pose to look from; None when everything that can be seen was looked at in this search."""
        field = planner.field(pose[0], pose[1])
        best = next_view(
            self._memory.views,
            self._worth(),
            self._tried,
            lambda to: planner.cost_to(field, (to[0], to[1])),
            costmap,
            radius,
        )
        if best is None:
            return None
        self._tried.add(best)
        return self._memory.views.poses[best]

    def share(self) -> float:
        """How much of the surfaces was looked at in this search."""
        seen: Seen = self._memory.at >= self._started
        return float(seen.mean()) if len(seen) else 1.0

    def _worth(self) -> Array:
        """What was looked at shortly before counts little, what this search has looked at nothing."""
        at = self._memory.at
        worth = np.where(at >= self._started - self._recent, KNOWN, 1.0)
        worth[at >= self._started] = 0.0
        return worth
