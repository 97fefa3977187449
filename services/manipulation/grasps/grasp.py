"""Candidate grasps for an object of known kind, size and pose: side grasps for upright objects, tilted ones for mugs,
from above for low ones, at the rim for bowls. Angles were measured in simulation for a 85 mm parallel gripper."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from common import messages as m
from common.geometry import Pose2, matrix_quat, quat_matrix, yaw_quat
from common.kinds import KINDS, UNKNOWN, GraspRule, Kind, Shape, kind_of
from common.messages.perception import ShapeFamily
from services.manipulation.arm.arm_model import Array, Pose
from services.manipulation.grasps.surface import rim_height, rim_lean, seen_open
from services.manipulation.grasps.target import Target

HANDLE_CONE = math.radians(50)
"""Angle [rad] between a finger and a handle below which the finger would land on it. Chosen: a handle's width and a
finger's, seen from the axis of a mug."""
HANDLE_ROOM, HANDLE_POINTS = 0.008, 4
"""How far [m] beyond the wall of a round object, and how many points there are, that a handle is taken to be: a finger
goes through one, noise and the fit's error do not reach as far."""
TURNS = (0, 25, -25, 50, -50)
"""From where [deg] what is round is taken, off the way from the arm to it, in the order of trying."""
RIM_DEPTH = 0.012
"""How far [m] below a rim the pads take hold: more than half of a pad's length is on the wall."""
OFF_WALL = (0, 7, -7, 15, -15, -25)
"""By how much [deg] the hand may come off the slope of a wall that it takes at the rim. Chosen: what the rules of kinds
have about the slope of theirs."""
FITTING: dict[Shape, tuple[ShapeFamily, ...]] = {
    "turned": ("round", "bowl"),
    "sphere": ("ball", "round"),
    "box": ("box",),
}
"""What an object of a kind may be measured as."""
UNSEEN = (0.1, 0.35)
"""Share of the points that may be lower, and the height, by the whole, below which nothing else was seen of an object
whose lower part is not seen: a stapler's black foot, the legs of a toy."""
_BESIDE, _ABOVE = (15, 25, 40, 60, 90), (90, 65, 45, 30)
BY_SHAPE: dict[str, tuple[GraspRule, ...]] = {
    "round": (GraspRule("around", _ABOVE, most=0.07), GraspRule("around", _BESIDE, least=0.07)),
    "box": UNKNOWN.grasps,
    "ball": (GraspRule("around", _ABOVE),),
    "bowl": KINDS["bowl"].grasps,
}
"""How a shape is grasped whose kind is not known. What is long or irregular only has its measured surface."""
OPEN_VESSEL = (GraspRule("rim", (90, 80, 70)),)
"""How a vessel with an upright wall is grasped that does not fit between the fingers."""
TURNING = GraspRule("around", (8, 3, 14))
"""How what stands on its head is grasped: nearly level, so that the hand is above the surface either way up."""
CERTAIN = 0.006
"""Largest spread [m] of measured extents from which an object is said to be too wide without a try."""
USUAL_VESSEL = KINDS["bowl"]
"""Whose wall is taken for that of a vessel of a kind that has none."""


@dataclass(frozen=True)
class Grasp:
    """Where the pinch point goes, how wide the object is there, and its height above the object's underside.

    `axis`: where the upper end of a lying object points [rad]; None when it stands. `turns_over`: it stands on its
    upper end, and is turned about the hand's approach before it is put down. `rim`: one finger is inside the
    object, `width` is that of its wall; `on_surface`: found on the measured surface and not by the rule of a kind;
    `over_edge`: one finger is below the object, which has to reach over the edge of its surface.
    """

    pose: Pose
    width: float
    height: float
    tilt: float
    name: str
    axis: float | None = None
    rim: bool = False
    on_surface: bool = False
    turns_over: bool = False
    over_edge: bool = False


def approach_rotation(azimuth: float, tilt: float, roll: float = 0.0) -> Array:
    """Rotation (3, 3) that approaches along `azimuth`, `tilt` downward of horizontal.

    `roll` turns the fingers about the approach, counter-clockwise seen from behind the hand.
    """
    ca, sa, ct, st = math.cos(azimuth), math.sin(azimuth), math.cos(tilt), math.sin(tilt)
    z = np.array([ct * ca, ct * sa, -st])
    y = np.array([-sa, ca, 0.0])
    x = np.cross(y, z)
    c, s = math.cos(roll), math.sin(roll)
    return np.stack([c * x - s * y, s * x + c * y, z], axis=1)


def candidates(target: Target, forward: float, widest: float) -> list[Grasp]:
    """Grasps by the rules of the object's kind, or of the shape that was measured, in the order to try them; empty when
    there are none for it, or nothing of it fits between the fingers.

    `forward`: where the arm stands on the base [m]; `widest`: what fits into the hand [m].
    """
    return [g for g in _candidates(target, forward, widest) if g.width <= widest]


def _candidates(target: Target, forward: float, widest: float) -> list[Grasp]:
    facing = math.atan2(target.position[1], target.position[0] - forward)
    if target.lies:
        return _lying(target, facing)
    if target.upside_down and kind_of(target.kind).upright:
        turned = [replace(g, name=f"upside down, {g.name}", turns_over=True) for g in _round(target, facing, TURNING)]
        return turned + _standing(target, facing, widest)
    return _standing(target, facing, widest)


def _standing(target: Target, facing: float, widest: float) -> list[Grasp]:
    tall = target.size[2]
    makers = {"around": _round, "faces": _flat, "rim": _rim}
    rules = _rules(target)
    if kind_of(target.kind).wall and min(target.size[:2]) > widest and all(r.hold != "rim" for r in rules):
        rules = (*rules, *OPEN_VESSEL)
    if not seen_open(target):
        rules = tuple(r for r in rules if r.hold != "rim")
    return [g for r in rules if r.least <= tall < r.most for g in makers[r.hold](target, facing, r)]


def _rules(target: Target) -> tuple[GraspRule, ...]:
    """Those of the kind, unless another shape was measured than the kind has."""
    kind = kind_of(target.kind)
    if not target.shape or (kind.name and target.shape in (*FITTING[kind.shape], "irregular", "long")):
        return kind.grasps
    return BY_SHAPE.get(target.shape, ())


def shown(
    target: Target,
    options: Iterable[Grasp],
    base: Pose2,
    now: float,
    failed: Iterable[str],
    chosen: str,
    goal_id: str,
) -> m.GraspCandidates:
    """Every candidate in frame map, for viewers."""
    turn, lost = quat_matrix(yaw_quat(base[2])), set(failed)
    found = []
    for one in options:
        x, y, z = (float(v) for v in turn @ one.pose.position + np.array([base[0], base[1], 0.0]))
        state: Literal["open", "failed", "chosen"] = "failed" if one.name in lost else "open"
        found.append(
            m.GraspCandidate(
                name=one.name, position=(x, y, z), orientation=matrix_quat(turn @ one.pose.rotation), width=one.width,
                state="chosen" if one.name == chosen else state,
            )
        )  # fmt: skip
    return m.GraspCandidates(t=now, object=target.label, candidates=found, goal_id=goal_id)


def _make(target: Target, height: float, azimuth: float, tilt: float, roll: float, width: float, name: str) -> Grasp:
    x, y, _ = target.position
    rotation = approach_rotation(azimuth, tilt, roll)
    return Grasp(Pose(np.array([x, y, target.bottom + height]), rotation), width, height, tilt, name)


def _height(target: Target, rule: GraspRule) -> float:
    """Height [m] over its underside at which an object is taken by a rule: where it is seen, if its lower part is not.

    That may be something narrower, on which fingers fold in and squeeze what is above them out of the hand.
    """
    tall = target.size[2]
    if target.points is None or not target.measured or kind_of(target.kind).shape == "sphere":
        return tall * rule.height  # of a ball its equator alone does not slip out between the pads
    lowest = float(np.quantile(target.points[:, 2], UNSEEN[0])) + tall / 2
    return max(rule.height * tall, (lowest + tall) / 2) if lowest > UNSEEN[1] * tall else rule.height * tall


def _round(target: Target, facing: float, rule: GraspRule) -> list[Grasp]:
    """Fingers on either side of a round object's axis, from the front and up to 50 degrees to the sides."""
    width = max(target.size[0], target.size[1])
    found = []
    for degrees in rule.angles:
        tilt = math.radians(degrees)
        for turn in TURNS:
            azimuth = facing + math.radians(turn)
            name = f"{degrees:.0f} deg at {turn:+.0f}"
            grasp = _make(target, _height(target, rule), azimuth, tilt, 0.0, width, name)
            if not on_handle(target, grasp.pose.rotation):
                found.append(grasp)
    return found


def _lying(target: Target, facing: float) -> list[Grasp]:
    """Fingers on either side of a lying object's axis, the hand leaning towards its foot: so it can be set upright."""
    found, kind = [], kind_of(target.kind)
    along = kind.lying_point * target.size[0]
    x, y, _ = target.position
    point = np.array([x + along * math.cos(target.yaw), y + along * math.sin(target.yaw), target.position[2]])
    turns = (0.0, math.pi) if kind.ends_alike else (0.0,)
    for degrees in kind.lying_angles:
        for axis in sorted((target.yaw + turn for turn in turns), key=lambda a: abs(_off(a + math.pi, facing))):
            # Straight from above the hand may be turned either way.
            for azimuth in (axis + math.pi, axis) if degrees == 90 else (axis + math.pi,):
                pose = Pose(point, approach_rotation(azimuth, math.radians(degrees)))
                name = f"lying, {degrees} deg at {math.degrees(_off(azimuth, facing)):+.0f}"
                height = target.size[2] / 2
                # What has no upper side is put down as it lies.
                upwards = math.remainder(axis, math.tau) if kind.upright else None
                found.append(Grasp(pose, target.size[1], height, math.radians(degrees), name, upwards))
    return found


def certainly_too_wide(target: Target, widest: float) -> bool:
    """Neither side of an object goes between the fingers, even if it is smaller than measured by twice the spread."""
    return target.spread <= CERTAIN and min(target.size[:2]) - 2 * target.spread > widest


def upper_end(target: Target, rotation: Array) -> float | None:
    """Where the upper end of a lying object points [rad] that is to be put down upright; None of others."""
    kind = kind_of(target.kind)
    if not target.lies or not kind.upright:
        return None
    # Of two ends that are alike the hand leans towards the lower one: so it is above when the object stands.
    along = float(rotation[:2, 2] @ (math.cos(target.yaw), math.sin(target.yaw)))
    turn = math.pi if kind.ends_alike and along > 0 else 0.0
    return math.remainder(target.yaw + turn, math.tau)


def _off(angle: float, other: float) -> float:
    return math.remainder(angle - other, math.tau)


def on_handle(target: Target, rotation: Array) -> bool:
    """True when a hand of this rotation (3, 3) would close on the handle of an upright object, or reach through it."""
    handle = handle_of(target)
    if handle is None or target.lies:
        return False
    closing = math.atan2(rotation[1, 1], rotation[0, 1])
    return abs(math.cos(handle - closing)) > math.cos(HANDLE_CONE)


def handle_of(target: Target) -> float | None:
    """Where the handle of an upright object points [rad]: along its yaw if its kind has one, or what was seen of a
    round one beyond its wall; None without.
    """
    if kind_of(target.kind).handle:
        return target.yaw
    if target.points is None or target.family not in ("round", "bowl"):
        return None
    beyond = target.points[np.hypot(target.points[:, 0], target.points[:, 1]) > max(target.size[:2]) / 2 + HANDLE_ROOM]
    if len(beyond) < HANDLE_POINTS:
        return None
    return math.atan2(float(beyond[:, 1].mean()), float(beyond[:, 0].mean()))


def _flat(target: Target, facing: float, rule: GraspRule) -> list[Grasp]:
    """Fingers on two parallel faces."""
    found, height = [], _height(target, rule)
    for degrees in rule.angles:
        tilt = math.radians(degrees)
        options = []
        for quarter in range(4):
            face = target.yaw + quarter * math.pi / 2
            width = target.size[1] if quarter % 2 == 0 else target.size[0]
            off = math.remainder(face - facing, 2 * math.pi)
            if abs(off) < math.radians(181 if degrees == 90 else 105):
                options.append((abs(off), face, width))
        for off, face, width in sorted(options):
            name = f"{degrees:.0f} deg on faces at {math.degrees(off):.0f}"
            if degrees == 90:
                # From straight above any azimuth will do: face the robot's way and turn the fingers instead.
                roll = math.remainder(face - facing, math.pi)
                found.append(_make(target, height, facing, tilt, roll, width, name))
            else:
                found.append(_make(target, height, face, tilt, 0.0, width, name))
    return found


def _rim(target: Target, facing: float, rule: GraspRule) -> list[Grasp]:
    """Fingers on either side of a vessel's wall at the rim, along its slope: the near side first."""
    x, y, _ = target.position
    height, vessel, handle = rim_height(target) - RIM_DEPTH, vessel_of(target), handle_of(target)
    measured = rim_lean(target)
    lean = vessel.lean if measured is None else measured
    radius = target.size[0] / 2 - RIM_DEPTH * math.tan(lean) - vessel.wall / 2
    found = []
    for degrees in rule.angles if measured is None else _along_wall(lean):
        tilt = math.radians(degrees)
        for turn in TURNS:
            azimuth = facing + math.radians(turn)
            if handle is not None and abs(_off(azimuth + math.pi, handle)) < HANDLE_CONE:
                continue
            point = np.array([x - radius * math.cos(azimuth), y - radius * math.sin(azimuth), target.bottom + height])
            for roll in (math.pi / 2, -math.pi / 2):
                rotation = approach_rotation(azimuth, tilt, roll)
                name = f"rim at {turn:+.0f}, {degrees} deg, {'palm up' if roll < 0 else 'palm down'}"
                found.append(Grasp(Pose(point, rotation), vessel.wall, height, tilt, name, rim=True))
    return found


def _along_wall(lean: float) -> list[int]:
    """Approaches [deg] below horizontal along a wall that leans outwards by `lean` [rad], the nearest to it first."""
    along = 90 - round(math.degrees(lean))
    return sorted({min(90, along + off) for off in OFF_WALL}, key=lambda angle: abs(angle - along))


def vessel_of(target: Target) -> Kind:
    """The kind whose wall the object's is like."""
    kind = kind_of(target.kind)
    return kind if kind.wall else USUAL_VESSEL
