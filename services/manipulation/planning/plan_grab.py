"""Plans a whole grab: a candidate grasp within reach, collision-free paths to it and away with the object."""

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from common.geometry import Array
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.arm.contacts import new_sides_first
from services.manipulation.arm.trajectory import Leg, connect
from services.manipulation.grasps.antipodal import alike
from services.manipulation.grasps.grasp import Grasp, certainly_too_wide
from services.manipulation.grasps.grasp_verification import MEASURED
from services.manipulation.grasps.grasped_object import GraspedObject, attach
from services.manipulation.grasps.target import Target
from services.manipulation.planning.lift import over_neighbours
from services.manipulation.planning.motion_planner import PlanError, Planner, counted
from services.manipulation.planning.planning_scene import with_object
from services.manipulation.planning.straight_grab import Miss, Way, opening_of, straight_parts, with_fingers

BESIDE = 0.02
"""Distance [m] from where a grasp failed up to which others come last. Chosen: a pad's width."""


@dataclass(frozen=True)
class GrabPlan:
    """Joint paths (lists of (7,), or legs) of the phases, and the object as it will be attached to the hand.

    `opening` [m]: how far apart the fingers are on the way in, None as far as they go; `around`: what is kept clear of;
    `options`: the grasps that were considered; `doubt` [m]: how far off the width between the pads may be.
    """

    grasp: Grasp
    reach: list[Leg]
    insert: list[Array]
    lift: list[Array]
    carry: list[Leg]
    grasped: GraspedObject
    opening: float | None = None
    around: Sequence[Obstacle] = ()
    options: tuple[Grasp, ...] = ()
    doubt: float = 0.0


def plan_grab(
    planner: Planner,
    target: Target,
    around: Sequence[Sequence[Obstacle]],
    now: Array,
    approach: float,
    lift: float,
    reach: float,
    skip: Collection[Grasp],
    touched: list[Array],
    stand_on: float | None = None,
) -> GrabPlan:
    """The first candidate grasp that can be reached and carried away.

    `around`: what is not to be touched, with the widest margins first. With each of them every grasp is tried with the
    fingers wide open, then those that met something with them partly closed.

    `skip`: grasps that are not tried, relative to the object's place; `touched` are rotations (3, 3) of the hand in the
    base frame with which the open fingers touched the object: grasps from other sides come first. `stand_on`: as in
    `Way`.

    Raises:
        PlanError: UNREACHABLE; TOO_WIDE, there is no grasp of it at all and the measures are certain.
    """
    place, target = np.array(target.position), planner.believed(target)
    distance = float(np.hypot(target.position[0] - planner.arm.forward, target.position[1]))
    if distance > reach:
        raise PlanError("UNREACHABLE", f"{target.label} is {distance:.2f} m from the arm, reach is {reach:.2f} m")
    misses: dict[str, Miss] = {}
    tried: list[Grasp] = []
    options: list[Grasp] = []

    def attempt(some: Sequence[Grasp], way: Way) -> GrabPlan | None:
        for grasp in some:
            plan = with_fingers(planner, target, grasp, way, now, whole_grab)
            if isinstance(plan, GrabPlan):
                return replace(plan, options=tuple(options))
            misses[grasp.name] = plan
        return None

    ways = [Way(solids, shaped, approach, lift, stand_on) for solids in around for shaped in (False, True)]
    for stage in planner.candidates(target):
        options += stage
        left = [g for g in stage if not any(same_hold(from_place(g, place), other) for other in skip)]
        left = [left[n] for n in new_sides_first((g.pose.rotation for g in left), touched)]
        left.sort(key=lambda g: any(g.on_surface and _beside(from_place(g, place), other) for other in skip))
        tried += left
        if plan := attempt(left, ways[0]):
            return plan
    for way in ways[1:]:
        # Where nothing was met neither a narrower hand nor a smaller margin helps.
        if plan := attempt([g for g in tried if misses[g.name].met], way):
            return plan
    on_it = all(g.over_edge and "" in misses[g.name].met for g in tried)
    if on_it and certainly_too_wide(target, planner.arm.widest) and not skip:
        raise PlanError("TOO_WIDE", f"{_in_mm(target)}, at most {1000 * planner.arm.widest:.0f} mm go into the hand")
    if not tried:
        raise PlanError("UNREACHABLE", f"no grasp left to try on {target.label}")
    reasons = counted(miss.reason for miss in misses.values())
    blockers = Counter(label for miss in misses.values() for label in sorted(miss.met) if label)
    names = [label for label, _ in blockers.most_common()]
    behind = f"; in the way: {', '.join(names)}" if names else ""
    raise PlanError(
        "UNREACHABLE", f"no reachable grasp of {target.label} at {distance:.2f} m: {reasons}{behind}", names
    )


def from_place(grasp: Grasp, place: Array) -> Grasp:
    """A grasp relative to where its object is (3,) [m]: it is the same one when that has been moved."""
    return replace(grasp, pose=grasp.pose.moved(-place))


def _beside(one: Grasp, other: Grasp) -> bool:
    """What slipped out at a place of its surface does so from there whichever way the hand comes."""
    return other.on_surface and float(np.linalg.norm(one.pose.position - other.pose.position)) < BESIDE


def same_hold(one: Grasp, other: Grasp) -> bool:
    """Two grasps take hold of an object in the same way: by the same rule, or at about the same place of its surface,
    which is called otherwise once it was measured anew.
    """
    return one.name == other.name or (one.on_surface and other.on_surface and alike(one.pose, other.pose))


def _in_mm(target: Target) -> str:
    x, y, z = (1000 * v for v in target.size)
    return f"{target.label} measures {x:.0f} x {y:.0f} x {z:.0f} mm"


def whole_grab(planner: Planner, target: Target, grasp: Grasp, way: Way, now: Array) -> "GrabPlan | Miss":
    """One grasp with the ways to it and to the carry pose; or why there is none."""
    lines = straight_parts(planner, target, grasp, way, now)
    if isinstance(lines, Miss):
        return lines
    arm, around = planner.arm, way.around
    at, back, up = lines.at, lines.back, lines.up
    arm.open_fingers()
    everything = with_object(around, target.grown(0.0))
    planner.surround(everything, back[-1], [now])
    there = connect(arm, now, back[-1], planner.rng())
    if there is None:
        return Miss("no path to the pre-grasp")
    reach = planner.legs(there, everything)
    attached = attach(target, grasp)
    arm.hold(*attached.box())
    up += over_neighbours(planner, target, grasp, around, up[-1], lines.lift)
    away = planner.to_carry(attached, up[-1], around)
    if away is None:
        return Miss("no path to the carry pose")
    opening, doubt = opening_of(planner, grasp, way), MEASURED + 2 * target.spread
    return GrabPlan(
        grasp, reach, [at, *back][::-1], [at, *up], away, attached, opening, around,
        doubt=doubt if target.measured or grasp.on_surface else 0.0,
    )  # fmt: skip


def refine(planner: Planner, plan: GrabPlan, shift: tuple[float, float]) -> GrabPlan:
    """The same grasp of an object that stands `shift` [m] (x, y in the base frame) from where it was planned.

    Raises:
        PlanError: UNREACHABLE.
    """
    grasp = replace(plan.grasp, pose=plan.grasp.pose.moved(np.array([*shift, 0.0])))
    arm = planner.arm
    arm.hold(None)
    arm.set_obstacles(plan.around)
    arm.open_fingers(plan.opening)
    try:
        at = planner.ik.solve(grasp.pose, [plan.insert[-1]])
        if at is not None:
            begin, end = (arm.pose(q).position - plan.grasp.pose.position for q in (plan.insert[0], plan.lift[-1]))
            back = planner.straight(at, grasp.pose, grasp.pose.moved(begin))
            up = planner.straight(at, grasp.pose, grasp.pose.moved(np.array([0.0, 0.0, end[2]])))
            if (
                back is not None
                and up is not None
                and not (any(arm.collides(q) for q in (at, *back)) or arm.meets_itself(up))
            ):
                return replace(plan, grasp=grasp, insert=[at, *back][::-1], lift=[at, *up])
    finally:
        arm.open_fingers()
    raise PlanError("UNREACHABLE", "the corrected grasp is out of reach")
