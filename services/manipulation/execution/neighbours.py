"""A grab that makes room for itself: where a neighbour is all that is in the way, it is put elsewhere first."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

from msgspec import structs

from common import messages as m
from common.geometry import Array
from common.messages import WorldObject
from services.manipulation.execution.grasp_executor import grab
from services.manipulation.execution.place_executor import free_spots, place, place_back
from services.manipulation.execution.robot import Failure, Robot, Steps, planner_of
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import Planner
from services.manipulation.planning.planning_scene import obstacles, target_of
from services.manipulation.planning.straight_grab import Way, feasible

MOST, CONSIDERED = 2, 4
"""Neighbours that are put elsewhere for one object, and of how many these are chosen. Chosen: what takes less than the
patience of who sent the goal."""


def grab_with_room(robot: Robot, goal: m.ManipulationGoal, wanted: str) -> Steps[str]:
    """Grab; when neighbours stand in the way and no other stance of the base helps, put them elsewhere and grab again.

    A neighbour goes to a free spot of the surface that it stands on, off the wanted object. Returns the evidence.

    Raises:
        Failure: as a grab, or what kept the neighbour in the hand.
    """
    try:
        return (yield from grab(robot, goal, wanted))
    except Failure as failure:
        if failure.stance is not None or not failure.blockers or goal.object is None:
            raise
        labels = yield from _in_the_way(robot, goal, failure.blockers)
        for label in labels:
            yield from _put_elsewhere(robot, goal, label, failure)
        if not labels:
            raise
    evidence = yield from grab(robot, goal, wanted)
    return evidence + "".join(f"; the {label} was put elsewhere first" for label in labels)


def _in_the_way(robot: Robot, goal: m.ManipulationGoal, blockers: Sequence[str]) -> Steps[tuple[str, ...]]:
    """The fewest of the blockers without which a grasp can be reached; empty if there are none that can be moved."""
    found = robot.source.resolve(goal, "", robot.base)
    objects = {o.label: o for o in robot.source.objects() if not o.held}
    movable = [b for b in blockers[:CONSIDERED] if b in objects and _spare(robot, goal, objects[b])]
    if found is None or not movable:
        return ()
    config, household = robot.config, robot.io.household
    around = obstacles(household, robot.base, objects.values(), found.label)
    target = target_of(found, robot.base, household)
    way = Way(around, False, config.approach_distance, config.lift_height)
    return (yield from robot.work(fewest_to_move, planner_of(robot), target, way, movable, robot.joints.copy()))


def fewest_to_move(
    planner: Planner, target: Target, way: Way, movable: Sequence[str], joints: Array
) -> tuple[str, ...]:
    """The fewest labels of obstacles, `MOST` at most, without which the target can be grasped from `joints` (7,)."""
    for count in range(1, MOST + 1):
        for labels in combinations(movable, count):
            left = [o for o in way.around if o.label not in labels]
            if feasible(planner, target, replace(way, around=left), joints):
                return labels
    return ()


def _put_elsewhere(robot: Robot, goal: m.ManipulationGoal, label: str, failure: Failure) -> Steps[None]:
    """Grab a neighbour and put it on a free spot.

    Raises:
        Failure: the one that it was to mend, when the neighbour is not known any more, cannot be grasped either, or had
            to be put back.
    """
    found = next((o for o in robot.source.objects() if o.label == label), None)
    if found is None:
        raise failure  # the last look takes it for something else
    robot.io.log.info("making room", object=label)
    own = m.ManipulationGoal(goal="grab", id=goal.id, attempt=goal.attempt, object=reference(found))
    try:
        yield from grab(robot, own, "")
    except Failure as other:
        robot.io.log.info("stays in the way", object=label, code=other.code, detail=other.detail)
        raise failure from None
    try:
        yield from place(robot, found.on, away_from=_label(goal))
    except Failure as other:
        if robot.grasped is None:
            raise
        # The next grab needs an empty hand: from where it was taken it can be reached.
        robot.io.log.info("put back", object=label, code=other.code, detail=other.detail)
        yield from place_back(robot, found)
        raise failure from None


def _spare(robot: Robot, goal: m.ManipulationGoal, found: WorldObject) -> bool:
    """There is a free spot for it within reach, on the surface that it stands on."""
    r = robot.io.household.receptacle(found.on)
    spots = free_spots(robot, r, max(found.size[:2]), found.label, away_from=_label(goal)) if r and not r.depth else []
    return bool(spots)


def _label(goal: m.ManipulationGoal) -> str:
    return goal.object.label if goal.object is not None else ""


def reference(found: WorldObject) -> m.ObjectRef:
    """An object as a goal names it."""
    shared = set(m.ObjectRef.__struct_fields__) & set(WorldObject.__struct_fields__)
    return m.ObjectRef(**{name: value for name, value in structs.asdict(found).items() if name in shared})
