"""How what reaches lower than believed hangs in the hand: turned about the pads by its weight. Pure."""

import math
from dataclasses import replace

import numpy as np

from common.geometry import Array, turn_matrix, yaw_matrix
from services.manipulation.grasps.grasped_object import GraspedObject

STEP = math.radians(3)
"""Steps in which the turn is sought [rad]. Chosen: 5 mm at the end of something of 0.2 m."""
AXIAL = 0.01
"""Distance [m] of its middle from the line through the pads up to which its weight turns nothing, by what was seen."""
SHORT = 0.01
"""How much more or less [m] than was felt a turn may explain: the error of a sighting."""


def sagged(held: GraspedObject, lower: float) -> GraspedObject | None:
    """The object as it is held if it reaches `lower` [m] farther down, while the hand stands as it grasped.

    It is turned about the line through the pads. None where no turn up to which it hangs straight down explains it.

    It is put down as it stood, or, `as_found`, as it hangs.
    """
    axis = held.rotation[:, 1]
    shape = _around_the_pads(held)
    middle = shape.mean(axis=0)
    beside, down = (v - (v @ axis) * axis for v in (middle, np.array([0.0, 0.0, -1.0])))
    if np.linalg.norm(beside) < AXIAL or np.linalg.norm(down) < AXIAL:
        return None
    way = float(np.cross(beside, down) @ axis)
    most = math.atan2(abs(way), float(beside @ down))
    turns = [turn_matrix(math.copysign(angle, way) * axis) for angle in np.arange(STEP, most + STEP, STEP)]
    reaches = shape[:, 2].min() - np.array([float((shape @ turn[2]).min()) for turn in turns])
    off = np.abs(reaches - lower)
    nearest = int(off.argmin())
    return _turned(held, turns[nearest]) if off[nearest] < SHORT else None


def _around_the_pads(held: GraspedObject) -> Array:
    """Points (n, 3) [m] of the object from the pinch point on: those that were seen of it, and the same from its other
    side, or the corners of its box."""
    middle = np.array([0.0, 0.0, held.size[2] / 2]) - held.offset
    if held.points is not None:
        seen = held.points
        # Each side has as many points: what is turned towards its middle by them stays so.
        return np.asarray(middle + np.concatenate([seen, seen * [1.0, 1.0, -1.0]]))
    half = np.array(held.size) / 2
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    return np.asarray(middle + corners @ yaw_matrix(held.yaw).T)


def _turned(held: GraspedObject, turn: Array) -> GraspedObject:
    """Turned in the hand by `turn` (3, 3) about the pinch point: the hand is turned back relative to it."""
    back, found = turn.T @ held.rotation, held.as_found
    if found is not None:
        found = replace(found, rotation=found.rotation @ held.rotation.T @ back)
    return replace(held, rotation=back, as_found=found or _hanging(held, turn))


def _hanging(held: GraspedObject, turn: Array) -> GraspedObject:
    """Turned in the hand by `turn` (3, 3), as something that stands so."""
    shape = _around_the_pads(held) @ turn.T
    low, high = shape.min(axis=0), shape.max(axis=0)
    x, y, z = (float(v) for v in high - low)
    offset = -np.array([*(low + high)[:2] / 2, low[2]])
    return replace(held, offset=offset, size=(x, y, z), yaw=0.0, points=None)
