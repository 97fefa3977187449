"""Plans a whole placement: the first spot and turn where what is held can be set down and left standing."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from common.geometry import Array
from services.manipulation.arm.arm_model import Obstacle, Pose
from services.manipulation.arm.ik import seeds
from services.manipulation.arm.trajectory import Leg, connect
from services.manipulation.grasps.grasped_object import GraspedObject
from services.manipulation.planning.edge_spots import Placement
from services.manipulation.planning.motion_planner import PlanError, Planner, counted
from services.manipulation.planning.planning_scene import EASY, SLAB, with_object
from services.manipulation.planning.put_down import LEANS, TURNS, PutDown, tipped, turned

FINGER = 0.018
"""Height [m] of a fingertip below what it holds at a slant (Robotiq 2F-85)."""

ABOVE = (0.08, 0.04)
"""How far [m] above the spot the straight way down begins, in the order of trying."""
DROP = 0.004
"""Height [m] above a surface at which the way down ends. Chosen: the error of the surface's measured height."""
DEEPER, DEEPEST = 0.005, 0.06
"""Step and length [m] of the way on down where nothing is felt. Chosen: half of the centimetre of fall that counts as
dropped; the underside of a lying mug was measured 25 mm too low, with as much again to spare."""
NO_IK = "no IK"
"""Why not: the hand does not come there."""
NEARER = 0.1
"""How much nearer [m] than easy the arm comes higher, and a base still stands before the surface."""
AMPLE = 0.4
"""Extents [m] of a surface that reaches as far as the hand around what it puts down, and not to the robot's base."""


@dataclass(frozen=True)
class PlacePlan:
    """Joint paths of the phases, or legs, and where the object will stand (x, y in the base frame).

    `deeper` goes on from the end of `lower` where nothing was felt until there; `grounded`: at its end the hand itself
    is on the surface.
    """

    reach: list[Leg]
    lower: list[Array]
    deeper: list[Array]
    grounded: bool
    retreat: list[Array]
    home: list[Leg]
    spot: tuple[float, float]


def plan_place(
    planner: Planner,
    held: GraspedObject,
    spots: Sequence[tuple[float, float]],
    surface: float,
    drop: float,
    around: Sequence[Obstacle],
    now: Array,
) -> PlacePlan:
    """Set the held object down on the first spot of a surface that works, `drop` above it, and a finger more above it
    where one is below what is held: turned about the vertical, or else tipped as far as it may fall back.

    Raises:
        PlanError: UNREACHABLE.
    """
    height = surface + drop + (FINGER if held.from_below else 0.0)
    bearings = [(spot, math.atan2(spot[1], spot[0] - planner.arm.forward)) for spot in spots[:10]]
    poses = [turned(held, spot, bearing + turn) for spot, bearing in bearings for turn in TURNS]
    poses += [pose for lean in LEANS for spot, bearing in bearings for pose in tipped(held, spot, bearing, lean)]
    return _first(planner, held, poses, height, around, now)


def plan_placements(
    planner: Planner,
    held: GraspedObject,
    placements: Sequence[Placement],
    height: float,
    around: Sequence[Obstacle],
    now: Array,
) -> PlacePlan:
    """Let go of the held object at the first placement that works, its underside at a height [m].

    Raises:
        PlanError: UNREACHABLE.
    """
    return _first(planner, held, [turned(held, *placement) for placement in placements], height, around, now)


def _first(
    planner: Planner,
    held: GraspedObject,
    poses: Sequence[PutDown],
    height: float,
    around: Sequence[Obstacle],
    now: Array,
) -> PlacePlan:
    """The first that works; tipped only where the hand does not come to as it grasped."""
    rng = planner.rng()
    failures: list[str] = []
    reached: set[tuple[float, float]] = set()
    planner.arm.open_fingers(held.opening)
    try:
        for pose in poses:
            if pose.raised and pose.spot in reached:
                continue
            plan = _try_place(planner, held, pose, height, around, now, rng)
            if isinstance(plan, PlacePlan):
                return plan
            failures.append(plan)
            if plan != NO_IK:
                reached.add(pose.spot)
    finally:
        planner.arm.open_fingers()
    reasons = counted(failures) or "no free spot within reach"
    raise PlanError("UNREACHABLE", f"cannot put {held.label} there: {reasons}")


def _try_place(
    planner: Planner,
    held: GraspedObject,
    pose: PutDown,
    height: float,
    around: Sequence[Obstacle],
    now: Array,
    rng: np.random.Generator,
) -> "PlacePlan | str":
    arm = planner.arm
    arm.set_obstacles(around)
    way = _set_down(planner, held, pose, height, now)
    if isinstance(way, str):
        return way
    high, down = way.high, way.down
    reach = planner.bring(held, now, high, around, way.rise)
    if not reach:
        return "no path"
    stands = Obstacle((*pose.spot, height + held.size[2] / 2), held.size, held.yaw + pose.spin)
    beside = with_object(around, stands)
    back = _leave(planner, held, way, beside)
    if back is None:
        return "no way back"
    goal = arm.nearest_turn(arm.home, back[-1])
    planner.surround(beside, back[-1], [goal])
    home = connect(arm, back[-1], goal, rng)
    if home is None:
        return "no path home"
    home_way = planner.legs(home, beside)
    deeper, grounded = _deeper(planner, way, around)
    return PlacePlan(reach, [high, *down], deeper, grounded, [down[-1], *back], home_way, pose.spot)


@dataclass(frozen=True)
class _Down:
    """The hand's pose where it lets go, `high` (7,) above it by `rise` [m], the straight way `down` from there."""

    target: Pose
    high: Array
    down: list[Array]
    rise: float


def _set_down(planner: Planner, held: GraspedObject, pose: PutDown, height: float, now: Array) -> "_Down | str":
    """The straight way down to a spot among the arm's obstacles, its underside at a height [m] there."""
    arm, turn = planner.arm, pose.turn
    middle = np.array([0.0, 0.0, held.size[2] / 2])
    at = np.array([*pose.spot, height + pose.raised]) + middle + turn @ (held.offset - middle)
    target, why = Pose(at, turn @ held.rotation), ""
    for rise in ABOVE:
        above = target.moved(np.array([0.0, 0.0, rise]))
        arm.hold(None)
        high = planner.ik.solve(above, seeds(arm, above, now))
        if high is None:
            why = why or NO_IK
            continue
        high = arm.nearest_turn(high, now)
        down = planner.straight(high, above, target)
        if down is None:
            why = "no straight way down"
            continue
        if any(arm.collides(q) for q in down):
            return "placing collides"
        arm.hold(*held.box())
        beside = arm.collides(high)
        arm.hold(None)
        return "object collides above the spot" if beside else _Down(target, high, down, rise)
    return why


def _deeper(planner: Planner, way: _Down, around: Sequence[Obstacle]) -> tuple[list[Array], bool]:
    """The straight way on down for what hangs higher in the hand than it was measured, and whether the hand meets the
    surface at its end."""
    arm, at, pose = planner.arm, way.down[-1], way.target
    path: list[Array] = []
    arm.set_obstacles(around)
    for _ in range(round(DEEPEST / DEEPER)):
        below = pose.moved(np.array([0.0, 0.0, -DEEPER]))
        part = planner.straight(at, pose, below)
        if part is None:
            return path, False
        if any(arm.collides(q) for q in part):
            return path, True
        path, at, pose = [*path, *part], part[-1], below
    return path, False


def can_be_set_down(planner: Planner, held: GraspedObject, surface: float, now: Array) -> bool:
    """An object can be set down as it is held, on an empty surface of that height [m] in front of the arm."""
    arm = planner.arm
    easy, near = ((arm.forward + far, 0.0) for far in (EASY, EASY - NEARER))
    slab = Obstacle((*easy, surface - SLAB / 2), (AMPLE, AMPLE, SLAB), 0.0)
    height = surface + DROP + (FINGER if held.from_below else 0.0)
    hand = Pose(np.array([*easy, height]) + held.offset, held.rotation)
    # Closed the fingertips are farther out than open.
    if any(planner.clearance.met(hand, width, [slab]) for width in (held.opening or arm.hand.open, held.width)):
        return False
    arm.set_obstacles([slab])
    arm.open_fingers(held.opening)
    try:
        poses = [turned(held, spot, turn) for spot in (easy, near) for turn in TURNS]
        poses += [pose for lean in LEANS for pose in tipped(held, near, 0.0, lean)]
        for pose in poses:
            way = _set_down(planner, held, pose, height, now)
            if isinstance(way, _Down) and _leave(planner, held, way, [slab]) is not None:
                return True
            arm.set_obstacles([slab])
        return False
    finally:
        arm.open_fingers()


def _leave(planner: Planner, held: GraspedObject, way: _Down, beside: Sequence[Obstacle]) -> list[Array] | None:
    """Off what was put down: straight back or up, or a part of that; where the arm cannot, the way it came, unless a
    finger would take the object along.
    """
    arm, target, at = planner.arm, way.target, way.down[-1]
    arm.set_obstacles(beside)
    tilted = held.entangled or abs(way.target.rotation[2, 2]) < 0.85
    away = -0.10 * target.rotation[:, 2] if tilted else np.array([0.0, 0.0, 0.12])
    for share in (1.0, 0.6):
        path = planner.straight(at, target, target.moved(share * away))
        if path is not None and not arm.collides(path[-1]) and not arm.meets_itself(path[:-1]):
            return path
    as_it_came = [*way.down[-2::-1], way.high]
    return None if held.entangled or arm.collides(as_it_came[-1]) else as_it_came
