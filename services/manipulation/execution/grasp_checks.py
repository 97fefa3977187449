"""What the hand felt of a grasp, held against what was planned: width, slip, contacts of the open fingers."""

import numpy as np

from common.geometry import Array, quat_matrix, yaw_quat
from common.messages import WorldObject
from services.manipulation.arm.contacts import Contact, came_around
from services.manipulation.execution.robot import Failure, Robot, planner_of
from services.manipulation.grasps.clearance import PAD
from services.manipulation.grasps.grasp_verification import WIDTH_ERROR, held_badly, judge
from services.manipulation.planning.plan_grab import GrabPlan
from services.manipulation.planning.straight_grab import with_reserve

SAME_WIDTH = 0.002
"""Difference [m] up to which two grasps of a measured object have felt the same width: the play of the fingers."""
INSERTING = 0.3
"""Share of the joint speed around the object: with 8 mm in the 40 ms until it stops the hand knocks with some 50 N."""
TIGHT, GENTLY = 0.008, 0.1
"""Room [m] beside either finger below which it may meet the object, and the share of the joint speed then: a third of
the speed, a third of the knock."""
BAD_HOLD = "BAD_HOLD"
"""Code within an attempt: the fingers hold the object by something else than its body; another grasp is tried."""


def insert_share(robot: Robot, plan: GrabPlan) -> float:
    """Share of the joint speed around the object, by the room that the fingers have if it is as wide as may be."""
    opening = with_reserve(planner_of(robot).arm.hand, plan.grasp.width)
    room = (min(plan.opening or opening, opening) - plan.grasp.width - plan.doubt) / 2
    return GENTLY if room < TIGHT else INSERTING


def note_contact(robot: Robot, plan: GrabPlan, found: WorldObject) -> None:
    """Remember that the open fingers touched the object, or something before it, on their way around it."""
    hand, wanted = planner_of(robot).reaction.position(robot.joints), plan.grasp.pose
    around = came_around(hand, wanted.position, plan.grasped.size, PAD)
    turn = quat_matrix(yaw_quat(robot.base[2]))
    robot.contacts.add(found.label, Contact(turn @ wanted.rotation, found.seen_at, around))
    robot.io.log.info(
        "contact", object=found.label, around=around, mm=round(1000 * float(np.linalg.norm(hand - wanted.position)))
    )


def touched_from(robot: Robot, label: str) -> list[Array]:
    """Rotations (3, 3) of the hand at contacts with the object, in the base frame."""
    turn = quat_matrix(yaw_quat(robot.base[2]))
    return [turn.T @ rotation for rotation in robot.contacts.rotations(label)]


def check_width(robot: Robot, plan: GrabPlan, widths: list[float]) -> None:
    """A known object that has not its width between the fingers is held by something else than its body.

    Raises:
        Failure: BAD_HOLD.
    """
    held, width = plan.grasped, robot.grip.width
    spec = robot.io.household.thing(held.label)
    if spec is None or plan.grasp.rim or plan.doubt or not held_badly(robot.grip, plan.grasp.width, spec.kind):
        return
    if any(abs(width - other) < WIDTH_ERROR for other in widths):
        robot.io.log.warning("not as wide as it should be", object=held.label, mm=round(1000 * width, 1))
        return
    widths.append(width)
    raise Failure(BAD_HOLD, f"width {1000 * width:.1f} mm where the {held.label} has {1000 * plan.grasp.width:.1f}")


def check_hold(robot: Robot, plan: GrabPlan, at_close: float | None, widths: list[float]) -> None:
    """Raises `Failure` unless the object is held; a measured width that was felt otherwise twice was measured wrong."""
    nominal, width = 0.0 if plan.grasp.rim else plan.grasp.width, robot.grip.width
    if plan.doubt and any(abs(width - other) < SAME_WIDTH for other in widths):
        nominal = 0.0 if plan.grasp.rim else width
    code = judge(
        robot.grip, nominal, at_close, robot.config, plan.doubt, certain=plan.doubt > 0 and not plan.grasp.on_surface
    )
    if code:
        if plan.doubt and robot.grip.holds():
            widths.append(width)
        was = "" if at_close is None else f", was {at_close * 1000:.1f} mm"
        detail = f"width {width * 1000:.1f} mm{was}, force {robot.grip.force:.0f} N"
        raise Failure(code, detail)
