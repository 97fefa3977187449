"""Grasp executor: reach, aim, grasp, retract; another candidate after a miss."""

import math
from dataclasses import replace

import numpy as np

from common import messages as m
from common import topics
from common.geometry import Array
from common.messages import WorldObject
from services.manipulation.arm.touch import BLOCKED, HIT, TOO_HEAVY, TOUCHED, load_limit
from services.manipulation.arm.trajectory import back_along, parallel, whole
from services.manipulation.execution.closing import close
from services.manipulation.execution.grasp_checks import (
    BAD_HOLD,
    check_hold,
    check_width,
    insert_share,
    note_contact,
    touched_from,
)
from services.manipulation.execution.grasp_choice import chosen, look_elsewhere, surroundings
from services.manipulation.execution.recovery import go_home, retreat
from services.manipulation.execution.robot import SLOWLY, Failure, Robot, Steps, planner_of
from services.manipulation.execution.setting_down import set_down
from services.manipulation.execution.sighting import MISTAKEN, aimed, sighted
from services.manipulation.grasps.grasp import Grasp, shown
from services.manipulation.grasps.grasp_verification import settled
from services.manipulation.planning.plan_grab import GrabPlan, from_place
from services.manipulation.planning.planning_scene import target_of
from services.manipulation.planning.straight_grab import with_reserve

TOO_WIDE = "TOO_WIDE"
"""Code: the object does not fit between the open fingers."""
MISSED = 0.015
"""Distance [m] of two sightings of the same place. Chosen: the noise of either; what fingers push away goes farther."""
WEIGHED = 3
"""Points of the lift at whose end what is too heavy has shown: 40 mm, where 30 N bend the arm by 3; slowly, for where
the arm is nearly stretched its own damping shows as 20 N at twice the speed."""
STRAINING, SURE = 0.06, 0.75
"""Share of the joint speed for the first point of the lift, and of what the pads hold as the most it may weigh there.
Chosen: beyond that they slip, and knock with 100 N; the arm strains by 10 N/mm and stops in 40 ms."""


def grab(robot: Robot, goal: m.ManipulationGoal, wanted: str) -> Steps[str]:
    """Reach, grasp, retract; another candidate after a miss. Returns the evidence."""
    config = robot.config
    since = robot.now - config.fresh
    tried: list[Grasp] = []
    widths: list[float] = []
    last = Failure("UNREACHABLE", "no grasp tried")
    weighed, missed = False, (math.inf, 0.0, 0.0)
    for _ in range(config.max_candidates):
        try:
            found = yield from sighted(robot, goal, wanted, since, touched=bool(tried))
        except Failure as failure:
            raise (Failure(last.code, f"{last.detail}; {failure.detail} since") if tried else failure) from None
        if math.dist(found.position, missed) < MISSED and found.label not in robot.sent_to:
            # The hand has closed on nothing where it is seen again from here: from elsewhere it is seen otherwise.
            yield from look_elsewhere(robot, found, last)
        robot.phase = "reach"
        target, around = target_of(found, robot.base, robot.io.household), surroundings(robot, found)
        try:
            plan = yield from chosen(robot, found, target, around, tried, touched_from(robot, found.label), goal.to)
        except Failure as failure:
            raise (last if tried else failure) from None
        candidates = shown(
            target, plan.options, robot.base, robot.now, (g.name for g in tried), plan.grasp.name, goal.id
        )
        robot.io.publish(topics.GRASPS, candidates)
        wanted_hold = next((g for g in plan.options if g.name == plan.grasp.name), plan.grasp)
        tried.append(from_place(wanted_hold, np.array(target.position)))
        opening = round(1000 * plan.opening) if plan.opening else None
        robot.io.log.info("grasp chosen", object=found.label, grasp=plan.grasp.name, opening_mm=opening)
        try:
            return (yield from _execute_grab(robot, plan, goal, found, widths))
        except Failure as failure:
            if failure.code == MISTAKEN:
                robot.io.log.info("aim mistaken", detail=failure.detail, grasp=plan.grasp.name)
                tried.pop()
                since, last = robot.now - config.fresh, failure
                continue
            if failure.code not in ("EMPTY_GRASP", "SLIPPED", BLOCKED, BAD_HOLD, TOUCHED, TOO_HEAVY):
                raise
            last = failure
            robot.io.log.warning("grasp failed", code=failure.code, detail=failure.detail, grasp=plan.grasp.name)
            if failure.code == BLOCKED and robot.grip.holds():
                raise  # opened here the hand would drop it; the next attempt goes on from where the arm is
            robot.phase = "retract"
            robot.grasped = None
            yield from robot.move_gripper(0.0)
            yield from go_home(robot)
            if failure.code == "EMPTY_GRASP":
                missed = found.position
            if failure.code == TOO_HEAVY:
                # Fingers that are wedged between a thing and its surface feel the same once, not from another side too.
                if weighed:
                    raise
                weighed = True
            if failure.code != TOUCHED:
                robot.contacts.clear()
            elif robot.contacts.too_wide():
                detail = f"the open fingers met the {found.label} from two sides; last: {failure.detail}"
                raise Failure(TOO_WIDE, detail) from None
            # What was seen while the hand was at work may have been half hidden by it.
            since = robot.now
    raise last


def _execute_grab(
    robot: Robot, plan: GrabPlan, goal: m.ManipulationGoal, found: WorldObject, widths: list[float]
) -> Steps[str]:
    """`widths`: of earlier bad holds [m]; one that is felt again from another side is the object's own."""
    config = robot.config
    hand = planner_of(robot).arm.hand
    yield from robot.move_gripper(hand.share(with_reserve(hand, plan.grasp.width)))
    yield from robot.travel(plan.reach)
    plan = yield from aimed(robot, plan, goal, found)
    if plan.opening is not None:
        yield from robot.move_gripper(hand.share(plan.opening))
    free = yield from robot.at_rest()
    try:
        yield from robot.follow(plan.insert, config.joint_speed * insert_share(robot, plan), robot.guard(free))
        robot.phase = "grasp"
        at = yield from close(robot, plan.insert[-1], robot.guard(free, HIT, "down"))
        plan = replace(plan, lift=parallel(plan.lift, at))
        check_hold(robot, plan, None, widths)
    except Failure as failure:
        if failure.code == TOUCHED:
            note_contact(robot, plan, found)
        yield from _withdraw(robot, plan)
        raise
    held = closed = robot.grip.width
    robot.grasped = plan.grasped
    robot.phase = "retract"
    way = [plan.lift]
    try:
        for part, share, limit in ((plan.lift[:2], STRAINING, SURE), (plan.lift[1:WEIGHED], 0.25, 1.0)):
            weight = robot.guard(free, limit * load_limit(config.grip_effort), "up")
            yield from robot.follow(part, config.joint_speed * share, weight)
            # What begins to slip is set back from a few centimetres, and falls nowhere.
            if plan.doubt and not plan.grasp.rim:
                held = settled(robot.grip, closed, config)
            check_hold(robot, plan, held, widths)
        yield from robot.follow(plan.lift[WEIGHED:], config.joint_speed * 0.5)
        check_hold(robot, plan, held, widths)
        check_width(robot, plan, widths)
        way.append(whole(plan.carry))
        yield from _carry(robot, plan)
        if plan.doubt and not plan.grasp.rim:
            # What has turned as the hand did, and stays so, is as well held as what turned when it came off.
            held = settled(robot.grip, held, config)
        check_hold(robot, plan, held, widths)
    except Failure as failure:
        if failure.code in ("SLIPPED", BAD_HOLD, TOO_HEAVY, BLOCKED) and robot.grip.holds():
            yield from _set_back(robot, plan, way, free)
        raise
    robot.contacts.clear()
    robot.met_before.clear()
    robot.sent_to.pop(plan.grasped.label, None)
    robot.source.remember(plan.grasped.label, None, "", robot.now)
    return f"{plan.grasped.label} held: width {robot.grip.width * 1000:.1f} mm, force {robot.grip.force:.0f} N"


def _withdraw(robot: Robot, plan: GrabPlan) -> Steps[None]:
    """Open and leave the way the hand came: the object may still stand between the fingers."""
    robot.phase = "retract"
    yield from robot.move_gripper(0.0)
    try:
        yield from robot.follow(back_along(plan.insert, robot.joints), robot.config.joint_speed * 0.6)
    except Failure as failure:
        robot.io.log.warning("on the way out", code=failure.code, detail=failure.detail)
        robot.forget_command()


def _set_back(robot: Robot, plan: GrabPlan, way: list[list[Array]], free: Array) -> Steps[None]:
    """What is held badly goes back to where it was taken: the hand would drop it from where it is.

    What hangs lower in the hand by now stands before the hand is back; `free`: torques (7,) [Nm] in the air.
    """
    for path in reversed(way):
        back = back_along(path, robot.joints)
        try:
            if path is plan.lift:
                yield from set_down(robot, back, robot.guard(free, way="down"))
            else:
                yield from robot.follow(back, robot.config.joint_speed * 0.5)
        except Failure as failure:
            if failure.code != TOUCHED:
                raise
            robot.io.log.info("set back", object=plan.grasped.label, felt=failure.detail)
    yield from _withdraw(robot, plan)


def _carry(robot: Robot, plan: GrabPlan) -> Steps[None]:
    """To the carry pose; where something is met, as by what hangs askew in the hand, up and on by another path."""
    try:
        yield from robot.travel(plan.carry, 0.8)
    except Failure as failure:
        if failure.code != BLOCKED or not robot.grip.holds():
            raise
        robot.io.log.info("met on the way", object=plan.grasped.label, detail=failure.detail)
        path = yield from robot.work(
            retreat, planner_of(robot), plan.grasped, robot.joints.copy(), plan.around, robot.config.lift_height
        )
        yield from robot.travel(path, SLOWLY)
    yield from robot.wait(0.2)
