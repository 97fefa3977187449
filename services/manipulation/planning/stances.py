"""Where the base would have to stand for a grasp that is out of reach from where it stands, by the arm's kinematics."""

import math
from collections.abc import Sequence

from common.approach import EDGE_DISTANCE, ROOM, STAND_OFF, clearance, poses_for
from common.geometry import Pose2, compose, inverse
from common.household import Household
from common.messages import WorldObject
from services.manipulation.arm.arm_model import Array
from services.manipulation.planning.motion_planner import Planner
from services.manipulation.planning.planning_scene import MARGINS, obstacles, others, target_of
from services.manipulation.planning.straight_grab import Way, feasible

STAND_OFFS = (STAND_OFF, STAND_OFF + 0.08, STAND_OFF - 0.07, STAND_OFF + 0.15)
"""Distances [m] from the base's middle to the object that are tried. Chosen: the hand comes level from the farthest."""
SAME, SAME_TURN = 0.06, math.radians(10)
"""A pose no farther [m, rad] from the present one is no other stance: navigation stops within a third of it."""
MOST = 10
"""Stances that are tried."""


def other_stance(
    planner: Planner,
    household: Household,
    found: WorldObject,
    objects: Sequence[WorldObject],
    base: Pose2,
    joints: Array,
    approach: float,
    lift: float,
    stand_on: float | None = None,
) -> Pose2 | None:
    """A pose (x, y, theta) [map] before an object from which the arm reaches a grasp of it; None if none was found.

    `objects`: all that is known to stand around; `joints` (7,) of the arm at rest; `approach`, `lift`: straight ways
    of the hand [m]; `stand_on`: as in `Way`.
    """
    for pose in stances(household, found, base, STAND_OFFS)[:MOST]:
        around = obstacles(household, pose, others(objects, found), margin=MARGINS[0])
        if feasible(planner, target_of(found, pose, household), Way(around, False, approach, lift, stand_on), joints):
            return pose
    return None


def stances(household: Household, found: WorldObject, base: Pose2, stand_offs: Sequence[float]) -> list[Pose2]:
    """Poses with room for the base before the object, other than the present one, those of least penalty first."""
    x, y = found.position[:2]
    surface = household.receptacle(found.on) or household.surface_at(x, y)
    rated = []
    for stand_off in stand_offs:
        for penalty, pose in poses_for((x, y), surface, stand_off, EDGE_DISTANCE):
            dx, dy, turn = compose(inverse(base), pose)
            here = math.hypot(dx, dy) < SAME and abs(turn) < SAME_TURN
            if not here and clearance(household, pose[0], pose[1]) >= ROOM:
                rated.append((penalty + 0.3 * math.hypot(dx, dy), pose))
    return [pose for _, pose in sorted(rated)]
