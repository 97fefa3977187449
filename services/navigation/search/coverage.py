"""Search coverage: when each part of the surfaces was last looked at."""

import math

import numpy as np

from common.geometry import Array, Pose2
from common.viewpoints import Viewpoints

LOOKED_AT_BEFORE = 0.25
"""What a point counts that an earlier search looked at a short time ago [-]; chosen: it may have been overlooked."""
STILL, STILL_ANGLE = 0.03, 0.04
"""How far the base may move [m] and turn [rad] while it counts as standing: the play of the pose estimate."""


class SearchCoverage:
    """When each point of the surfaces was last looked at, in all searches: with the base standing for a while.

    `viewpoints` may be exchanged for those of another camera in the same household.
    """

    def __init__(self, viewpoints: Viewpoints) -> None:
        self.viewpoints = viewpoints
        self._looked_at: Array = np.full(len(viewpoints.points), -math.inf)
        self._pose: Pose2 = (math.inf, math.inf, 0.0)
        self._since = 0.0
        self._noted = False

    def look(self, pose: Pose2, now: float, look_time: float) -> bool:
        """Note what is in view from `pose` once the base has stood there for `look_time` [s]; True from then on."""
        moved = math.dist(pose[:2], self._pose[:2]) > STILL
        if moved or abs(math.remainder(pose[2] - self._pose[2], math.tau)) > STILL_ANGLE:
            self._pose, self._since, self._noted = pose, now, False
        steady = now - self._since >= look_time
        if steady and not self._noted:
            self._noted = True
            self._looked_at[self.viewpoints.visible(pose)] = now
        return steady

    def worth(self, started: float, recent: float) -> Array:
        """Worth (p,) of looking at each point for a search: 0 for those looked at since it `started` [s].

        Points that were looked at up to `recent` [s] before that count LOOKED_AT_BEFORE.
        """
        worth = np.where(self._looked_at >= started - recent, LOOKED_AT_BEFORE, 1.0)
        worth[self._looked_at >= started] = 0.0
        return worth

    def share(self, started: float) -> float:
        """Share of the points that were looked at since a search `started` [0 to 1]."""
        return float((self._looked_at >= started).mean()) if len(self._looked_at) else 1.0
