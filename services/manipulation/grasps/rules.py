"""Candidate grasps for an object of known kind, size and pose: side grasps for upright objects, tilted ones for mugs,
from above for low ones, at the rim for bowls. Angles were measured in simulation for a 85 mm parallel gripper.
"""

import math
from dataclasses import replace

import numpy as np

from common.kinds import KINDS, UNKNOWN, GraspRule, Shape, kind_of
from common.messages.perception import ShapeFamily
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.grasp import HANDLE_CONE, Grasp, approach_rotation, handle_of, on_handle, vessel_of
from services.manipulation.grasps.target import Target
from services.manipulation.grasps.vessel import rim_height, rim_lean, seen_open

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
"""Approaches of what is tall and of what is low [deg] below horizontal, in order of trying."""
BY_SHAPE: dict[str, tuple[GraspRule, ...]] = {
    "round": (GraspRule("around", _ABOVE, most=0.07), GraspRule("around", _BESIDE, least=0.07)),
    "box": UNKNOWN.grasps,
    "ball": (GraspRule("around", _ABOVE),),
    "bowl": KINDS["bowl"].grasps,
}
"""How a shape is grasped whose kind is not known. What is long or irregular only has its measured surface."""
OPEN_VESSEL = (GraspRule("rim", (90, 80, 70)),)
"""How a vessel with an upright wall is grasped that does not fit between the fingers."""
TURNING = (GraspRule("around", (0,), 0.4), GraspRule("around", (0, 8, 3, 14)))
"""How what stands on its head is grasped: nearly level, so that the hand is above the surface either way up. Turned
over it has its camera below it, for which the first leaves room."""


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
        found = [(rule.height, g) for rule in TURNING for g in _round(target, facing, rule)]
        turned = [replace(g, name=f"upside down at {h:g}, {g.name}", turns_over=True) for h, g in found]
        return turned + _standing(target, facing, widest)
    return _standing(target, facing, widest)


def _standing(target: Target, facing: float, widest: float) -> list[Grasp]:
    tall = target.size[2]
    makers = {"around": _round, "faces": _flat, "rim": _rim}
    rules = _rules(target)
    # What is round and was not seen to be open loses these below.
    vessel = kind_of(target.kind).wall or (target.measured and target.shape == "round")
    if vessel and min(target.size[:2]) > widest and all(r.hold != "rim" for r in rules):
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


def _off(angle: float, other: float) -> float:
    return math.remainder(angle - other, math.tau)
