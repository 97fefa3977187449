"""Grasps of flat things that are too wide for the hand as they lie: one finger is below them, over an edge. Pure.

What has flat sides is taken level, what is round and low, as a plate, at its rim along the slope of that.
"""

import math

import numpy as np

from common.kinds import PLATE_FOOT, kind_of
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.grasp import Grasp, approach_rotation, upper_end, vessel_of
from services.manipulation.grasps.rules import TURNS
from services.manipulation.grasps.target import Target

OVERLAPS = (0.034, 0.026, 0.018, 0.010, 0.004)
"""How far [m] the pads' middle is within what is taken over an edge, deepest first. Chosen: from all of a pad's length
and a little to the least that holds."""
PUT_BACK = 0.055
"""How much less [m] than its half that is: put down over another edge, with 25 mm of the fingers before that, it lies
with its middle 30 mm inside."""
ASIDE = (0.0, 0.02, -0.02)
"""How far [m] beside the middle of its side."""
DEPTHS = (0.020, 0.015, 0.010)
"""How far [m] the pads' middle is from the edge of a rim, along its slope."""
FROM_BELOW = 0.004
"""How much farther [m] from a rim the upper finger is: the lower one comes first, and tips nothing over the edge."""
SLOPES = (0, 10, -10)
"""How much steeper [deg] than a rim of that height usually is the hand comes."""
LOW_RIM = 0.032
"""Height [m] below which a rim is not taken from above: the pads end 19 mm beyond where they hold, 12 mm below it."""


def flat_and_wide(target: Target, widest: float) -> bool:
    """It goes between the fingers only with one of them below it: a flat-sided thing that lies, a plate."""
    if is_round(target):
        return max(target.size[:2]) > widest and target.size[2] < LOW_RIM
    return target.family == "box" and min(target.size[:2]) > widest >= target.size[2]


def is_round(target: Target) -> bool:
    """It is as wide from wherever the hand comes."""
    return target.family in ("round", "bowl") and not target.lies


def over_an_edge(target: Target, forward: float, widest: float) -> list[Grasp]:
    """One finger above and one below a flat thing that is too wide for the hand as it lies: there is room for these
    where it reaches over the edge of its surface.
    """
    if not flat_and_wide(target, widest):
        return []
    x, y, z = target.position
    facing, thick = math.atan2(y, x - forward), target.size[2]
    if is_round(target):
        return _rim(target, facing)
    found = []
    sides = [(target.yaw + n * math.pi / 2, target.size[n % 2] / 2) for n in range(4)]
    for azimuth, half in sorted(sides, key=lambda side: abs(math.remainder(side[0] - facing, math.tau))):
        off = math.remainder(azimuth - facing, math.tau)
        if abs(off) > math.radians(105):
            continue
        c, s = math.cos(azimuth), math.sin(azimuth)
        for aside in ASIDE:
            for overlap in _overlaps(target, half):
                at = np.array([x - c * (half - overlap) - s * aside, y - s * (half - overlap) + c * aside, z])
                for roll in (math.pi / 2, -math.pi / 2):
                    pose = Pose(at, approach_rotation(azimuth, 0.0, roll))
                    name = (
                        f"over an edge at {math.degrees(off):+.0f}, {1000 * overlap:.0f} mm deep, {1000 * aside:+.0f} "
                        f"mm aside, {'palm up' if roll < 0 else 'palm down'}"
                    )
                    axis = upper_end(target, pose.rotation)
                    found.append(Grasp(pose, thick, thick / 2, 0.0, name, axis, over_edge=True))
    return found


def _overlaps(target: Target, half: float) -> list[float]:
    """How far [m] the pads' middle is within a side, `half` from the middle; what is stood up is not put back over an
    edge."""
    if target.lies and kind_of(target.kind).upright:
        return list(OVERLAPS)
    return [overlap for overlap in OVERLAPS if overlap <= max(half - PUT_BACK, OVERLAPS[-2])]


def _rim(target: Target, facing: float) -> list[Grasp]:
    """The hand comes down to the rim from outside, along its slope, one finger above and one below it."""
    x, y, _ = target.position
    radius, tall, wall = max(target.size[:2]) / 2, target.size[2], vessel_of(target).wall
    slope = math.atan2(tall, (1 - PLATE_FOOT) * radius)
    found = []
    for off in SLOPES:
        tilt = slope + math.radians(off)
        for bearing in TURNS:
            azimuth = facing + math.radians(bearing)
            for depth in DEPTHS:
                out = radius - depth * math.cos(slope) + FROM_BELOW * math.sin(slope)
                height = tall - depth * math.sin(slope) + FROM_BELOW * math.cos(slope)
                at = np.array([x - out * math.cos(azimuth), y - out * math.sin(azimuth), target.bottom + height])
                for roll in (math.pi / 2, -math.pi / 2):
                    name = (
                        f"under the rim at {bearing:+.0f}, {math.degrees(tilt):.0f} deg, {1000 * depth:.0f} mm deep, "
                        f"palm {'up' if roll < 0 else 'down'}"
                    )
                    pose = Pose(at, approach_rotation(azimuth, tilt, roll))
                    found.append(Grasp(pose, wall, height, tilt, name, rim=True, over_edge=True))
    return found
