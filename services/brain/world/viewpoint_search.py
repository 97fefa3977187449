"""The next viewpoint of a search for an object that is not in view, from where the robot has looked so far. Pure."""

import math
from collections import Counter
from collections.abc import Collection
from itertools import product

from common.floor_plan import FloorPlan
from common.geometry import Array, Pose2
from common.viewpoints import Mask, Viewpoints
from services.brain.world.ways import Ways

AMPLE = 0.48
"""Free floor around a viewpoint [m] that is preferred; chosen: the footprint's radius 0.29 and what an unknown chair
takes of it. Where a surface shows from narrower places only, these are taken in the end."""
TRIES = 2
"""Times that a viewpoint is driven to in vain before it is given up [count]."""


def turn(viewpoints: Viewpoints, here: Pose2, looked_from: Collection[Pose2], told: Mask | None = None) -> Pose2 | None:
    """The heading at this spot that shows most that is new of tables, shelves and where it is `told` to be; None when
    turning shows nothing."""
    wanted = viewpoints.listed if told is None else viewpoints.listed | told
    return viewpoints.turn(here, _unseen(viewpoints, looked_from) * wanted)


def elsewhere(
    floor_plan: FloorPlan,
    viewpoints: Viewpoints,
    here: Pose2,
    looked_from: Collection[Pose2],
    unreached: Collection[Pose2] = (),
    likelihood: Array | None = None,
    told: Mask | None = None,
) -> Pose2 | None:
    """The viewpoint that shows most that is new for the way there; None when everything has been looked at.

    `unreached`: viewpoints that it could not get to, as often as it tried. Another one is chosen as long as there is
    any, then each once more: who stood in the way may have gone. `likelihood` (p,) of each point, as `Viewpoints.best`
    takes it. The points (p,) where it is `told` to be come first, sofas and beds last.
    """
    ways = Ways(floor_plan, (here[0], here[1]))

    def cost(to: Pose2) -> float:
        return ways.length((to[0], to[1]))

    def ample(to: Pose2) -> bool:
        return ways.room((to[0], to[1])) >= AMPLE and math.isfinite(cost(to))

    def fits(to: Pose2) -> bool:
        return math.isfinite(cost(to))

    unseen, failed = _unseen(viewpoints, looked_from), Counter(unreached)
    orders = (
        [unseen * viewpoints.listed, unseen] if told is None else [unseen * told, unseen * viewpoints.listed, unseen]
    )
    for most in range(1, TRIES + 1):
        tried = {*looked_from, *(pose for pose, times in failed.items() if times >= most)}
        for worth, free in product(orders, (ample, fits)):
            if (found := viewpoints.best(worth, tried, cost, free, likelihood)) is not None:
                return found
    return None


def _unseen(viewpoints: Viewpoints, looked_from: Collection[Pose2]) -> Array:
    """1 for each point (p,) that no look has shown, 0 for the others."""
    unseen: Array = (~viewpoints.covered(looked_from)).astype(float)
    return unseen
