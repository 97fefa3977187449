"""An RGB-D image with where it was taken from, as points in frame map. Pure."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, Pose2, quat_matrix, yaw_matrix
from common.messages import Rgbd
from common.robot.pictures import colours, depths
from services.perception.views import colour

# Rows and columns
Window = tuple[slice, slice]
NEAR = 0.05
"""Depth [m] below which the projection of a corner says nothing: the window is then the whole picture."""


@dataclass(frozen=True)
class View:
    """`rgb` (h, w, 3) uint8, `depth` (h, w) [m] with 0 for nothing; `position` (3,) and `rotation` (3, 3) of the
    optical frame (x right, y down, z forward) in frame map; `calibrated`: measured by `tidybot calibrate`."""

    rgb: NDArray[np.uint8]
    depth: NDArray[np.float32]
    focal: tuple[float, float]
    middle: tuple[float, float]
    position: Array
    rotation: Array
    t: float = 0.0
    camera: str = "head"
    calibrated: bool = False

    @property
    def shape(self) -> tuple[int, int]:
        h, w = self.depth.shape
        return h, w

    @property
    def everywhere(self) -> Window:
        return slice(0, self.shape[0]), slice(0, self.shape[1])

    @cached_property
    def points(self) -> NDArray[np.float32]:
        """Where each pixel's surface is (h, w, 3) in frame map; meaningless where depth is 0. x, y and z each lie
        together in memory."""
        h, w = self.shape
        u = (np.arange(w, dtype=np.float32) + 0.5 - self.middle[0]) / self.focal[0]
        v = (np.arange(h, dtype=np.float32) + 0.5 - self.middle[1]) / self.focal[1]
        rotation, position = self.rotation.astype(np.float32), self.position.astype(np.float32)
        planes = np.empty((3, h, w), np.float32)
        for plane, (right, down, ahead), start in zip(planes, rotation, position, strict=True):
            np.add(u * right, (v * down)[:, None], out=plane)
            plane += ahead
            plane *= self.depth
            plane += start
        return np.moveaxis(planes, 0, -1)

    @cached_property
    def light(self) -> Array:
        """Gains (3,) that make up for what light and camera make of the picture's colours."""
        return colour.light(self.rgb)

    def project(self, points: Array) -> Array:
        """Pixel u, v and depth (n, 3) of points (n, 3) in frame map; depth <= 0 is behind the camera."""
        local = (points - self.position) @ self.rotation
        z = np.where(np.abs(local[:, 2]) > 1e-6, local[:, 2], 1e-6)
        u = local[:, 0] / z * self.focal[0] + self.middle[0]
        v = local[:, 1] / z * self.focal[1] + self.middle[1]
        return np.stack([u, v, local[:, 2]], axis=1)

    def window(self, points: Array) -> Window:
        """Rows and columns in which anything between the points (n, 3) in frame map is seen."""
        u, v, z = self.project(points).T
        if z.max() <= 0.0:
            return slice(0, 0), slice(0, 0)
        if z.min() < NEAR:
            return self.everywhere
        h, w = self.shape
        return _span(v, h), _span(u, w)


def _span(values: Array, size: int) -> slice:
    low, high = math.floor(values.min()) - 1, math.ceil(values.max()) + 2
    return slice(min(max(low, 0), size), min(max(high, 0), size))


def view_of(image: Rgbd, base: Pose2) -> View:
    """The view of an image taken with the base at `base`.

    Raises:
        ValueError: the image's data do not have its size.
    """
    turn = yaw_matrix(base[2])
    return View(
        rgb=colours(image),
        depth=depths(image),
        focal=(image.fx, image.fy),
        middle=(image.cx, image.cy),
        position=turn @ np.array(image.position) + np.array([base[0], base[1], 0.0]),
        rotation=turn @ quat_matrix(image.orientation),
        t=image.t,
        camera=image.camera,
        calibrated=image.calibrated,
    )
