"""Grasps of vessels that lie: one finger is in the mouth, so that what is too wide to be taken around is held. Pure."""

import math

import numpy as np

from common.kinds import kind_of
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.grasp import Grasp, approach_rotation, vessel_of
from services.manipulation.grasps.rules import RIM_DEPTH
from services.manipulation.grasps.target import Target

ANGLES = (20, 35, 8)
"""Approaches [deg] below horizontal. Chosen: the hand stays above the surface."""
TURNS = (0.0, 0.5, -0.5)
"""Where on the wall [rad], from its top."""


def in_the_mouth(target: Target) -> list[Grasp]:
    """The wall of a mug or cup on its side, taken at the rim along its axis; it is stood up from there."""
    if not target.lies or not kind_of(target.kind).open_above:
        return []
    wall, yaw, found = vessel_of(target).wall, target.yaw, []
    ahead, beside = np.array([math.cos(yaw), math.sin(yaw), 0.0]), np.array([-math.sin(yaw), math.cos(yaw), 0.0])
    mouth = np.array(target.position) + (target.size[0] / 2 - RIM_DEPTH) * ahead
    for degrees in ANGLES:
        for turn in TURNS:
            outward = math.cos(turn) * np.array([0.0, 0.0, 1.0]) + math.sin(turn) * beside
            point = mouth + (target.size[1] - wall) / 2 * outward
            for roll in (math.pi / 2, -math.pi / 2):
                rotation = approach_rotation(yaw + math.pi, math.radians(degrees), roll - turn)
                name = f"mouth at {math.degrees(turn):+.0f}, {degrees} deg, palm {'up' if roll < 0 else 'down'}"
                height, axis = float(point[2]) - target.bottom, math.remainder(yaw, math.tau)
                found.append(Grasp(Pose(point, rotation), wall, height, math.radians(degrees), name, axis, rim=True))
    return found
