"""What is too wide for the hand as it lies, and thin enough the other way: pulled over a free edge of its surface, it
is taken from there with one finger below it.

The strategy is that of people and of Eppner and Brock, "Planning grasp strategies that exploit environmental
constraints", ICRA 2015. Two fingers behind its far side are a line that it stays flat against while they pull (Lynch
and Mason, "Stable pushing", 1996), so that it ends along the edge.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from common.geometry import Array, Pose2, Rectangle
from services.manipulation.arm.arm_model import Obstacle, Pose
from services.manipulation.arm.ik import seeds
from services.manipulation.arm.trajectory import Leg, connect
from services.manipulation.grasps.clearance import PAD, PAD_HALF
from services.manipulation.grasps.grasp import approach_rotation
from services.manipulation.grasps.over_edge import is_round
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import MAX_JUMP, PlanError, Planner, counted
from services.manipulation.planning.planning_scene import with_object
from services.manipulation.planning.surface_edge import Edge

TILTS = (90, 80, 72, 65, 58, 50, 42)
"""How far below horizontal [deg] the hand pulls, in the order of trying. Farther away, and higher, it has to lean: to
surfaces from 0.85 m on it comes no steeper than 50."""
LEDGE = 0.014
"""How far [m] inside the edge an object's middle stays, so that it does not tip over it: three times the error of its
measured middle."""
RIM_OVER = 0.048
"""How far [m] a round thing is pulled over the edge at most: a finger has room below its rim, and does not tip it."""
CLOSER = 0.004
"""Least way [m] to there that is worth a pull: the error of the arm."""
FINGERS = 0.055
"""How far apart [m] the fingers pull: a line as wide as the narrowest side that does not fit between them allows."""
SIDE = 0.012
"""How far [m] the outer sides of the fingers at least stay within the side that they pull at."""
BEHIND = 0.018
"""Free way [m] behind the far side at which the fingers come down: the error of a side that is not seen."""
ABOVE = 0.008
"""Height [m] of the fingertips over the surface while they pull: the error of the arm and of the surface's height."""
OVER = 0.06
"""Height [m] from which the hand comes straight down behind it."""
STEP, TURN = 0.015, math.radians(4)
"""Way [m] and turn [rad] of an object between two configurations."""
RISE = 0.006
"""How far [m] a hand that leans rises on its way: it is drawn up along the upper edge, and would press down there."""
LINKS_HALF, PADS_END = 0.02, 0.021
"""Half the breadth [m] of the fingers above their pads, and where these end behind the pinch point (Robotiq 2F-85)."""
BELOW_LINKS = 0.004
"""How far [m] the upper edge of what is pulled is below those: the error of its height. A corner of theirs that slipped
onto it dragged a box back by its upper side, which tipped it over the edge."""
LET_GO = 0.012
"""How far [m] the fingers go back before they leave upwards."""


@dataclass(frozen=True)
class Pull:
    """Joint paths (lists of (7,), or legs) of the phases; `opening` [m] of the fingers; `line`: where the object
    (x, y, yaw) in the base frame is at the configurations of `pull`.
    """

    reach: list[Leg]
    lower: list[Array]
    pull: list[Array]
    leave: list[Array]
    home: list[Leg]
    opening: float
    line: list[Pose2]


def plan_pull(
    planner: Planner, target: Target, edge: Edge, around: Sequence[Obstacle], now: Array, lift: float
) -> Pull:
    """Pull an object to where it lies along the edge, as far over it as it can without tipping.

    Raises:
        PlanError: UNREACHABLE; TOO_WIDE, it lies as far over the edge as it can.
    """
    normal = _far_side(target, edge)
    half = _halves(target, normal)
    x, y, _ = target.position
    way = edge.inset(x, y) - (max(LEDGE, half[1] - RIM_OVER) if is_round(target) else LEDGE)
    if way < CLOSER:
        raise PlanError("TOO_WIDE", f"the {target.label} lies at the edge already")
    line = _curve((x, y, normal), math.atan2(-edge.outward[1], -edge.outward[0]), way)
    for at in line:
        swept = Rectangle(at[0], at[1], 2 * half[0], 2 * half[1], at[2])
        for o in around:
            if o.label and swept.distance(o.center[0], o.center[1]) < min(o.size[:2]) / 2:
                raise PlanError("UNREACHABLE", f"the {o.label} is in the way to the edge", (o.label,))
    if abs(edge.along(*line[-1][:2])) + half[1] > edge.half:
        raise PlanError("UNREACHABLE", f"beside the {target.label} the edge ends")
    misses = []
    opening = _opening(half)
    for tilt in TILTS:
        planner.arm.hold(None)
        planner.arm.open_fingers(opening)
        try:
            found = _with_tilt(planner, target, line, half, edge, math.radians(tilt), around, now, lift, opening)
        finally:
            planner.arm.open_fingers()
        if isinstance(found, Pull):
            return found
        misses.append(found)
    raise PlanError("UNREACHABLE", f"cannot pull the {target.label} to the edge: {counted(misses)}")


def can_pull(planner: Planner, target: Target, edge: Edge, around: Sequence[Obstacle], now: Array) -> bool:
    """The hand comes down behind an object; the way to the edge is not looked for."""
    normal = _far_side(target, edge)
    half, (x, y, _) = _halves(target, normal), target.position
    planner.arm.hold(None)
    planner.arm.open_fingers(_opening(half))
    try:
        hands = [_hand((x, y, normal), half[0], BEHIND, math.radians(t), edge, target.size[2]) for t in TILTS]
        return any(not isinstance(_down(planner, target, hand, around, now), str) for hand in hands)
    finally:
        planner.arm.open_fingers()


def _curve(begin: Pose2, end: float, way: float) -> list[Pose2]:
    """Poses of an object from (x, y, direction of its far side) to where it is turned to `end` [rad] and `way` [m]
    nearer to the edge: an arc on which it always moves straight away from the fingers.
    """
    x, y, normal = begin
    turn = math.remainder(end - normal, math.tau)
    heading = normal + math.pi
    # On so wide an arc it is as good as straight.
    turn = turn if abs(turn) > 1e-3 else 1e-3
    length = way * turn / math.sin(turn)
    count = max(2, math.ceil(max(length / STEP, abs(turn) / TURN)))
    found = []
    for n in range(count + 1):
        now = heading + turn * n / count
        dx = (math.sin(now) - math.sin(heading)) * length / turn
        dy = (math.cos(heading) - math.cos(now)) * length / turn
        found.append((x + dx, y + dy, now - math.pi))
    return found


def _far_side(target: Target, edge: Edge) -> float:
    """Direction [rad] of the normal of the side that is most turned away from the edge."""
    if is_round(target):
        return math.atan2(-edge.outward[1], -edge.outward[0])
    sides = [target.yaw + quarter * math.pi / 2 for quarter in range(4)]
    return min(sides, key=lambda a: float(edge.outward @ (math.cos(a), math.sin(a))))


def _halves(target: Target, normal: float) -> tuple[float, float]:
    """How far [m] its middle is from where the fingers meet it, along a side's normal, and its half extent across."""
    if is_round(target):
        # It lies in between two fingers.
        radius = max(target.size[:2]) / 2
        return math.sqrt(radius**2 - (_opening((radius, radius)) / 2) ** 2), radius
    along = abs(math.cos(normal - target.yaw)) > 0.5
    x, y = target.size[0] / 2, target.size[1] / 2
    return (x, y) if along else (y, x)


def _opening(half: tuple[float, float]) -> float:
    """How far apart [m] the fingers pull at a side, from `_halves`."""
    return min(FINGERS, 2 * (half[1] - SIDE - PAD_HALF))


def _hand(at: Pose2, half: float, gap: float, tilt: float, edge: Edge, height: float) -> Pose:
    """The hand with its fingers `gap` [m] behind the far side of an object at (x, y, direction of that side)."""
    x, y, yaw = at
    links = PADS_END * math.sin(tilt) - LINKS_HALF * math.cos(tilt)
    z = max(ABOVE + PAD * math.sin(tilt) + PAD_HALF * math.cos(tilt), height - links + BELOW_LINKS)
    # What leans comes nearer with its height.
    far = half + gap + PAD_HALF / math.sin(tilt) + max(0.0, height - z) / math.tan(tilt)
    return Pose(
        np.array([x + far * math.cos(yaw), y + far * math.sin(yaw), edge.height + z]), approach_rotation(yaw, tilt)
    )


def _down(
    planner: Planner, target: Target, begin: Pose, around: Sequence[Obstacle], now: Array
) -> "tuple[Array, list[Array]] | str":
    """Joints (7,) with the hand behind an object, and the straight way up from there; or why there is none."""
    arm = planner.arm
    arm.set_obstacles(with_object(around, target.grown(0.0)))
    at = planner.ik.solve(begin, seeds(arm, begin, now), avoid=True)
    if at is None:
        return "no IK"
    at = arm.nearest_turn(at, now)
    if arm.collides(at):
        return "no room behind it"
    up = planner.straight(at, begin, begin.moved(np.array([0.0, 0.0, OVER])))
    if up is None or any(arm.collides(q) for q in up):
        return "no way down behind it"
    return at, up


def _rise(tilt: float, share: float, height: float) -> float:
    """How much higher [m] a hand of that tilt is after a share of its way: it stays behind what is that high."""
    return share * min(RISE * min(1.0, 2 * math.cos(tilt)), max(0.0, height - ABOVE) / 2)


def _with_tilt(
    planner: Planner, target: Target, line: Sequence[Pose2], half: tuple[float, float], edge: Edge, tilt: float,
    around: Sequence[Obstacle], now: Array, lift: float, opening: float,
) -> "Pull | str":  # fmt: skip
    arm, height, rng = planner.arm, target.size[2], planner.rng()
    begins, ends = line[0], line[-1]
    begin = _hand(begins, half[0], BEHIND, tilt, edge, height)
    down = _down(planner, target, begin, around, now)
    if isinstance(down, str):
        return down
    at, up = down
    arm.set_obstacles(around)
    pull, q = [at], at
    steps = [begins, begins, *line]
    for n, where in enumerate(steps):
        gap = BEHIND / 2 if n == 0 else 0.0
        wanted = _hand(where, half[0], gap, tilt, edge, height).moved(
            np.array([0, 0, _rise(tilt, n / len(steps), height)])
        )
        solved = planner.ik.solve(wanted, [q])
        if solved is None or np.abs(solved - q).max() > MAX_JUMP:
            return "no way to the edge"
        if arm.collides(solved):
            return "pulling collides"
        pull.append(solved)
        q = solved
    last = wanted
    off = last.moved(LET_GO * np.array([math.cos(ends[2]), math.sin(ends[2]), 0.0]))
    back = planner.straight(q, last, off)
    away = planner.straight(back[-1], off, off.moved(np.array([0.0, 0.0, lift]))) if back else None
    if back is None or away is None:
        return "no way off"
    before = with_object(around, target.grown(0.0))
    planner.surround(before, up[-1], [now])
    there = connect(arm, now, up[-1], rng)
    stands = Obstacle((ends[0], ends[1], target.position[2]), (2 * half[0], 2 * half[1], height), ends[2])
    after, goal = with_object(around, stands), arm.nearest_turn(arm.home, away[-1])
    planner.surround(after, away[-1], [goal])
    home = connect(arm, away[-1], goal, rng)
    if there is None or home is None:
        return "no path"
    own = [(x, y, math.remainder(target.yaw + turn - begins[2], math.tau)) for x, y, turn in (begins, *steps)]
    reach, leave = planner.legs(there, before), planner.legs(home, after)
    return Pull(reach, [*up[::-1], at], pull, [q, *back, *away], leave, opening, own)
