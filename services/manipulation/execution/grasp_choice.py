"""The choice of a grasp, after which the object can be put down as it is to stand: from here or from another stance."""

from collections.abc import Collection

import numpy as np

from common.geometry import Array
from common.kinds import kind_of
from common.messages import WorldObject
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.execution.robot import Failure, Robot, Steps, planner_of
from services.manipulation.grasps.grasp import Grasp, is_poor
from services.manipulation.grasps.target import Target
from services.manipulation.planning.plan_grab import GrabPlan, plan_grab
from services.manipulation.planning.planning_scene import MARGINS, obstacles, others
from services.manipulation.planning.stances import other_stance


def chosen(
    robot: Robot,
    found: WorldObject,
    target: Target,
    around: list[list[Obstacle]],
    tried: Collection[Grasp],
    touched: list[Array],
    to: str = "",
) -> Steps[GrabPlan]:
    """The plan of a grasp that is not among those `tried`; `target`, `around`, `touched`: as in `plan_grab`.

    It is taken so that it can be put down on the receptacle `to`. What lies is taken so that it can be stood up, there
    or where things are brought. Where that cannot be from here, or only with a poor hold, the base is sent elsewhere,
    once; after that, or where no stance is better, it is taken so that it can be laid down, and held as it can be.

    Raises:
        Failure: as `plan_grab`; with the stance from which there is a grasp, where there is one.
    """
    config, height = robot.config, _stands_on(robot, found, target, to)
    failure = Failure("UNREACHABLE", "")
    for stand_on in (height, None) if height is not None else (None,):
        try:
            plan = yield from robot.work(
                plan_grab, planner_of(robot), target, around, robot.joints.copy(), config.approach_distance,
                config.lift_height, config.reach, tried, touched, stand_on,
            )  # fmt: skip
        except Failure as other:
            failure = other
        else:
            if is_poor(plan.grasp) and not tried and found.label not in robot.sent_to:
                poor = Failure("UNREACHABLE", f"the {found.label} is hardly held from here")
                yield from look_elsewhere(robot, found, poor, stand_on, target)
            return plan
        if failure.code != "UNREACHABLE":
            raise failure
        if not tried and (stand_on is None or (target.lies and found.label not in robot.sent_to)):
            yield from look_elsewhere(robot, found, failure, stand_on)
    raise failure


def _stands_on(robot: Robot, found: WorldObject, target: Target, to: str) -> float | None:
    """Height [m] of the surface on which it will have to be put down, as far as is known; None where that is of no
    interest: in a bin, and of what does not lie unless it was said to what.

    What lies is brought to the delivery surface, unless somebody says otherwise later.
    """
    household = robot.io.household
    surface = household.receptacle(to)
    if surface is None and target.lies and kind_of(target.kind).upright:
        surface = household.receptacle(household.delivery) or household.receptacle(found.on)
    return surface.center[2] if surface is not None and not surface.depth else None


def look_elsewhere(
    robot: Robot, found: WorldObject, failure: Failure, stand_on: float | None = None, seen: Target | None = None
) -> Steps[None]:
    """Return where no other stance helps; `seen`: the target of which a good grasp is wanted.

    Raises:
        Failure: the one to plan a grasp, with where the base would have to stand for one.
    """
    config, objects, told = robot.config, robot.source.objects(), robot.sent_to.pop(found.label, [])
    stance = yield from robot.work(
        other_stance, planner_of(robot), robot.io.household, found, objects, [robot.base, *told], robot.joints.copy(),
        config.approach_distance, config.lift_height, config.reach, stand_on, seen,
    )  # fmt: skip
    if stance is None:
        return
    robot.sent_to[found.label] = [*told, stance]
    where = f"within reach from ({stance[0]:.2f}, {stance[1]:.2f}), facing {np.degrees(stance[2]):.0f} deg"
    raise Failure(failure.code, f"{failure.detail}; {where}", failure.blockers, stance)


def surroundings(robot: Robot, found: WorldObject) -> list[list[Obstacle]]:
    """What the arm keeps clear of, with each of the margins, but for an object."""
    objects = others(robot.source.objects(), found)
    return [obstacles(robot.io.household, robot.base, objects, margin=margin) for margin in MARGINS]
