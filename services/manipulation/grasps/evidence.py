"""What was seen of an object against what its shape family makes of it: where a grasp has something to hold. Pure."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, cKDTree

from common.geometry import Array
from services.manipulation.grasps.antipodal import LEAST_SHARE, SLOPING
from services.manipulation.grasps.clearance import PAD, PAD_HALF
from services.manipulation.grasps.grasp import CERTAIN, Grasp
from services.manipulation.grasps.pads import contact_at
from services.manipulation.grasps.revolved import revolved
from services.manipulation.grasps.surface import own_points, surface
from services.manipulation.grasps.target import Target
from services.manipulation.grasps.vessel import all_around

OFF, UNEXPLAINED = 0.008, 0.1
"""How far [m] from the completed surface a seen point is of something else, and the share of such points from which the
shape does not explain the object. Measured over drawn objects: boxes, cans, bottles, bowls have .00 to .04, mugs with
their handle .08; a wedge taken for a can, a teapot taken for one that lies, a bracket taken for a bowl .10 to .25."""
STRAYS = 0.02
"""Share of the points that may lie outside the extents: mixed pixels at the edge of a thing."""
HOLE, FILLED = 0.5, 0.05
"""Share of the radius within which a ring is open, and the least share of the points there of what is not: of an even
upper side a quarter lies there."""
WITHIN, BELOW, INSIDE = 0.5, 0.015, 0.25
"""Share of the half extents of a box that is its middle, how far [m] below its top what was seen there is its inside,
and the share of such points from which it is open: of a lid one sees nothing but its upper face."""
PER_CELL, COVERED = 4, 0.8
"""Points for each cell into which the upper face of a flat box is divided, and the share of cells with some from which
it was seen: of the rectangle around a spatula two thirds."""
BESIDE, BEFORE = 0.006, 0.045
"""How far [m] beside the pads, and before their middle, what is seen counts as between them: points lie 7 mm apart, and
of what the hand comes to from its seen side only the front may be seen."""
LEAST_SEEN, SPANNED = 4, 0.3
"""Fewest seen points between the pads, or of a part of its own, and the least share of the width that they span: of
something round that is taken from its far side half is seen."""


def explained(target: Target) -> bool:
    """The shape family accounts for what was seen; True of what was not measured, and of what lies: without its axis it
    could not be stood up.
    """
    if target.points is None or not target.measured or target.lies or target.shape in ("", "irregular"):
        return True
    if target.shape == "bowl" and not all_around(target.points):
        return False
    if target.shape in ("round", "bowl") and _is_ring(target.points, target.size):
        return False
    if target.shape == "box" and (_is_open(target) or _covered(target) < COVERED):
        return False
    return float(np.mean(_beside_shape(target))) < UNEXPLAINED


def has_parts(target: Target) -> bool:
    """Something of a measured object, as a handle, was seen where its completed shape has no surface."""
    return target.measured and target.points is not None and int(_beside_shape(target).sum()) >= LEAST_SEEN


def _beside_shape(target: Target) -> NDArray[np.bool_]:
    """Which of the points (n,) are of something else than the completed surface."""
    assert target.points is not None
    distance, _ = cKDTree(surface(target)).query(target.points + np.array(target.position))
    found: NDArray[np.bool_] = distance > OFF
    return found


def _is_ring(points: Array, size: tuple[float, float, float]) -> bool:
    """Something low and round of which nothing was seen in the middle, where one looks at its upper side or into it."""
    radius = max(size[:2]) / 2
    middle = np.hypot(points[:, 0], points[:, 1]) < HOLE * radius
    return size[2] < radius and bool(np.mean(middle) < FILLED)


def _is_open(target: Target) -> bool:
    """A box that was seen into from above: a tray, a basket with a hoop over it."""
    seen, half = own_points(target), np.array(target.size) / 2
    middle = seen[(np.abs(seen[:, :2]) < WITHIN * half[:2]).all(axis=1), 2]
    return len(middle) >= LEAST_SEEN and float(np.mean(middle < half[2] - BELOW)) > INSIDE


def _covered(target: Target) -> float:
    """Share of the upper face of a flat box on which something was seen; 1 of what is not flat."""
    level = np.array(target.size[:2])
    if target.size[2] > level.min() / 2:
        return 1.0
    seen = own_points(target)[:, :2]
    cells = np.maximum(1, level / math.sqrt(PER_CELL * float(np.prod(level)) / len(seen))).astype(int)
    index = np.clip(np.floor((seen / level + 0.5) * cells), 0, cells - 1)
    return len(np.unique(index, axis=0)) / int(np.prod(cells))


def believed(target: Target) -> Target:
    """The object with its measured shape, turned about the axis that its outline tells, or as it was seen where that
    does not explain it: what is open from above has its walls and hoops only."""
    turned = revolved(target)
    if turned is not None and explained(turned):
        return turned
    if explained(target):
        return target
    found = as_seen(target)
    return replace(found, shape="long") if target.shape == "box" and _is_open(target) else found


def as_seen(target: Target) -> Target:
    """The object without what a shape family makes of it: the extents of its points."""
    assert target.points is not None
    yaw, middle, extents = _rectangle(target.points[:, :2])
    x, y, z = target.position
    moved = target.points - (*middle, 0.0)
    return replace(
        target, shape="irregular", position=(x + float(middle[0]), y + float(middle[1]), z), yaw=yaw, points=moved,
        size=(float(extents[0]), float(extents[1]), target.size[2]),
    )  # fmt: skip


def _rectangle(plan: Array) -> tuple[float, Array, Array]:
    """Yaw [rad], middle (2,) and extents (2,) [m], the longer first, of the least rectangle around points (n, 2)."""
    best = (math.inf, 0.0, np.zeros(2), np.zeros(2))
    corners = plan[ConvexHull(plan).vertices]
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        yaw = math.atan2(b[1] - a[1], b[0] - a[0])
        turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
        low, high = np.quantile(plan @ turn, (STRAYS, 1.0 - STRAYS), axis=0)
        if float(np.prod(high - low)) < best[0]:
            best = float(np.prod(high - low)), yaw, turn @ ((low + high) / 2), high - low
    _, yaw, middle, extents = best
    if extents[1] > extents[0]:
        yaw, extents = yaw + math.pi / 2, extents[::-1]
    return math.remainder(yaw, math.pi), middle, extents


def seen_between(target: Target, grasp: Grasp) -> bool:
    """Something of the object was seen where the fingers close.

    True of what was not measured, or whose shape is certain, and of a rim, one side of whose wall is hidden.
    """
    certain = target.spread <= CERTAIN and target.family != "irregular"
    if target.points is None or not target.measured or certain or grasp.rim:
        return True
    local = (target.points + np.array(target.position) - grasp.pose.position) @ grasp.pose.rotation
    near = (np.abs(local[:, 0]) < PAD_HALF + BESIDE) & (local[:, 2] < PAD + BESIDE) & (local[:, 2] > -BEFORE)
    across = local[near & (np.abs(local[:, 1]) < grasp.width / 2 + BESIDE), 1]
    return len(across) >= LEAST_SEEN and float(np.ptp(across)) >= SPANNED * grasp.width


def as_held(target: Target, points: Array, grasp: Grasp) -> Grasp | None:
    """A grasp by rule of a measured object with the width that it has there; None where the pads find no hold.

    `points` (n, 3): its completed surface. What is taken at a rim or over an edge stays as it is: there one pad is
    inside or below the object.
    """
    if target.points is None or not target.measured or grasp.rim or grasp.over_edge:
        return grasp
    contact = contact_at(points, grasp.pose)
    if contact is None or contact.share < LEAST_SHARE or contact.slope > SLOPING:
        return None
    return replace(grasp, width=min(grasp.width, contact.width))
