"""Where the base would have to stand for a grasp that is out of reach from where it stands, by the arm's kinematics."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

from msgspec import structs

from common.approach import EDGE_DISTANCE, ROOM, STAND_OFF, clearance, poses_for
from common.floor_plan import Receptacle
from common.furniture_tops import support_at
from common.geometry import SIDES, Array, Pose2, compose, inverse, to_frame, yaw_matrix
from common.household import Household
from common.messages import WorldObject
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.grasp import Grasp, is_poor
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import Planner
from services.manipulation.planning.plan_grab import GrabPlan, whole_grab
from services.manipulation.planning.planning_scene import MARGINS, obstacles, others, target_of
from services.manipulation.planning.straight_grab import STANCE_GRASPS, Way, with_fingers

STAND_OFFS = (STAND_OFF, STAND_OFF + 0.08, STAND_OFF - 0.07, STAND_OFF + 0.15)
"""Distances [m] from the base's middle to the object that are tried. Chosen: the hand comes level from the farthest."""
SAME, SAME_TURN = 0.06, math.radians(10)
"""A pose no farther [m, rad] from another is the same stance: navigation stops within a third of it."""
MOST = 10
"""Stances that are tried."""
SIDE = math.radians(25)
"""Angle [rad] between two views of an object up to which the grasps looked for in one serve in the other: that between
two bearings of the hand."""


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
    seen: Target | None = None,
) -> Pose2 | None:
    """A pose (x, y, theta) [map] before an object from which a whole grab of it can be planned; None if none was found.

    `objects`: all that is known to stand around; `but`: where the base stands and has been sent to; `joints` (7,) of
    the arm at rest; `approach`, `lift`: straight ways of the hand [m]; `reach`, `stand_on`: as in `plan_grab`. With
    `seen`, the object from where the base stands, one of the good grasps of that has to be in reach. Without, grasps
    are looked for once on each side of it: that takes seconds.
    """
    around = others(objects, found)
    views: list[_View] = []
    if seen is not None:
        views = [_View(but[0], known := planner.believed(seen), _good(planner, known))]
        if not views[0].grasps:
            return None
    for pose in stances(household, found, but, STAND_OFFS)[:MOST]:
        if math.dist(to_frame(pose, found.position[:2]), (planner.arm.forward, 0.0)) > reach:
            continue
        view = views[0] if seen is not None else next((v for v in views if v.on_side_of(pose, found)), None)
        if view is None:
            target = planner.believed(target_of(found, pose, household))
            grasps = [grasp for stage in planner.candidates(target) for grasp in stage[:STANCE_GRASPS]]
            views.append(view := _View(pose, target, grasps))
        solids = obstacles(household, pose, around, margin=MARGINS[0])
        way = Way(solids, False, approach, lift, stand_on)
        if _holds(planner, view.target, view.grasps, compose(inverse(pose), view.base), way, joints):
            return pose
    return None


@dataclass(frozen=True)
class _View:
    """Grasps of an object, both in the frame of a `base` (x, y, theta) [map] before it."""

    base: Pose2
    target: Target
    grasps: Sequence[Grasp]

    def on_side_of(self, pose: Pose2, found: WorldObject) -> bool:
        """The object is seen from a pose from about the same side."""
        x, y = found.position[:2]
        turns = [math.atan2(y - at[1], x - at[0]) for at in (self.base, pose)]
        return abs(math.remainder(turns[0] - turns[1], math.tau)) < SIDE


def _good(planner: Planner, target: Target) -> list[Grasp]:
    """The good grasps of an object, the best first, as many as are tried at a stance."""
    found = [g for stage in planner.candidates(target) for g in stage if not is_poor(g)]
    return found[:STANCE_GRASPS]


def _holds(planner: Planner, target: Target, grasps: Sequence[Grasp], move: Pose2, way: Way, now: Array) -> bool:
    """One of the grasps of an object can be carried out after both were moved by (x, y, theta) in the base frame."""
    turn, (x, y, _) = yaw_matrix(move[2]), move
    at = turn @ target.position + (x, y, 0.0)
    points = None if target.points is None else target.points @ turn.T
    there = replace(target, position=tuple(at.tolist()), yaw=target.yaw + move[2], points=points)
    for grasp in grasps:
        pose = Pose(turn @ grasp.pose.position + (x, y, 0.0), turn @ grasp.pose.rotation)
        axis = None if grasp.axis is None else grasp.axis + move[2]
        moved = replace(grasp, pose=pose, axis=axis)
        if isinstance(with_fingers(planner, there, moved, way, now, whole_grab), GrabPlan):
            return True
    return False


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
