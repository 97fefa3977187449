"""A grab of what only fits between the fingers over an edge: it is pulled there first."""

import numpy as np
from msgspec import structs

from common import messages as m
from common.floor_plan import Receptacle
from common.geometry import Array, Pose2, compose, yaw_quat
from common.household import Household
from common.messages import WorldObject
from services.manipulation.arm.touch import TOUCHED
from services.manipulation.execution.grasp_executor import TOO_WIDE
from services.manipulation.execution.neighbours import grab_with_room, reference
from services.manipulation.execution.recovery import go_home
from services.manipulation.execution.robot import Failure, Robot, Steps, planner_of
from services.manipulation.grasps.over_edge import flat_and_wide
from services.manipulation.planning.motion_planner import Planner
from services.manipulation.planning.overhang import LET_GO, Pull, can_pull, plan_pull
from services.manipulation.planning.planning_scene import MARGINS, obstacles, target_of
from services.manipulation.planning.stances import stances
from services.manipulation.planning.surface_edge import facing_edge

PULLING = 0.25
"""Share of the joint speed with which an object is pulled: some 8 cm/s, at which it stops with the fingers."""


MOST = 30.0
"""Force [N] on the hand from which what is pulled is stuck. Chosen: 1 kg on a surface with friction 1, pressed on by a
hand that leans, takes 20."""


NEAR = (0.45,)
"""Distance [m] from the base's middle to an object that is pulled, if its edge lets the base so near."""
MOST_STANCES = 5
"""Stances that are tried."""


def grab_or_pull(robot: Robot, goal: m.ManipulationGoal, wanted: str) -> Steps[str]:
    """Grab; what is too wide as it lies is pulled over the edge that the robot stands before, and grabbed there.

    Raises:
        Failure: as a grab; TOO_WIDE also where it cannot be pulled to an edge.
    """
    try:
        return (yield from grab_with_room(robot, goal, wanted))
    except Failure as failure:
        if failure.code not in (TOO_WIDE, "UNREACHABLE") or failure.stance is not None:
            raise
        found = yield from _pull(robot, goal, wanted, failure)
    here = m.ManipulationGoal(goal=goal.goal, id=goal.id, attempt=goal.attempt, object=reference(found), to=goal.to)
    evidence = yield from grab_with_room(robot, here, wanted)
    return f"{evidence}; pulled over the edge first"


def _pull(robot: Robot, goal: m.ManipulationGoal, wanted: str, failure: Failure) -> Steps[WorldObject]:
    """Pull the object of a goal over the edge. Returns it as it lies then.

    Raises:
        Failure: the one that it was to mend, when there is no way to do so; UNREACHABLE with another stance.
    """
    found = robot.source.resolve(goal, wanted, robot.base, robot.now - robot.config.fresh)
    surface = robot.io.household.receptacle(found.on) if found is not None else None
    if found is None or surface is None or surface.depth:
        raise failure
    household, planner = robot.io.household, planner_of(robot)
    target, edge = target_of(found, robot.base, household), facing_edge(surface, robot.base)
    if edge is None or not flat_and_wide(target, planner.arm.widest):
        raise failure
    robot.phase = "reach"
    others = robot.source.objects()
    around = obstacles(household, robot.base, others, found.label, MARGINS[1])
    now, lift = robot.joints.copy(), robot.config.lift_height
    try:
        plan = yield from robot.work(plan_pull, planner, target, edge, around, now, lift)
    except Failure as other:
        robot.io.log.info("not pulled", object=found.label, code=other.code, detail=other.detail)
        if other.blockers or other.code == TOO_WIDE:
            raise failure from None
        stance = yield from robot.work(_stance, planner, household, found, surface, others, robot.base, now)
        if stance is None:
            raise failure from None
        detail = f"{failure.detail}; it can be pulled to the edge from ({stance[0]:.2f}, {stance[1]:.2f})"
        raise Failure("UNREACHABLE", detail, stance=stance) from None
    robot.io.log.info("pulling over the edge", object=found.label, by_mm=round(1000 * edge.inset(*target.position[:2])))
    return (yield from _execute(robot, plan, found))


def _stance(
    planner: Planner, household: Household, found: WorldObject, surface: Receptacle, others: list[WorldObject],
    base: Pose2, now: Array,
) -> Pose2 | None:  # fmt: skip
    """Where the base has to stand to pull an object to the edge; None if the present place is as good as any."""
    for pose in stances(household, found, [base], NEAR)[:MOST_STANCES]:
        edge = facing_edge(surface, pose)
        around = obstacles(household, pose, others, found.label, MARGINS[1])
        if edge is not None and can_pull(planner, target_of(found, pose, household), edge, around, now):
            return pose
    return None


def _execute(robot: Robot, plan: Pull, found: WorldObject) -> Steps[WorldObject]:
    speed, hand = robot.config.joint_speed, planner_of(robot).arm.hand
    yield from robot.move_gripper(hand.share(plan.opening))
    yield from robot.travel(plan.reach)
    free = yield from robot.at_rest()
    stuck: Failure | None = None
    try:
        yield from robot.follow(plan.lower, speed * 0.5, robot.guard(free))
        robot.phase = "pull"
        yield from robot.follow(plan.pull, speed * PULLING, robot.guard(free, MOST))
    except Failure as failure:
        robot.io.log.warning("while pulling", code=failure.code, detail=failure.detail, phase=robot.phase)
        if failure.code != TOUCHED:
            raise
        stuck = failure
        robot.forget_command()
    if robot.phase == "pull":
        found = _remember(robot, plan, found)
    if stuck is None:
        try:
            yield from robot.follow(plan.leave, speed * 0.5)
            yield from robot.travel(plan.home)
        except Failure as failure:
            # It lies where it was pulled to; another way home from here.
            robot.io.log.warning("on the way home", code=failure.code, detail=failure.detail)
            robot.forget_command()
            yield from go_home(robot)
    else:
        yield from _leave(robot)
    yield from robot.move_gripper(0.0)
    if robot.phase != "pull":
        raise stuck or Failure(TOUCHED, "on the way down behind it")
    return found


def _remember(robot: Robot, plan: Pull, found: WorldObject) -> WorldObject:
    """The object lies against the fingers, wherever these are on their way."""
    nearest = int(np.argmin([np.abs(q - robot.joints).max() for q in plan.pull]))
    x, y, yaw = compose(robot.base, plan.line[nearest])
    place = (x, y, found.position[2])
    moved = structs.replace(found, position=place, orientation=yaw_quat(yaw), points=b"", seen_at=robot.now)
    robot.source.moved(found, moved)
    return moved


def _leave(robot: Robot) -> Steps[None]:
    """From where the fingers met something: back by a little, upwards, home."""
    planner, now = planner_of(robot), robot.joints.copy()
    here = planner.arm.pose(now)
    away = here.rotation[:, 2] * (1.0, 1.0, 0.0) * LET_GO + (0.0, 0.0, LET_GO)
    back = planner.straight(now, here, here.moved(away)) or [now]
    here = planner.arm.pose(back[-1])
    up = planner.straight(back[-1], here, here.moved(np.array([0.0, 0.0, robot.config.lift_height]))) or []
    yield from robot.follow([*back, *up], robot.config.joint_speed * 0.5)
    yield from go_home(robot)
