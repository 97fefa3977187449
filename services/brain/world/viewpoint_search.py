"""The next viewpoint of a search for an object that is not in view, from where the robot has looked so far. Pure."""

import math
from collections import Counter
from collections.abc import Collection

from common.approach import clearance
from common.floor_plan import FloorPlan
from common.geometry import Array, Pose2
from common.viewpoints import Viewpoints

CLEARANCE = 0.48
"""Free floor around a viewpoint [m]; chosen: the footprint's radius 0.29 and what an unknown chair takes of it."""
TRIES = 2
"""Times that a viewpoint is driven to in vain before it is given up [count]."""
ROOM_CHANGE = 3.0
"""What a door on the way costs [m of way]; chosen: about the detour that it makes of a straight line."""


def turn(viewpoints: Viewpoints, here: Pose2, looked_from: Collection[Pose2]) -> Pose2 | None:
    """The heading at this spot that shows most that is new; None when turning shows nothing."""
    return viewpoints.turn(here, _unseen(viewpoints, looked_from))


def elsewhere(
    floor_plan: FloorPlan,
    viewpoints: Viewpoints,
    here: Pose2,
    looked_from: Collection[Pose2],
    unreached: Collection[Pose2] = (),
    likelihood: Array | None = None,
) -> Pose2 | None:
    """The viewpoint that shows most that is new for the way there; None when everything has been looked at.

    `unreached`: viewpoints that it could not get to, as often as it tried. Another one is chosen as long as there is
    any, then each once more: who stood in the way may have gone. `likelihood` (p,) of each point, as `Viewpoints.best`
    takes it.
    """
    room = floor_plan.room_at(here[0], here[1])

    def cost(to: Pose2) -> float:
        other = floor_plan.room_at(to[0], to[1]) is not room
        return math.dist(here[:2], to[:2]) + ROOM_CHANGE * other

    def free(to: Pose2) -> bool:
        return clearance(floor_plan, to[0], to[1]) >= CLEARANCE

    unseen, failed = _unseen(viewpoints, looked_from), Counter(unreached)
    for most in range(1, TRIES + 1):
        tried = {*looked_from, *(pose for pose, times in failed.items() if times >= most)}
        if (found := viewpoints.best(unseen, tried, cost, free, likelihood)) is not None:
            return found
    return None


def _unseen(viewpoints: Viewpoints, looked_from: Collection[Pose2]) -> Array:
    """1 for each point (p,) that no look has shown, 0 for the others."""
    unseen: Array = (~viewpoints.covered(looked_from)).astype(float)
    return unseen
