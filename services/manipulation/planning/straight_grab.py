"""The straight parts of a grab, to the grasp and up from it, with room for the hand now and when it sets down again."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from common.geometry import Array
from common.robot.model import Hand
from services.manipulation.arm.arm_model import Obstacle, Pose
from services.manipulation.arm.ik import seeds
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.grasped_object import attach
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import Planner
from services.manipulation.planning.plan_place import can_be_set_down

T = TypeVar("T")
STANCE_GRASPS = 12
"""Grasps of a stage that are tried from where the robot does not stand. Chosen: a quarter of a second for a stance."""
FINGER_PLAY = 0.012
"""How much wider [m] than the object on either side the fingers stand that go into a crowd partly closed. Chosen: the
error of a sighting and of the arm."""

SHORTER = (1.0, 0.6)
"""Shares of the straight ways that will do. Chosen: at the end of the arm's reach the last 4 cm are often too much, and
what is left leads past a pad's length and more than twice the margin in transit."""

RESERVE = 0.003
"""How much less than fully [m] the hand opens on its way in. Chosen: twice what the fingers give way by at 20 N; fully
open they held a mug 3 mm wider than themselves, and took it along on the way out."""


@dataclass(frozen=True)
class Miss:
    """Why a grasp cannot be planned; `met` are labels of the obstacles that it would touch."""

    reason: str
    met: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Way:
    """How the hand goes in: `approach` and `lift` are the straight ways before and after it closes [m], where the arm
    cannot go so far a share of them.

    `around` is what it must not touch; `shaped`: with the fingers no wider than the object needs; `stand_on`: height
    [m] of a surface on which the hand has to be able to put it down, standing, None: it may be laid anywhere.
    """

    around: Sequence[Obstacle]
    shaped: bool
    approach: float
    lift: float
    stand_on: float | None = None
    answered: dict[tuple[float, ...], bool] = field(default_factory=dict, compare=False, repr=False)
    """By height and slant of the hand, whether it can: other bearings come down the same."""


def feasible(planner: Planner, target: Target, way: Way, now: Array) -> bool:
    """Some grasp can be come to and lifted straight; the way there and away is not looked for."""
    target = planner.believed(target)
    for stage in planner.candidates(target):
        for wanted in stage[:STANCE_GRASPS]:
            if isinstance(with_fingers(planner, target, wanted, way, now, straight_parts), Lines):
                return True
    return False


@dataclass(frozen=True)
class Lines:
    """The straight parts of a grab: the grasp, `at` which joint angles (7,), the ways `back` and `up` from there, the
    latter by `lift` [m]."""

    grasp: Grasp
    at: Array
    back: list[Array]
    up: list[Array]
    lift: float


Part = Callable[[Planner, Target, Grasp, Way, Array], "T | Miss"]


def with_fingers(planner: Planner, target: Target, wanted: Grasp, way: Way, now: Array, part: "Part[T]") -> "T | Miss":
    """A part of the plan of a grasp that the hand has room for, with the fingers as they go in."""
    opening = opening_of(planner, wanted, way)
    grasp = planner.clearance.clear(target, wanted, opening)
    if grasp is None:
        return Miss("too deep for the hand")
    if float(np.linalg.norm(grasp.pose.position - planner.arm.shoulder)) > planner.arm.span:
        return Miss("beyond the stretched arm")
    # Closed on the object the fingertips are farther out than open.
    for width in (opening or planner.arm.hand.open, grasp.width):
        if met := planner.clearance.met(grasp.pose, width, way.around):
            return Miss("grasp collides", frozenset(met))
    planner.arm.hold(None)
    planner.arm.open_fingers(opening)
    try:
        return part(planner, target, grasp, way, now)
    finally:
        planner.arm.open_fingers()


def opening_of(planner: Planner, grasp: Grasp, way: Way) -> float | None:
    """How far apart [m] the fingers go in; None: as far as they do."""
    return min(grasp.width + 2 * FINGER_PLAY, planner.arm.hand.open) if way.shaped else None


def with_reserve(hand: Hand, width: float) -> float:
    """How far apart [m] the fingers are around something that is said to be `width` [m] wide: not quite as far as they
    go, so that they come off what they wedge themselves on."""
    return hand.open - min(RESERVE, max(0.0, hand.open - width) / 2)


def straight_parts(planner: Planner, target: Target, grasp: Grasp, way: Way, now: Array) -> "Lines | Miss":
    """The way to a grasp and up from it, from a configuration (7,) near `now`."""
    arm = planner.arm
    arm.set_obstacles(way.around)
    at = planner.ik.solve(grasp.pose, seeds(arm, grasp.pose, now), avoid=True)
    if at is None:
        return Miss("no IK")
    at = arm.nearest_turn(at, now)
    if arm.collides(at):
        return Miss("grasp collides", frozenset(arm.met()))
    back, _ = _straight(planner, at, grasp.pose, -way.approach * grasp.pose.rotation[:, 2])
    if back is None:
        return Miss("no straight approach")
    up, share = _straight(planner, at, grasp.pose, np.array([0.0, 0.0, way.lift]))
    if up is None:
        return Miss("no straight lift")
    if arm.meets_itself(up):
        return Miss("lift meets the robot")
    if any(arm.collides(q) for q in back):
        return Miss("approach collides", frozenset(arm.met()))
    if not _stands_again(planner, target, grasp, way, now):
        return Miss("could not be stood up" if target.lies else "could not be put down there")
    return Lines(grasp, at, back, up, share * way.lift)


def _straight(planner: Planner, at: Array, begin: Pose, way: Array) -> tuple[list[Array] | None, float]:
    """Along `way` (3,) [m] or the share of it that the arm can, and which share that is."""
    for share in SHORTER:
        if (path := planner.straight(at, begin, begin.moved(share * way))) is not None:
            return path, share
    return None, 0.0


def _stands_again(planner: Planner, target: Target, grasp: Grasp, way: Way, now: Array) -> bool:
    """It can be put down with the hand as it grasps, or need not be: what was pulled is taken as it is."""
    if (target.lies and grasp.axis is None) or grasp.over_edge or way.stand_on is None:
        return True
    held = attach(target, grasp)
    alike = (round(float(held.offset[2]), 2), *(round(abs(float(v)), 1) for v in held.rotation[2]))
    if alike not in way.answered:
        way.answered[alike] = can_be_set_down(planner, held, way.stand_on, now)
    return way.answered[alike]
