"""What a click in the 3-D view means: the nearest thing on its ray."""

from dataclasses import dataclass

import numpy as np

from common import messages as m
from common.geometry import Array
from services.dashboard.scene.drawing import Mesh

FLOOR = 0.03
"""Height [m] up to which a clicked point is floor; chosen: what lies flat on it is meant as floor, too."""
REACH = 0.04
"""Least half size [m] of an object for a click; chosen: a finger's width at the usual distance."""
FAR = 60.0
"""Longest ray [m]: flats are smaller."""


@dataclass(frozen=True)
class Picked:
    """An object by its label, or a point of the floor; neither: nothing that can be asked for.

    `hit`: where the ray meets the object, the floor or furniture [m, frame map].
    """

    label: str = ""
    point: tuple[float, float] | None = None
    hit: tuple[float, float, float] | None = None


def pick(origin: Array, direction: Array, flat: Mesh | None, objects: list[m.WorldObject]) -> Picked:
    """The object, or the place on the floor, that a ray hits first; furniture in front hides both."""
    direction = direction / np.linalg.norm(direction)
    blocked = first_hit(origin, direction, flat) if flat is not None else np.inf
    nearest, label = blocked, ""
    for one in objects:
        centre, half = np.array(one.position), np.maximum(np.array(one.size) / 2, REACH)
        distance = _box(origin, direction, centre, half)
        # A little in front of what it stands on is enough: objects are drawn bigger than their beliefs are exact.
        if distance < nearest + (REACH if not label else 0.0):
            nearest, label = distance, one.label
    if label:
        return Picked(label, hit=_at(origin, direction, nearest))
    if not np.isfinite(nearest) and direction[2] < -1e-6 and origin[2] > 0:
        nearest = -origin[2] / direction[2]
    if nearest > FAR:
        return Picked()
    hit = _at(origin, direction, nearest)
    return Picked(point=hit[:2] if abs(hit[2]) < FLOOR else None, hit=hit)


def _at(origin: Array, direction: Array, distance: float) -> tuple[float, float, float]:
    x, y, z = (origin + distance * direction).tolist()
    return x, y, z


def first_hit(origin: Array, direction: Array, mesh: Mesh) -> float:
    """Distance to the first triangle that a ray meets, inf for none; Moeller and Trumbore."""
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    one, two = b - a, c - a
    p = np.cross(direction, two)
    det = np.einsum("ij,ij->i", one, p)
    solid = np.abs(det) > 1e-12
    inverse = np.where(solid, 1.0 / np.where(solid, det, 1.0), 0.0)
    away = origin - a
    u = np.einsum("ij,ij->i", away, p) * inverse
    q = np.cross(away, one)
    v = (q @ direction) * inverse
    t = np.einsum("ij,ij->i", two, q) * inverse
    hits = solid & (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-6)
    return float(t[hits].min()) if hits.any() else float("inf")


def _box(origin: Array, direction: Array, centre: Array, half: Array) -> float:
    """Distance to an upright box, inf when missed; slabs."""
    safe = np.where(np.abs(direction) < 1e-12, 1e-12, direction)
    near, far = (centre - half - origin) / safe, (centre + half - origin) / safe
    enter, leave = float(np.minimum(near, far).max()), float(np.maximum(near, far).min())
    return enter if leave >= max(enter, 0.0) else float("inf")
