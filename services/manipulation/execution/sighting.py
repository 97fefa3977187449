"""Where the object to grasp is seen: before the arm moves, and by the wrist camera from in front of it."""

import math

import numpy as np

from common import messages as m
from common.kinds import kind_of
from common.messages import WorldObject
from services.manipulation.execution.robot import Failure, Robot, Steps, planner_of
from services.manipulation.grasps.grasp import on_handle
from services.manipulation.grasps.target import Target
from services.manipulation.planning.plan_grab import GrabPlan, refine
from services.manipulation.planning.planning_scene import target_of, tilt_of, turned

MISTAKEN = "MISTAKEN"
"""Code: the object is not where the grasp was planned for; a new plan is needed, no attempt was made."""

OUTERMOST = (0.02, 0.98)
"""Shares of what was seen of something along an axis between which its sides are; beyond are mixed pixels."""


def sighted(
    robot: Robot, goal: m.ManipulationGoal, wanted: str, since: float, touched: bool = False
) -> Steps[WorldObject]:
    """The object to grab as it was seen after `since`.

    An older sighting will do when no newer one comes in time, unless the hand has `touched` it since then.

    Raises:
        Failure: NO_OBJECT.
    """
    robot.phase = "look"
    watched = robot.io.peer("perception")
    end = robot.now + (robot.config.look_patience if watched else 0.0)
    while True:
        found = robot.source.resolve(goal, wanted, robot.base, since)
        if found is not None and (found.seen_at >= since or (robot.now >= end and not (touched and watched))):
            return found
        if robot.now >= end:
            what = wanted or (goal.object.label if goal.object else "object")
            raise Failure("NO_OBJECT", f"no {what} is {'seen' if found else 'known'} here")
        yield


def aimed(robot: Robot, plan: GrabPlan, goal: m.ManipulationGoal, found: WorldObject) -> Steps[GrabPlan]:
    """The plan corrected by what the wrist camera sees from in front of the object, or as it was.

    Raises:
        Failure: MISTAKEN, it was planned for a place or a side that is not the object's.
    """
    config, since = robot.config, robot.now
    if not robot.io.peer("perception") or (tilt_of(found) and not found.measured) or plan.grasp.over_edge:
        # From so near the wrist camera sees no end of what lies, by which a listed object is told.
        return plan
    robot.phase = "aim"
    seen: WorldObject | None = None
    while seen is None and robot.now - since < config.aim_patience:
        yield
        closer = robot.source.resolve(goal, found.label, robot.base, since)
        seen = closer if closer is not None and closer.label == found.label and closer.seen_at >= since else None
    if seen is None:
        return plan
    was, new = (target_of(o, robot.base, robot.io.household) for o in (found, seen))
    shift = moved(was, new)
    off, turn = math.hypot(*shift), turned(was, new) if kind_of(found.kind).shape == "box" else 0.0
    if off > config.aim_most or turn > config.aim_turn:
        raise Failure(MISTAKEN, f"{found.label} is {1000 * off:.0f} mm and {math.degrees(turn):.0f} deg from there")
    if on_handle(new, plan.grasp.pose.rotation):
        raise Failure(MISTAKEN, f"a finger would land on the handle of the {found.label}")
    if off < config.aim_least:
        return plan
    robot.io.log.info("aim corrected", object=found.label, by_mm=round(1000 * off, 1))
    try:
        return (yield from robot.work(
            refine, planner_of(robot), plan, shift
        ))  # fmt: skip
    except Failure:
        return plan


def moved(was: Target, new: Target) -> tuple[float, float]:
    """How far (x, y) [m] something is seen from where it was seen before: without a shape of its own, as far as both of
    its sides are. From near, a part of it may be all that is seen, and the middle of that is elsewhere.
    """
    shift = np.array(new.position) - np.array(was.position)
    if was.points is None or new.points is None or was.shape not in ("long", "irregular"):
        return float(shift[0]), float(shift[1])
    before, after = (np.quantile(points, OUTERMOST, axis=0) for points in (was.points, new.points))
    sides = (after - before + shift)[:, :2]
    least = np.where((sides > 0).all(axis=0) | (sides < 0).all(axis=0), np.abs(sides).min(axis=0), 0.0)
    x, y = least * np.sign(sides[0])
    return float(x), float(y)
