"""Plans a whole grab: a candidate grasp within reach, collision-free paths to it and away with the object."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from services.manipulation.arm_model import Array, Obstacle
from services.manipulation.contacts import new_sides_first
from services.manipulation.grasp import Grasp, Target
from services.manipulation.grasped_object import GraspedObject, attach
from services.manipulation.ik import seeds
from services.manipulation.motion_planner import PlanError, Planner, counted
from services.manipulation.planning_scene import with_object
from services.manipulation.trajectory import connect


@dataclass(frozen=True)
class GrabPlan:
    """Joint paths (lists of (7,)) of the phases, and the object as it will be attached to the hand."""

    grasp: Grasp
    reach: list[Array]
    insert: list[Array]
    lift: list[Array]
    carry: list[Array]
    grasped: GraspedObject


def plan_grab(
    planner: Planner,
    target: Target,
    around: Sequence[Obstacle],
    now: Array,
    approach: float,
    lift: float,
    reach: float,
    skip: frozenset[str],
    touched: list[Array],
) -> GrabPlan:
    """The first candidate grasp that can be reached and carried away.

    `skip` names grasps that are not tried; `touched` are rotations (3, 3) of the hand in the base frame with which the
    open fingers touched the object: grasps from other sides come first.

    Raises:
        PlanError: UNREACHABLE.
    """
    distance = float(np.hypot(target.position[0] - planner.arm.forward, target.position[1]))
    if distance > reach:
        raise PlanError("UNREACHABLE", f"{target.label} is {distance:.2f} m from the arm, reach is {reach:.2f} m")
    left = [g for g in planner.candidates(target) if g.name not in skip]
    options = [left[n] for n in new_sides_first((g.pose.rotation for g in left), touched)]
    if not options:
        raise PlanError("UNREACHABLE", f"no grasp left to try on {target.label}")
    failures: list[str] = []
    for grasp in options:
        plan = _try_grab(planner, target, grasp, around, now, approach, lift)
        if isinstance(plan, GrabPlan):
            return plan
        failures.append(plan)
    reasons = counted(failures)
    raise PlanError("UNREACHABLE", f"no reachable grasp of {target.label} at {distance:.2f} m: {reasons}")


def _try_grab(
    planner: Planner,
    target: Target,
    wanted: Grasp,
    around: Sequence[Obstacle],
    now: Array,
    approach: float,
    lift: float,
) -> "GrabPlan | str":
    arm = planner.arm
    rng = planner.rng()
    grasp = planner.clearance.clear(target, wanted)
    if grasp is None:
        return "too deep for the hand"
    own = Obstacle(target.position, target.size, target.yaw)
    arm.hold(None)
    arm.set_obstacles(around)
    at = planner.ik.solve(grasp.pose, seeds(arm, grasp.pose, now), avoid=True)
    if at is None:
        return "no IK"
    at = arm.nearest_turn(at, now)
    if arm.collides(at):
        return "grasp collides"
    back = planner.straight(at, grasp.pose, grasp.pose.moved(-approach * grasp.pose.rotation[:, 2]))
    if back is None:
        return "no straight approach"
    up = planner.straight(at, grasp.pose, grasp.pose.moved(np.array([0.0, 0.0, lift])))
    if up is None:
        return "no straight lift"
    if any(arm.collides(q) for q in back):
        return "approach collides"
    planner.surround(with_object(around, own), back[-1])
    there = connect(arm, now, back[-1], rng)
    if there is None:
        return "no path to the pre-grasp"
    attached = attach(target, grasp)
    arm.hold(*attached.box())
    planner.surround(around, up[-1])
    away = planner.to_carry(up[-1], rng)
    arm.hold(None)
    if away is None:
        return "no path to the carry pose"
    return GrabPlan(grasp, there, [at, *back][::-1], [at, *up], away, attached)


def refine(planner: Planner, plan: GrabPlan, shift: tuple[float, float], approach: float, lift: float) -> GrabPlan:
    """The same grasp of an object that stands `shift` [m] (x, y in the base frame) from where it was planned.

    Raises:
        PlanError: UNREACHABLE.
    """
    grasp = replace(plan.grasp, pose=plan.grasp.pose.moved(np.array([*shift, 0.0])))
    planner.arm.hold(None)
    at = planner.ik.solve(grasp.pose, [plan.insert[-1]])
    if at is not None:
        back = planner.straight(at, grasp.pose, grasp.pose.moved(-approach * grasp.pose.rotation[:, 2]))
        up = planner.straight(at, grasp.pose, grasp.pose.moved(np.array([0.0, 0.0, lift])))
        if back is not None and up is not None and not any(planner.arm.collides(q) for q in (at, *back)):
            return replace(plan, grasp=grasp, insert=[at, *back][::-1], lift=[at, *up])
    raise PlanError("UNREACHABLE", "the corrected grasp is out of reach")
