"""Where the base would have to stand for a grasp that is out of reach from where it stands, by the arm's kinematics."""

import math
from collections.abc import Sequence
from contextlib import suppress
from itertools import zip_longest

from msgspec import structs

from common.approach import EDGE_DISTANCE, ROOM, STAND_OFF, clearance, poses_for
from common.floor_plan import Receptacle
from common.furniture_tops import support_at
from common.geometry import SIDES, Array, Pose2, compose, inverse
from common.household import Household
from common.messages import WorldObject
from services.manipulation.planning.motion_planner import PlanError, Planner
from services.manipulation.planning.plan_grab import plan_grab
from services.manipulation.planning.planning_scene import MARGINS, obstacles, others, target_of
from services.manipulation.planning.straight_grab import Way, feasible

STAND_OFFS = (STAND_OFF, STAND_OFF + 0.08, STAND_OFF - 0.07, STAND_OFF + 0.15)
"""Distances [m] from the base's middle to the object that are tried. Chosen: the hand comes level from the farthest."""
SAME, SAME_TURN = 0.06, math.radians(10)
"""A pose no farther [m, rad] from another is the same stance: navigation stops within a third of it."""
MOST = 10
"""Stances that are tried."""


def other_stance(
    planner: Planner,
    household: Household,
    found: WorldObject,
    objects: Sequence[WorldObject],
    but: Sequence[Pose2],
    joints: Array,
    approach: float,
    lift: float,
    reach: float,
    stand_on: float | None = None,
    least: float = -math.inf,
) -> Pose2 | None:
    """A pose (x, y, theta) [map] before an object from which a whole grab of it can be planned; None if none was found.

    `objects`: all that is known to stand around; `but`: where the base stands and has been sent to; `joints` (7,) of
    the arm at rest; `approach`, `lift`: straight ways of the hand [m]; `reach`, `stand_on`, `least`: as in `plan_grab`.
    """
    around = others(objects, found)
    for pose in stances(household, found, but, STAND_OFFS)[:MOST]:
        target, solids = target_of(found, pose, household), obstacles(household, pose, around, margin=MARGINS[0])
        # What has no straight way in and up needs no search for the ways there and back.
        if not feasible(planner, target, Way(solids, False, approach, lift, stand_on), joints, least):
            continue
        with suppress(PlanError):
            plan_grab(planner, target, [solids], joints, approach, lift, reach, frozenset(), [], stand_on, least)
            return pose
    return None


def stances(household: Household, found: WorldObject, but: Sequence[Pose2], stand_offs: Sequence[float]) -> list[Pose2]:
    """Poses with room for the base before the object, other than those of `but`, of which the first is the present one.

    Those before the different sides of a surface take turns, on each side those of least penalty first: a side before
    which there is only room for one base, and which the household does not list for that, may be the one that serves.
    """
    x, y = found.position[:2]
    surface, room = household.receptacle(found.on) or support_at(household, x, y), household.room_at(x, y)
    listed = surface.approach if surface is not None else ()
    sides: list[Receptacle | None] = [surface]
    if surface is not None and listed:
        sides = [structs.replace(surface, approach=(s,)) for s in sorted(SIDES, key=lambda s: s not in listed)]
    turns = []
    for before in sides:
        known = before is not None and any(side in listed for side in before.approach)
        rated = [
            (penalty + 0.3 * math.dist(pose[:2], but[0][:2]), pose)
            for stand_off in stand_offs
            for penalty, pose in poses_for((x, y), before, stand_off, EDGE_DISTANCE)
            if not any(_same(pose, other) for other in but)
            and (known or household.room_at(*pose[:2]) is room)
            and clearance(household, *pose[:2]) >= ROOM
        ]
        turns.append(sorted(rated))
    return [one[1] for turn in zip_longest(*turns) for one in turn if one is not None]


def _same(pose: Pose2, other: Pose2) -> bool:
    dx, dy, turn = compose(inverse(other), pose)
    return math.hypot(dx, dy) < SAME and abs(turn) < SAME_TURN
