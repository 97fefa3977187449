"""The whole of something irregular that stands, from its front: each slice of it is an oval, as wide as it was seen and
as deep as it bulges towards the eye. Pure.

What reaches out over its foot, as the head of a spray bottle does, has nothing under it; a handle is an oval beside
that of the body.
"""

import math

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from common.geometry import Array

BAND, LEVELS = 0.010, 3
"""Height [m] of a slice, two rows of the points that are told, and at how many heights of it points lie. Chosen: half a
pad's width; with more a drip pan is a drum, which pads slide off."""
FEWEST = 4
"""Points from which a slice tells its outline; one with fewer is as the nearest that does."""
APART = 0.018
"""Gap [m] from which two parts of a slice are two: of the points 7 mm apart, which are left over of a surface, hardly
two neighbours lie so far from each other."""
EDGE = 0.002
"""How far [m] the outline lies beyond the outermost point that was seen: half of the cells in which points are told."""
DEEP = (0.5, 1.2)
"""Depth of an oval by its width, at least and at most: how far a flat front goes back is not seen."""
BULGE = 0.2
"""How far back, by its half depth, an oval has to be seen to tell that: to where it turns away from the eye."""


def slices(seen: Array, away: Array, height: float, spacing: float) -> Array:
    """Points (n, 3) [m] of a body, `spacing` apart, of which `seen` (m, 3) was seen; its middle height is 0.

    `away` (2,): the level direction from the eye to it; `height` [m]: from its underside to its top.
    """
    across = np.array([-away[1], away[0]])
    local = np.stack([seen[:, :2] @ across, seen[:, :2] @ away, seen[:, 2]], axis=1)
    count = max(1, math.ceil(height / BAND))
    middles = -height / 2 + (np.arange(count) + 0.5) * height / count
    outlines = [_ovals(local[np.abs(local[:, 2] - z) <= height / count / 2 + 1e-9]) for z in middles]
    told = [n for n, ovals in enumerate(outlines) if ovals]
    found = []
    for n, z in enumerate(middles):
        nearest = min(told, key=lambda m: abs(m - n), default=None)
        for oval in outlines[nearest] if nearest is not None else ():
            for level in np.linspace(-0.5, 0.5, LEVELS):
                found.append(_filled(oval, z + level * height / count, spacing, full=abs(level) == 0.5))
    if not found:
        return np.empty((0, 3))
    body = np.concatenate(found)
    return np.column_stack([np.outer(body[:, 0], across) + np.outer(body[:, 1], away), body[:, 2]])


def _ovals(points: Array) -> list[tuple[float, float, float, float]]:
    """Middle (across, away) and half width and depth [m] of the parts of a slice with points (n, 3)."""
    if len(points) < FEWEST:
        return []
    found = []
    for part in _parts(points):
        low, high = float(part[:, 0].min()), float(part[:, 0].max())
        middle, half = (low + high) / 2, (high - low) / 2
        # How far back from its front an oval is there, by its half depth.
        back = 1.0 - np.sqrt(np.maximum(0.0, 1.0 - ((part[:, 0] - middle) / max(half, EDGE)) ** 2))
        bulge = np.polyfit(back, part[:, 1], 1)[0] if np.ptp(back) > BULGE else 0.0
        half += EDGE
        deep = min(max(float(bulge), DEEP[0] * half), DEEP[1] * half)
        found.append((middle, float(np.median(part[:, 1] - deep * back)) + deep, half, deep))
    return found


def _parts(points: Array) -> list[Array]:
    """Points (n, 3) of a slice by what hangs together on the floor plan."""
    pairs = cKDTree(points[:, :2]).query_pairs(APART, output_type="ndarray")
    count = len(points)
    graph = coo_matrix((np.ones(len(pairs)), tuple(pairs.T)), (count, count))
    number, part = connected_components(graph, directed=False)
    return [points[part == n] for n in range(number)]


def _filled(oval: tuple[float, float, float, float], z: float, spacing: float, full: bool) -> Array:
    """Points (n, 3) of the outline of an oval at a height, or `full` of what is within as well."""
    x, y, half, deep = oval
    rings = max(1, math.ceil(max(half, deep) / spacing)) if full else 1
    found = []
    for n in range(rings):
        share = (n + 1) / rings if full else 1.0
        steps = max(6, math.ceil(math.tau * share * max(half, deep) / spacing))
        turn = np.linspace(0.0, math.tau, steps, endpoint=False)
        found.append(np.stack([x + share * half * np.cos(turn), y + share * deep * np.sin(turn), np.full(steps, z)], 1))
    return np.concatenate(found)
