"""Place executor: the grasped object is set on a receptacle or where there is room; the hand opens when it stands."""

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from msgspec.structs import replace

from common.floor_plan import Receptacle
from common.geometry import Array, compose, to_frame
from common.messages import ObjectRef, WorldObject
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.arm.touch import BLOCKED, HIT, TOUCHED
from services.manipulation.arm.trajectory import back_along
from services.manipulation.execution.recovery import go_home
from services.manipulation.execution.releasing import STUCK, let_go
from services.manipulation.execution.robot import SLOWLY, Failure, Robot, Steps, planner_of
from services.manipulation.execution.setting_down import press_down, probe, set_down
from services.manipulation.grasps.grasp import approach_rotation
from services.manipulation.grasps.grasped_object import USUAL_SIZE, GraspedObject
from services.manipulation.grasps.sagging import sagged
from services.manipulation.planning.edge_spots import Placement, edge_spots
from services.manipulation.planning.lift import straight_up
from services.manipulation.planning.plan_place import DEEPEST, DROP, PlacePlan, plan_place, plan_placements
from services.manipulation.planning.planning_scene import ELSEWHERE, bin_spots, obstacles, spots
from services.manipulation.planning.surface_edge import facing_edge

Plan = Callable[..., PlacePlan]
"""Plans a placement among the obstacles around, from joints (7,)."""
FLOOR_SPOTS = ((0.48, 0.0), (0.48, 0.2), (0.48, -0.2))
"""Where things are put on the floor, from the arm's first joint [m]: in front of the base and clear of it."""
BIN_DROP = 0.06
"""Height [m] above a bin's rim at which the hand lets go. Chosen: the fingers stay clear of the rim."""
ACCESS = 0.08
"""Least free space [m] around an object that is to be left accessible: the breadth of the hand, open."""
FLUSH = 0.008
"""Height [m] above the end of the way down up to which it stands as it was believed to. Chosen: less than the
centimetre of fall that counts as dropped."""
STANDS, ASKEW = 0.03, 0.3
"""Height [m] above the end of the way down at which what is met is what the object is put on: it may have slid so far
down in the hand, or have been taken so far above its foot. What is held at its rim hangs askew by a share of its
breadth. Chosen: 17 degrees."""


def place(robot: Robot, where: str, beside: ObjectRef | None = None, away_from: str = "") -> Steps[str]:
    """Set the held object down on a receptacle, or with "" on the delivery surface or whatever is in reach.

    `beside`: the object, in frame map, next to which; where it was seen last counts more. `away_from`: the label of one
    that is to be left accessible.
    """
    household = robot.io.household
    held = robot.grasped or _unknown(robot)
    robot.phase = "place"
    stances = [held, held.as_found] if held.as_found is not None else [held]
    known = [o for o in robot.source.objects() if o.label != held.label]
    names = [where] if where else [household.delivery, *(r.name for r in household.receptacles if not r.depth)]
    anchor = next((o for o in known if beside and o.label == beside.label), beside)
    choices: list[tuple[GraspedObject, str, float, Plan]] = []
    planner = planner_of(robot)
    for stance in stances:
        for name in dict.fromkeys(names):
            r = household.receptacle(name)
            if r is None:
                continue
            surface, drop = (r.depth, BIN_DROP) if r.depth else (r.center[2], DROP)
            # What lies takes up more room than when it stands.
            free = untried_first(robot, free_spots(robot, r, max(stance.size[:2]), held.label, anchor, away_from))
            plans = [partial(plan_place, planner, stance, free, surface, drop)] if free else []
            if anchor is None and (over := _over_edge(robot, r, stance)):
                # A hand that is level has its knuckles in the surface, wherever else it sets down what it holds.
                plans.insert(0 if stance.level else 1, partial(plan_placements, planner, stance, over, surface + DROP))
            choices += [(stance, r.name, surface, plan) for plan in plans]
        if not where:
            on_floor = [(planner.arm.forward + x, y) for x, y in FLOOR_SPOTS]
            choices.append((stance, "floor", 0.0, partial(plan_place, planner, stance, on_floor, 0.0, DROP)))
    if not choices:
        near = f" next to the {anchor.label}" if anchor else ""
        raise Failure("UNREACHABLE", f"no free spot of the {where}{near} is within reach from here")
    first: Failure | None = None
    for held, name, surface, planned in choices:
        try:
            plan = yield from robot.work(planned, _around(robot, held, name), robot.joints.copy())
        except Failure as failure:
            # Why not where it belongs; that it cannot stand on the floor either is of no interest.
            first = first or failure
            continue
        return (yield from _execute_place(robot, plan, held, name, surface))
    raise first or Failure("UNREACHABLE", "nothing within reach")


def place_back(robot: Robot, found: WorldObject) -> Steps[str]:
    """Set the held object down where, and as, it was found.

    Raises:
        Failure: as `place`; UNREACHABLE also where nothing is known that it rested on.
    """
    held, surface = robot.grasped or _unknown(robot), robot.io.household.receptacle(found.on)
    if surface is None or surface.depth:
        raise Failure("UNREACHABLE", f"it is not known what the {held.label} was taken from")
    robot.phase = "place"
    held = held.as_found or held
    spot = to_frame(robot.base, (found.position[0], found.position[1]))
    around, now, height = _around(robot, held, surface.name), robot.joints.copy(), surface.center[2]
    plan = yield from robot.work(plan_place, planner_of(robot), held, [spot], height, DROP, around, now)
    return (yield from _execute_place(robot, plan, held, surface.name, height))


def _over_edge(robot: Robot, r: Receptacle, held: GraspedObject) -> list[Placement]:
    """Placements over the edge of a surface that the robot stands before, of what is held from below."""
    edge = facing_edge(r, robot.base) if held.from_below and not r.depth else None
    if edge is None:
        return []
    known = [o for o in robot.source.objects() if o.label != held.label and not o.held]
    taken = [(*to_frame(robot.base, (o.position[0], o.position[1])), max(o.size[:2]) / 2) for o in known]
    return edge_spots(held, edge, taken, planner_of(robot).arm.forward)


def free_spots(
    robot: Robot,
    r: Receptacle,
    footprint: float,
    label: str,
    anchor: WorldObject | ObjectRef | None = None,
    away_from: str = "",
) -> list[tuple[float, float]]:
    """Free points of a receptacle in the base frame for the object of that label, `footprint` [m] across."""
    known = [o for o in robot.source.objects() if o.label != label]
    if r.depth and anchor is None:
        return bin_spots(r, robot.base, (o for o in known if o.on == r.name), planner_of(robot).arm.forward)
    wider = [(o.size[0] + 2 * ACCESS, o.size[1] + 2 * ACCESS, o.size[2]) for o in known]
    taken = [replace(o, size=size) if o.label == away_from else o for o, size in zip(known, wider, strict=True)]
    return spots(r, robot.base, footprint, taken, planner_of(robot).arm.forward, anchor)


def untried_first(robot: Robot, free: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Spots in the base frame, those on the way to which something was met last: the same way leads into it again."""

    def tried(spot: tuple[float, float]) -> bool:
        x, y, _ = compose(robot.base, (*spot, 0.0))
        return any(math.dist((x, y), other) < ELSEWHERE for other in robot.met_before)

    return sorted(free, key=tried)


def _around(robot: Robot, held: GraspedObject, where: str) -> list[Obstacle]:
    """What the arm must not touch while it puts something down; what lies in a bin may be covered."""
    r = robot.io.household.receptacle(where)
    inside = where if r is not None and r.depth else None
    objects = [o for o in robot.source.objects() if o.on != inside]
    return obstacles(robot.io.household, robot.base, objects, without=held.label, margin=0.0)


def _execute_place(robot: Robot, plan: PlacePlan, held: GraspedObject, name: str, surface: float) -> Steps[str]:
    x, y, _ = compose(robot.base, (*plan.spot, 0.0))
    try:
        yield from robot.travel(plan.reach, 0.8)
    except Failure as failure:
        if failure.code == BLOCKED:
            robot.met_before.append((x, y))
        raise
    robot.met_before.clear()
    if robot.grip.empty:
        robot.grasped = None
        raise Failure("SLIPPED", f"the {held.label} was lost on the way")
    receptacle = robot.io.household.receptacle(name)
    yield from lower(robot, plan, held, falls=receptacle is not None and receptacle.depth > 0)
    yield from robot.wait(0.2)
    try:
        yield from let_go(robot, plan.retreat, held)
        robot.grasped = None
        yield from robot.move_gripper(0.0)
        yield from robot.travel(plan.home)
    except Failure as failure:
        if failure.code == STUCK:
            raise
        # The object stands; another way home from here.
        robot.io.log.warning("on the way home", code=failure.code, detail=failure.detail)
        robot.grasped = None
        robot.forget_command()
        yield from go_home(robot)
    robot.source.remember(held.label, (x, y, surface + held.size[2] / 2), name, robot.now)
    return f"{held.label} on the {name}, gripper open at {robot.grip.width * 1000:.0f} mm"


def lower(robot: Robot, plan: PlacePlan, held: GraspedObject, falls: bool) -> Steps[None]:
    """Down until it stands: it is felt to, a little before the end of the way or beyond it, or the hand itself is on
    the surface. What `falls` into a bin is let go at the end of the way.

    What touches its surface too early has turned, or slid, in the hand: it is pressed on gently, which turns it back.

    Raises:
        Failure: BLOCKED, it met something far too high, where `robot.grasped` hangs as that tells if it may have turned
            so far; NOT_MET, nothing where its surface should be.
    """
    rest, deeper = (yield from robot.at_rest()), [] if falls else plan.deeper
    above = yield from _met(robot, plan, set_down(robot, plan.lower, robot.guard(rest)))
    if above is None and falls:
        return
    if above is None:
        above = yield from _met(robot, plan, probe(robot, deeper, rest))
        if above is None and not plan.grounded:
            raise Failure("NOT_MET", f"the {held.label} met nothing where it should stand, nor {DEEPEST:.2f} m below")
    elif above > FLUSH:
        most = STANDS + (ASKEW * max(held.size[:2]) if held.at_rim else 0.0)
        turned = sagged(held, above) if above > most else None
        if turned is None:
            robot.io.log.info("pressed on", object=held.label, above_mm=round(1000 * above, 1))
            path = [*back_along(plan.lower[::-1], robot.joints), *deeper]
            above = (yield from _met(robot, plan, press_down(robot, path, rest))) or 0.0
        if above > most:
            robot.grasped = turned or robot.grasped
            yield from _take_up(robot, rest)
            raise Failure(BLOCKED, f"the {held.label} met something {1000 * above:.0f} mm too high")
    robot.io.log.info("set down", object=held.label, above_mm=above and round(1000 * above, 1))


def _met(robot: Robot, plan: PlacePlan, way: Steps[None]) -> Steps[float | None]:
    """How far [m] above the end of the way down something was felt on a way, None where nothing was.

    Raises:
        Failure: as `Robot.follow`, but for TOUCHED.
    """
    try:
        yield from way
    except Failure as failure:
        if failure.code != TOUCHED:
            raise
        feel = planner_of(robot).reaction
        return float(feel.position(robot.joints)[2] - feel.position(plan.lower[-1])[2])
    return None


def _take_up(robot: Robot, rest: Array) -> Steps[None]:
    """Off what is met, so that the next attempt begins where it touches nothing."""
    ways = yield from robot.work(straight_up, planner_of(robot), robot.joints.copy(), robot.config.lift_height)
    if ways:
        yield from robot.follow(ways[0], robot.config.joint_speed * SLOWLY, robot.guard(rest, HIT, "up"))


def _unknown(robot: Robot) -> GraspedObject:
    """Something is in the gripper that a former process grasped: assume it hangs straight down from the hand."""
    name = next((o.label for o in robot.source.objects() if o.held), "object")
    size = next((o.size for o in robot.source.objects() if o.held), USUAL_SIZE)
    offset = np.array([0.0, 0.0, size[2] / 2])
    return GraspedObject(name, "", approach_rotation(0.0, np.pi / 2), offset, size, robot.grip.width, 0.0)
