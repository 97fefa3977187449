"""Which way the narrow parts of something lie: handles, wires, blades are taken across, however the whole of it lies.

Pure.
"""

import math

import numpy as np
from scipy.spatial import cKDTree

from common.geometry import Array

AROUND, SAMPLES = 0.03, 150
"""How far [m] around a place of it a part is looked at, about as far as pads reach, and at how many places."""
LONGER = 2.0
"""How many times as long as wide, as a ratio of variances, a part is at least: of what is as wide as one looks 1."""
BESIDE = 0.004
"""How far [m] the middle of what is around a place may be from it across the part: beyond, it is an edge of something
wide."""
SECTOR, MOST, LEAST = math.radians(15), 3, 0.04
"""Directions nearer than this [rad] are one; how many are told, and in which share of the places each is seen."""


def across_parts(points: Array) -> list[float]:
    """The level directions [rad], either way, across narrow parts of a surface of points (n, 3), commonest first."""
    plan = np.unique(np.round(points[:, :2], 3), axis=0)
    tree, found = cKDTree(plan), []
    for place in plan[:: max(1, len(plan) // SAMPLES)]:
        near = plan[tree.query_ball_point(place, AROUND)]
        values, axes = np.linalg.eigh(np.cov(near.T)) if len(near) > 2 else (np.ones(2), np.eye(2))
        if values[1] > LONGER * values[0] and abs(float((near.mean(axis=0) - place) @ axes[:, 0])) < BESIDE:
            found.append(math.atan2(axes[1, 0], axes[0, 0]))
    told: list[float] = []
    left = np.array(found)
    while len(told) < MOST and len(left):
        apart = np.abs((left[:, None] - left + math.pi / 2) % math.pi - math.pi / 2)
        most = int((apart < SECTOR / 2).sum(axis=1).argmax())
        alike = apart[most] < SECTOR / 2
        if alike.sum() < LEAST * SAMPLES:
            break
        turns = (left[alike] - left[most] + math.pi / 2) % math.pi - math.pi / 2
        told.append(math.remainder(float(left[most] + turns.mean()), math.pi))
        left = left[apart[most] >= SECTOR]
    return told
