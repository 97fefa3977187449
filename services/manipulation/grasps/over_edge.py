"""Grasps of flat things that are too wide for the hand as they lie: one finger is below them, over an edge. Pure."""

import math

import numpy as np

from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.grasp import Grasp, approach_rotation, upper_end
from services.manipulation.grasps.target import Target

OVERLAPS = (0.034, 0.026, 0.018, 0.010, 0.004)
"""How far [m] the pads' middle is within what is taken over an edge, deepest first. Chosen: from all of a pad's length
and a little to the least that holds."""
ASIDE = (0.0, 0.02, -0.02)
"""How far [m] beside the middle of its side."""


def flat_and_wide(target: Target, widest: float) -> bool:
    """It is a flat-sided thing that goes between the fingers only with one of them below it."""
    return target.family == "box" and min(target.size[:2]) > widest >= target.size[2]


def over_an_edge(target: Target, forward: float, widest: float) -> list[Grasp]:
    """One finger above and one below a flat thing that is too wide for the hand as it lies: there is room for these
    where it reaches over the edge of its surface.
    """
    if not flat_and_wide(target, widest):
        return []
    x, y, z = target.position
    facing, thick = math.atan2(y, x - forward), target.size[2]
    found = []
    sides = [(target.yaw + n * math.pi / 2, target.size[n % 2] / 2) for n in range(4)]
    for azimuth, half in sorted(sides, key=lambda side: abs(math.remainder(side[0] - facing, math.tau))):
        off = math.remainder(azimuth - facing, math.tau)
        if abs(off) > math.radians(105):
            continue
        c, s = math.cos(azimuth), math.sin(azimuth)
        for aside in ASIDE:
            for overlap in OVERLAPS:
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
