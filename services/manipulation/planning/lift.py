"""The lift of a grasped object: off what it touches, and above its neighbours before the arm turns away with it."""

from collections.abc import Sequence

import numpy as np

from common.geometry import Array
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import Planner

OVER = 0.03
"""How far [m] its underside goes over its neighbours. Chosen: askew in the hand it hangs that much lower."""
SIDEWAYS = 0.12
"""Free way [m] up to which something is a neighbour. Chosen: what is held swings by a breadth as the hand turns."""


def over_neighbours(
    planner: Planner, target: Target, grasp: Grasp, around: Sequence[Obstacle], top: Array, lift: float
) -> list[Array]:
    """Joint path, a list of (7,), that lifts a held object on until it is above its neighbours.

    It begins at `top`, the configuration at the end of a lift by `lift` [m]; half as far where the arm cannot, and
    empty where there is no need or no way.
    """
    tops = [o.center[2] + o.size[2] / 2 for o in around if o.label and _apart(o, target) < SIDEWAYS]
    more = max(tops, default=-np.inf) + OVER - target.bottom - lift
    begin = grasp.pose.moved(np.array([0.0, 0.0, lift]))
    if more <= 0:
        return []
    planner.arm.set_obstacles(around)
    for share in (1.0, 0.5):
        path = planner.straight(top, begin, begin.moved(np.array([0.0, 0.0, share * more])))
        if path is not None and not any(planner.arm.collides(q) for q in path):
            return path
    return []


def straight_up(planner: Planner, now: Array, lift: float) -> list[list[Array]]:
    """Joint paths straight up from `now` (7,), by `lift` [m] and by half of it, where the arm can."""
    planner.arm.hold(None)
    here = planner.arm.pose(now)
    paths = (planner.straight(now, here, here.moved(np.array([0.0, 0.0, way]))) for way in (lift, lift / 2))
    return [path for path in paths if path is not None]


def _apart(solid: Obstacle, target: Target) -> float:
    """Free way [m] between the circles around two outlines, seen from above."""
    centres = float(np.hypot(solid.center[0] - target.position[0], solid.center[1] - target.position[1]))
    return centres - max(solid.size[:2]) / 2 - max(target.size[:2]) / 2
