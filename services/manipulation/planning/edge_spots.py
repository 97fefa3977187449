"""Where something that is held with one finger below it comes to lie: over the edge of its surface that the robot
stands before, so that this finger and the hand stay in front of the edge."""

import math
from collections.abc import Sequence

import numpy as np

from services.manipulation.grasps.clearance import PAD
from services.manipulation.grasps.grasped_object import GraspedObject
from services.manipulation.grasps.pads import FINGER_HALF
from services.manipulation.planning.surface_edge import Edge

Placement = tuple[tuple[float, float], float]
"""Where the middle of an object comes to (x, y), and where the hand points then [rad], in the base frame."""
INSET = 0.018
"""How far [m] inside the edge the object's middle is at least, so that it does not tip over it: a book of 0.4 kg whose
middle was to be 13 mm inside went down with the finger that came out from under it."""
ROOM = 0.006
"""How far [m] before the edge the fingertips end: the error of the arm, and of where the base stands."""
HEADINGS = tuple(math.radians(angle) for angle in (0, 20, -20, 40, -40, 60, -60))
"""How far [rad] the hand may be turned from straight across the edge: near the base the arm comes from the side."""
BESIDE = 0.03
"""Distance [m] between the places along the edge that are tried. Chosen: what the arm reaches changes within it."""
APART = 0.03
"""Least gap [m] to what stands there."""


def edge_spots(
    held: GraspedObject, edge: Edge, taken: Sequence[tuple[float, float, float]], forward: float
) -> list[Placement]:
    """Placements over an edge, those easiest to reach first; empty where the object would tip.

    `taken`: middles and radii (x, y, radius) [m] of what stands there, base frame; `forward`: where the arm stands [m].
    """
    radius, approach = max(held.size[:2]) / 2, held.rotation[:, 2]
    was, inward = math.atan2(approach[1], approach[0]), math.atan2(-edge.outward[1], -edge.outward[0])
    reach, found = edge.half - radius, []
    for turn in HEADINGS:
        delta = inward + turn - was
        c, s = math.cos(delta), math.sin(delta)
        ahead = held.offset[:2] + PAD * approach[:2]
        tips = np.array([c * ahead[0] - s * ahead[1], s * ahead[0] + c * ahead[1]])
        inset = float(edge.outward @ tips) - FINGER_HALF * abs(math.sin(turn)) - ROOM
        if inset < INSET:
            continue
        steps = int(max(0.0, reach) / BESIDE)
        for n in range(-steps, steps + 1):
            x, y = edge.point(inset, n * BESIDE)
            if all(math.hypot(x - ox, y - oy) > radius + other + APART for ox, oy, other in taken):
                off = abs(math.remainder(math.atan2(y, x - forward) - inward - turn, math.tau))
                found.append((off + 0.3 * abs(turn), ((x, y), inward + turn)))
    return [placement for _, placement in sorted(found)]
