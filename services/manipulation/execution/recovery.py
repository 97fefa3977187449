"""Recovery of an arm that a former process or a stop left somewhere: with an object to the carry pose, empty home."""

from collections.abc import Sequence

import numpy as np

from common.geometry import Array
from common.messages import ObjectRef
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.arm.touch import BLOCKED
from services.manipulation.arm.trajectory import Leg
from services.manipulation.execution.releasing import STUCK
from services.manipulation.execution.robot import SLOWLY, Failure, Robot, Steps, planner_of
from services.manipulation.grasps.grasped_object import USUAL_SIZE, GraspedObject
from services.manipulation.planning.lift import straight_up
from services.manipulation.planning.motion_planner import PlanError, Planner
from services.manipulation.planning.planning_scene import obstacles

NEAR = 0.15
"""Largest joint angle [rad] off a carry pose at which the arm counts as retracted. Chosen: no joint's lag is as
large."""


def go_home(robot: Robot) -> Steps[str]:
    """The carry pose, by a path around what is known; around furniture at least where an object is in the way, which
    need not be where it was believed once the hand was there. What is met is backed off, and passed slowly."""
    for share in (1.0, SLOWLY):
        known = [robot.source.objects(), []]
        around = [obstacles(robot.io.household, robot.base, objects, margin=0.0) for objects in known]
        path = yield from robot.work(planner_of(robot).to_home, robot.joints.copy(), around)
        try:
            yield from robot.follow(path, robot.config.joint_speed * share)
            break
        except Failure as failure:
            if failure.code != BLOCKED or share == SLOWLY:
                raise
            robot.io.log.warning("on the way home", code=failure.code, detail=failure.detail)
    return "arm at home"


def at_carry(planner: Planner, joints: Array) -> bool:
    """True when the arm is retracted to a carry pose."""
    return any(float(np.abs(planner.arm.nearest_turn(c, joints) - joints).max()) < NEAR for c in planner.carries)


def in_hand(planner: Planner, joints: Array, width: float, wanted: ObjectRef | None) -> GraspedObject:
    """The most likely object in the gripper: the wanted one, upright, grasped at half its height."""
    size = wanted.size if wanted is not None and min(wanted.size) > 0 else USUAL_SIZE
    label, kind = (wanted.label, wanted.kind) if wanted is not None else ("object", "")
    rotation = planner.arm.pose(joints).rotation
    offset = np.array([0.0, 0.0, size[2] / 2])
    return GraspedObject(label or "object", kind, rotation, offset, size, width, 0.0, guessed=True)


def retreat(planner: Planner, held: GraspedObject, now: Array, around: Sequence[Obstacle], lift: float) -> list[Leg]:
    """Legs of a joint path straight up by `lift` [m], then to a carry pose.

    Raises:
        PlanError: BLOCKED.
    """
    for up in straight_up(planner, now, lift):
        try:
            return [Leg([now, *up], near=True), *planner.carry(held, up[-1], around)]
        except PlanError:
            continue
    return planner.carry(held, now, around)


def retract_grasped(robot: Robot, wanted: ObjectRef | None) -> Steps[str]:
    """Lift what the hand was found to hold and retract. Returns the evidence; SLIPPED, BLOCKED when that fails."""
    planner, config = robot.planner, robot.config
    label = robot.grasped.label if robot.grasped else ""
    if planner is not None and not at_carry(planner, robot.joints):
        held = robot.grasped or in_hand(planner, robot.joints, robot.grip.width, wanted)
        around = obstacles(robot.io.household, robot.base, robot.source.objects(), without=held.label)
        robot.phase = "retract"
        path = yield from robot.work(retreat, planner, held, robot.joints.copy(), around, config.lift_height)
        yield from robot.travel(path, 0.5)
        yield from robot.wait(0.2)
        if not robot.grip.holds():
            robot.grasped = None
            raise Failure("SLIPPED", f"the {held.label} was lost on the way to the carry pose")
        robot.grasped = held
        robot.source.remember(held.label, None, "", robot.now)
    return f"already holding {label or 'something'}: width {robot.grip.width * 1000:.1f} mm"


def fold(robot: Robot) -> Steps[str]:
    """To the carry pose, with what is held."""
    return (yield from retract_grasped(robot, None) if robot.grip.holds() else go_home(robot))


def brought_back(robot: Robot, steps: Steps[str]) -> Steps[str]:
    """Steps that leave an empty hand over a surface where they fail: the arm is taken back before that is said.

    The base drives on after a failure, and an arm that is held out meets furniture on the way. With something in the
    hand the next attempt goes on from there, which finds ways that the first one did not; the service takes the arm
    back where none comes.

    Raises:
        Failure: as the steps do.
    """
    try:
        return (yield from steps)
    except Failure as failure:
        if failure.code != STUCK and not robot.grip.holds():
            yield from retract_empty(robot)
        raise


def retract_empty(robot: Robot) -> Steps[None]:
    """Open an empty hand and take the arm back, if there is a way."""
    yield from robot.move_gripper(0.0)
    if robot.planner is not None and not at_carry(robot.planner, robot.joints):
        try:
            yield from go_home(robot)
        except Failure as failure:
            robot.io.log.warning("the arm stays where it is", code=failure.code, detail=failure.detail)
