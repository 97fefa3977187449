"""Grabbing: reach, aim, grasp, retract; another candidate after a miss."""

import math

from common import messages as m
from common import topics
from common.kinds import kind_of
from common.messages import WorldObject
from services.manipulation.arm_model import Array, Obstacle
from services.manipulation.grasp import shown
from services.manipulation.held import Held
from services.manipulation.plan_grab import GrabPlan, plan_grab, refine
from services.manipulation.robot import Failure, Robot, Steps, go_home, planner_of
from services.manipulation.surroundings import obstacles, target_of, turned
from services.manipulation.touch import TOO_HEAVY, TOUCHED, load_limit
from services.manipulation.trajectory import back_along
from services.manipulation.verify import WIDTH_ERROR, does_not_fit, held_badly, holds, judge

MISTAKEN = "MISTAKEN"
BAD_HOLD = "BAD_HOLD"
TOO_WIDE = "TOO_WIDE"
CLOSING_EFFORT = 8.0
"""Force [N] with which the fingers come before they grip: slow enough that they do not knock (in simulation 0.16 m/s
each, three times what they do with the whole grip force)."""
WEIGHED = 3
"""Points of the lift at whose end what is too heavy has shown: 40 mm, where 30 N bend the arm by 3; slowly, for where
the arm is nearly stretched its own damping shows as 20 N at twice the speed."""
INSERTING = 0.3
"""Share of the joint speed around the object: with 8 mm in the 40 ms until it stops the hand knocks with some 50 N."""


def grab(robot: Robot, goal: m.ManipulationGoal, wanted: str) -> Steps[str]:
    """Reach, grasp, retract; another candidate after a miss. Returns the evidence."""
    config, planner = robot.config, planner_of(robot)
    since = robot.now - config.fresh
    tried: set[str] = set()
    widths: list[float] = []
    codes: list[str] = []
    last = Failure("UNREACHABLE", "no grasp tried")
    for _ in range(config.max_candidates):
        found = yield from _sighted(robot, goal, wanted, since)
        robot.phase = "reach"
        target = target_of(found, robot.base, robot.io.scene)
        around = obstacles(robot.io.scene, robot.base, robot.source.objects(), without=found.label)
        try:
            plan = yield from robot.work(
                plan_grab, planner, target, around, robot.joints.copy(), config.approach_distance, config.lift_height,
                config.reach, frozenset(tried),
            )  # fmt: skip
        except Failure as failure:
            raise (failure if not tried else last) from None
        options, name = planner.candidates(target), plan.grasp.name
        robot.io.publish(topics.GRASPS, shown(target, options, robot.base, robot.now, tried, name, goal.id))
        tried.add(plan.grasp.name)
        robot.io.log.info("grasp chosen", object=found.label, grasp=plan.grasp.name)
        try:
            return (yield from _execute_grab(robot, plan, goal, found, widths))
        except Failure as failure:
            if failure.code == MISTAKEN:
                robot.io.log.info("aim mistaken", detail=failure.detail, grasp=plan.grasp.name)
                tried.discard(plan.grasp.name)
                since, last = robot.now - config.fresh, failure
                continue
            if failure.code not in ("EMPTY_GRASP", "SLIPPED", "BLOCKED", BAD_HOLD, TOUCHED, TOO_HEAVY):
                raise
            last = failure
            codes.append(failure.code)
            robot.io.log.warning("grasp failed", code=failure.code, detail=failure.detail, grasp=plan.grasp.name)
            if failure.code == "BLOCKED" and robot.held is not None and holds(robot.grip, config):
                return (yield from _carry_again(robot, robot.held, around))
            robot.phase = "retract"
            robot.held = None
            yield from robot.move_gripper(0.0)
            yield from go_home(robot)
            if failure.code == TOO_HEAVY:
                raise
            if does_not_fit(codes):
                detail = f"the open fingers met the {found.label} {len(codes)} times; last: {failure.detail}"
                raise Failure(TOO_WIDE, detail) from None
            # What was seen while the hand was at work may have been half hidden by it.
            since = robot.now
    raise last


def _sighted(robot: Robot, goal: m.ManipulationGoal, wanted: str, since: float) -> Steps[WorldObject]:
    """The object to grab as it was seen after `since`; an older sighting will do when no newer one comes in time."""
    robot.phase = "look"
    end = robot.now + (robot.config.look_patience if robot.io.peer("perception") else 0.0)
    while True:
        found = robot.source.resolve(goal, wanted, robot.base, since)
        if found is not None and (found.seen_at >= since or robot.now >= end):
            return found
        if robot.now >= end:
            what = wanted or (goal.object.label if goal.object else "object")
            raise Failure("NO_OBJECT", f"no {what} is known here")
        yield


def _aimed(robot: Robot, plan: GrabPlan, goal: m.ManipulationGoal, found: WorldObject) -> Steps[GrabPlan]:
    """The plan corrected by what the wrist camera sees from in front of the object, or as it was.

    Raises:
        Failure: MISTAKEN, it was planned for a place or a side that is not the object's.
    """
    config, since = robot.config, robot.now
    if not robot.io.peer("perception") or found.tilt:
        # From so near the wrist camera sees no end of what lies.
        return plan
    robot.phase = "aim"
    seen: WorldObject | None = None
    while seen is None and robot.now - since < config.aim_patience:
        yield
        closer = robot.source.resolve(goal, found.label, robot.base, since)
        seen = closer if closer is not None and closer.label == found.label and closer.seen_at >= since else None
    if seen is None:
        return plan
    was, new = (target_of(o, robot.base, robot.io.scene) for o in (found, seen))
    shift = new.position[0] - was.position[0], new.position[1] - was.position[1]
    off, turn = math.hypot(*shift), turned(was, new) if kind_of(found.kind).shape == "box" else 0.0
    if off > config.aim_most or turn > config.aim_turn:
        raise Failure(MISTAKEN, f"{found.label} is {1000 * off:.0f} mm and {math.degrees(turn):.0f} deg from there")
    if off < config.aim_least:
        return plan
    robot.io.log.info("aim corrected", object=found.label, by_mm=round(1000 * off, 1))
    try:
        return (yield from robot.work(
            refine, planner_of(robot), plan, shift, config.approach_distance, config.lift_height
        ))  # fmt: skip
    except Failure:
        return plan


def _execute_grab(
    robot: Robot, plan: GrabPlan, goal: m.ManipulationGoal, found: WorldObject, widths: list[float]
) -> Steps[str]:
    """`widths`: of earlier bad holds [m]; one that is felt again from another side is the object's own."""
    config = robot.config
    yield from robot.move_gripper(0.0)
    yield from robot.follow(plan.reach, config.joint_speed)
    plan = yield from _aimed(robot, plan, goal, found)
    free = robot.torques.copy()
    try:
        yield from robot.follow(plan.insert, config.joint_speed * INSERTING, robot.guard(free))
        robot.phase = "grasp"
        yield from robot.move_gripper(1.0, CLOSING_EFFORT)
        yield from robot.move_gripper(1.0)
        _judge(robot, plan, None)
    except Failure:
        yield from _withdraw(robot, plan)
        raise
    closed = robot.grip
    robot.held = plan.held
    robot.phase = "retract"
    way = [plan.lift]
    try:
        weight = robot.guard(free, load_limit(config.grip_effort), lifting=True)
        yield from robot.follow(plan.lift[:WEIGHED], config.joint_speed * 0.25, weight)
        yield from robot.follow(plan.lift[WEIGHED:], config.joint_speed * 0.5)
        _judge(robot, plan, closed.width)
        _check_width(robot, plan, widths)
        way.append(plan.carry)
        yield from robot.follow(plan.carry, config.joint_speed * 0.8)
        yield from robot.wait(0.2)
        _judge(robot, plan, closed.width)
    except Failure as failure:
        if failure.code in ("SLIPPED", BAD_HOLD, TOO_HEAVY) and holds(robot.grip, config):
            yield from _set_back(robot, plan, way, free)
        raise
    robot.source.remember(plan.held.label, None, "", robot.now)
    return f"{plan.held.label} held: width {robot.grip.width * 1000:.1f} mm, force {robot.grip.force:.0f} N"


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
        guard = robot.guard(free) if path is plan.lift else None
        try:
            yield from robot.follow(back_along(path, robot.joints), robot.config.joint_speed * 0.5, guard)
        except Failure as failure:
            if failure.code != TOUCHED:
                raise
            robot.io.log.info("set back", object=plan.held.label, felt=failure.detail)
    yield from _withdraw(robot, plan)


def _check_width(robot: Robot, plan: GrabPlan, widths: list[float]) -> None:
    """A known object that has not its width between the fingers is held by something else than its body.

    Raises:
        Failure: BAD_HOLD.
    """
    held, width = plan.held, robot.grip.width
    spec = robot.io.scene.object(held.label)
    if spec is None or kind_of(held.kind).by_the_rim or not held_badly(robot.grip, plan.grasp.width, spec.kind):
        return
    if any(abs(width - other) < WIDTH_ERROR for other in widths):
        robot.io.log.warning("not as wide as it should be", object=held.label, mm=round(1000 * width, 1))
        return
    widths.append(width)
    raise Failure(BAD_HOLD, f"width {1000 * width:.1f} mm where the {held.label} has {1000 * plan.grasp.width:.1f}")


def _carry_again(robot: Robot, held: Held, around: list[Obstacle]) -> Steps[str]:
    """Something was in the way with the object in hand: another path to the carry pose, without letting go."""
    robot.forget_command()
    path = yield from robot.work(planner_of(robot).carry, held, robot.joints.copy(), around)
    yield from robot.follow(path, robot.config.joint_speed * 0.5)
    if not holds(robot.grip, robot.config):
        raise Failure("SLIPPED", f"the {held.label} was lost on the way to the carry pose")
    robot.source.remember(held.label, None, "", robot.now)
    return f"{held.label} held: width {robot.grip.width * 1000:.1f} mm, force {robot.grip.force:.0f} N"


def _judge(robot: Robot, plan: GrabPlan, at_close: float | None) -> None:
    nominal = 0.0 if kind_of(plan.held.kind).by_the_rim else plan.grasp.width
    code = judge(robot.grip, nominal, at_close, robot.config)
    if code:
        was = "" if at_close is None else f", was {at_close * 1000:.1f} mm"
        detail = f"width {robot.grip.width * 1000:.1f} mm{was}, force {robot.grip.force:.0f} N"
        raise Failure(code, detail)
