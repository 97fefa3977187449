"""The sides of an object as seen straight on: faces of a box, what goes around a round thing, flattened. Pure.

Letters on a face that is turned away, or around a can, are squeezed; where the object is and how large says how.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Array, quat_matrix
from common.kinds import kind_of
from common.messages import WorldObject

Picture = NDArray[np.uint8]
FACING = 0.30
"""Cosine of the angle between a face and the line of sight from which its print can be read: 72 degrees."""
AROUND = 1.15
"""Angle [rad] to either side of the line of sight up to which what is on a round thing can be read."""
FINER = 2.0
"""Pixels of a flattened side for one of the picture: what resampling takes of the letters' edges is not missed."""
UPRIGHT = np.array([0.0, 0.0, 2.0])
"""What is above on a slanting side is rather what is higher than what is farther away."""
LONGEST = 640
"""Most pixels along a flattened side. Chosen: a page held before the camera needs no more."""


@dataclass(frozen=True)
class Lens:
    """Where a cut-out picture was taken from: `position` (3,) and `rotation` (3, 3) of the optical frame (x right, y
    down, z forward) in frame map, `focal` [px], `middle` (u, v) of the optical axis in the cut-out."""

    position: Array
    rotation: Array
    focal: tuple[float, float]
    middle: tuple[float, float]

    def pixels(self, points: Array) -> tuple[Array, Array]:
        """Rows and columns (...,) of points (..., 3) in frame map, which are before the camera."""
        local = (points - self.position) @ self.rotation
        depth = np.maximum(local[..., 2], 0.05)
        return (
            local[..., 1] / depth * self.focal[1] + self.middle[1],
            local[..., 0] / depth * self.focal[0] + self.middle[0],
        )


def flattened(rgb: Picture, lens: Lens, o: WorldObject) -> list[Picture]:
    """The sides of an object in a cut-out `rgb` (h, w, 3), that which faces the camera most first."""
    found = []
    density = FINER * lens.focal[0] / max(0.1, float(np.linalg.norm(np.array(o.position) - lens.position)))
    for surface in sorted(_surfaces(o, lens.position), key=lambda s: -s.facing):
        across, along = (max(8, min(LONGEST, round(density * length))) for length in (surface.width, surface.height))
        a, b = np.meshgrid((np.arange(across) + 0.5) / across, (np.arange(along) + 0.5) / along)
        rows, columns = lens.pixels(surface.points(a, b))
        found.append(_sampled(rgb, rows, columns))
    return found


@dataclass(frozen=True)
class _Surface:
    """A side `width` x `height` [m], `facing` the camera by the cosine of the angle between.

    A flat one has its upper left at `corner` and goes `across` and `down`, unit vectors (3,). One of `radius` [m] goes
    around an axis with its upper end at `corner`: it begins in the direction `across` and turns to `aside`.
    """

    width: float
    height: float
    facing: float
    corner: Array
    across: Array
    down: Array
    aside: Array
    radius: float = 0.0

    def points(self, a: Array, b: Array) -> Array:
        """Points (..., 3) [map] at shares `a` of the width and `b` of the height."""
        fallen = self.corner + b[..., None] * self.height * self.down
        if not self.radius:
            return np.asarray(fallen + a[..., None] * self.width * self.across)
        angle = a * self.width / self.radius
        out = np.cos(angle)[..., None] * self.across + np.sin(angle)[..., None] * self.aside
        return np.asarray(fallen + self.radius * out)


def _surfaces(o: WorldObject, eye: Array) -> Iterator[_Surface]:
    turn, middle = quat_matrix(o.orientation), np.array(o.position)
    half = np.array(o.size) / 2
    if kind_of(o.kind).shape == "turned":
        yield from _wall(turn, middle, half, eye, lying=o.tilt > 0.6)
        return
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal = sign * turn[:, axis]
            centre = middle + half[axis] * normal
            sight = eye - centre
            facing = float(normal @ sight / np.linalg.norm(sight))
            if facing < FACING:
                continue
            # Upright as the camera sees it: down is that side of the face that points down most, or to the camera.
            sides = [(i, s * turn[:, i]) for i in range(3) if i != axis for s in (-1.0, 1.0)]
            level = np.array([sight[0], sight[1], 0.0]) / max(1e-6, float(np.hypot(*sight[:2])))
            down_axis, down = max(sides, key=lambda row: float(row[1] @ (level - UPRIGHT)))
            across_axis = 3 - axis - down_axis
            across = np.cross(normal, down)
            corner = centre - half[across_axis] * across - half[down_axis] * down
            yield _Surface(
                2 * half[across_axis], 2 * half[down_axis], facing, corner, across, down, np.zeros(3)
            )  # fmt: skip


def _wall(turn: Array, middle: Array, half: Array, eye: Array, lying: bool) -> Iterator[_Surface]:
    """The part of the wall of a round thing that faces the camera."""
    axis = 0 if lying else 2
    up = turn[:, axis]
    radius, tall = (float(half[1]), float(half[0])) if lying else (float(half[:2].mean()), float(half[2]))
    sight = eye - middle
    aside = sight - (sight @ up) * up
    distance = float(np.linalg.norm(aside))
    if distance < 1.2 * radius:
        return
    front = aside / distance
    right = np.cross(up, front)
    left = math.cos(AROUND) * front - math.sin(AROUND) * right
    beside = math.sin(AROUND) * front + math.cos(AROUND) * right
    facing = distance / float(np.linalg.norm(sight))
    yield _Surface(2 * AROUND * radius, 2 * tall, facing, middle + tall * up, left, -up, beside, radius)


def _sampled(rgb: Picture, rows: Array, columns: Array) -> Picture:
    """The picture at fractional rows and columns (h, w)."""
    planes = [
        ndimage.map_coordinates(rgb[..., k], [rows - 0.5, columns - 0.5], order=1, mode="nearest") for k in range(3)
    ]
    return np.stack(planes, axis=-1)
