"""The axis of something turned, as a funnel or a candlestick, by its outline at each height: where it is half as wide
as it looks behind its front. Pure.

A circle fitted to what was seen at all heights is right for what is a cylinder only: of a funnel's spout it makes a
cylinder about an axis 10 mm behind it.
"""

from dataclasses import replace

import numpy as np

from common.geometry import Array, yaw_matrix
from services.manipulation.grasps.slices import BAND, EDGE
from services.manipulation.grasps.surface import away, own_points
from services.manipulation.grasps.target import Target

FEWEST, SLICES = 6, 4
"""Points of a slice whose outline tells a circle, and how many slices do."""
STRAYS, FRONT = 0.02, 0.1
"""Shares of the points of a slice that may be mixed pixels beside it, and before its front."""
MIDDLE = 1 / 3
"""Share of its half width, to either side, in which a slice has its front."""
AGREE, MOST = 0.004, 0.8
"""How far [m] the axis of a slice may be from that of all, and the share of slices of which it is not farther.
Measured over drawn objects: of what is turned 2 mm, of figures, taps and handles 6 to 20."""
MOVED = 0.003
"""How far [m] an axis has to be from where it was believed to be told anew: more than the error of a slice."""


def revolved(target: Target) -> Target | None:
    """The object as a surface of revolution about the axis that its outline tells; None where that tells none, or the
    one that is known.
    """
    if target.points is None or not target.measured or target.tilt or target.family not in ("round", "irregular"):
        return None
    circles = _circles(target)
    if len(circles) < SLICES:
        return None
    axis = np.median(circles[:, :2], axis=0)
    agree = (np.abs(circles[:, :2] - axis) <= AGREE).all(axis=1)
    off = float(np.hypot(*axis))
    if agree.mean() < MOST or (target.family == "round" and off < MOVED):
        return None
    wide, ahead = 2 * float(circles[agree, 2].max()), away(target)
    shift = yaw_matrix(target.yaw)[:2, :2] @ (axis[0] * np.array([-ahead[1], ahead[0]]) + axis[1] * ahead)
    x, y, z = target.position
    return replace(
        target, shape="round", position=(x + float(shift[0]), y + float(shift[1]), z),
        size=(wide, wide, target.size[2]), points=target.points - (*shift, 0.0),
    )  # fmt: skip


def _circles(target: Target) -> Array:
    """Axis (across and along the view) and radius (n, 3) [m] by slices of what was seen."""
    seen, ahead, height = own_points(target), away(target), target.size[2]
    across, deep = seen[:, :2] @ (-ahead[1], ahead[0]), seen[:, :2] @ ahead
    found = []
    for low in np.arange(-height / 2, height / 2, BAND):
        there = (seen[:, 2] >= low) & (seen[:, 2] < low + BAND)
        if there.sum() < FEWEST:
            continue
        left, right = np.quantile(across[there], (STRAYS, 1.0 - STRAYS))
        middle, radius = (left + right) / 2, (right - left) / 2
        before = deep[there][np.abs(across[there] - middle) < MIDDLE * radius]
        if len(before):
            found.append((middle, float(np.quantile(before, FRONT)) + radius + EDGE, radius + EDGE))
    return np.array(found).reshape(-1, 3)
