"""An RGB-D picture as floor, obstacles and patches of level surfaces in the base frame. Pure.

The floor in the picture says how the camera really sits: its height, pitch and roll are corrected by the plane that
fits it, so that a bracket a third of a degree off does not put a table one centimetre wrong.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common import messages as m
from common.approach import FOOTPRINT
from common.geometry import Array, cell_means, quat_matrix
from common.robot.pictures import PictureError, depths, rays

FLOOR_BAND = 0.06
"""Height [m] within which a pixel may be the floor before the camera's tilt is corrected: 1.5 degrees at 2 m."""
NOISE = 0.0015
"""Standard deviation of depth at 1 m [m], growing with its square. Source: datasheet of stereo cameras (D435)."""
ABOVE, HIGHEST = 0.05, 1.45
"""Heights [m] between which something is in the robot's way: above the noise of the floor, below its mast's top."""
FAR = 3.2
"""Depth [m] beyond which nothing is concluded: its noise is 1.5 cm and pixels are farther apart than cells."""
LEVEL = 0.93
"""Least vertical part of a level surface's normal [-]; chosen: 20 degrees, what the noise at 2.5 m makes of a table."""
SAME_HEIGHT = 0.012
"""Difference of height [m] of pixels at the edge of a level surface: its noise at 2 m, seen at 35 degrees."""
LEVEL_FAR = 2.6
"""Depth [m] up to which normals say anything."""
SPAN = 3
"""Pixels between the two that a normal is taken from, to either side [count]: less noise, still inside a table."""
LOW, HIGH = 0.15, 1.35
"""Heights [m] of surfaces that things are put on."""
PATCH = 0.025
"""Side [m] of the cells that the points of a level surface are merged to."""
MAX_VALUE = 1e6
"""What no camera's numbers reach [pixels, m]."""
FLOOR_POINTS = 400
"""Pixels of floor without which nothing is corrected [count]."""


@dataclass(frozen=True)
class Picture:
    """Points of a picture in the base frame [m]: `floor` (n, 2), `above` (k, 3) in the robot's way, `level` (l, 3) of
    level surfaces, `low` (j, 3) points of what is lower than 0.6 m, merged as `level`, for bins."""

    floor: Array
    above: Array
    level: Array
    low: Array


class CameraModel:
    """Turns pictures into points, without the robot's own body, which looks the same whichever way the base heads."""

    MINIMUM = 6
    OWN, SAME = 1.15, 0.03
    GROWN = 4

    def __init__(self) -> None:
        self._nearest: NDArray[np.float32] | None = None
        self._farthest: NDArray[np.float32] | None = None
        self._count = 0

    def learn(self, image: m.Rgbd) -> None:
        """Take a picture from another heading, to learn which pixels show the robot itself; raises as `read`."""
        depth = _checked(image)
        near, far = np.where(depth > 0, depth, np.inf), np.where(depth > 0, depth, -np.inf)
        if self._nearest is None or self._nearest.shape != depth.shape:
            self._nearest, self._farthest, self._count = near, far, 1
            return
        assert self._farthest is not None
        np.minimum(self._nearest, near, out=self._nearest)
        np.maximum(self._farthest, far, out=self._farthest)
        self._count += 1

    @property
    def learned(self) -> bool:
        """True once pictures from enough headings were taken."""
        return self._count >= self.MINIMUM

    def own(self, shape: tuple[int, int]) -> NDArray[np.bool_]:
        """Mask (h, w) of the pixels that show the robot itself."""
        if self._nearest is None or self._farthest is None or self._nearest.shape != shape or not self.learned:
            return np.zeros(shape, bool)
        same = (self._farthest - self._nearest < self.SAME) & (self._farthest < self.OWN) & np.isfinite(self._nearest)
        same = ndimage.binary_opening(same, np.ones((3, 3)))
        # Where a matcher finds no depth around the body belongs to it, too.
        return np.asarray(ndimage.binary_dilation(same, np.ones((3, 3)), iterations=self.GROWN))

    def read(self, image: m.Rgbd) -> Picture:
        """The points that a picture shows.

        Raises:
            PictureError: its data do not have its size, or what a camera does not have.
        """
        depth = _checked(image)
        depth = np.where(self.own(depth.shape), 0.0, depth)
        points = (rays(image) * depth[..., None]) @ quat_matrix(image.orientation).T + np.array(image.position)
        # What is where the base stands is the robot, whatever the mask of its own pixels has missed at the arm's rim.
        seen = (depth > 0.0) & (depth < FAR) & (np.hypot(points[..., 0], points[..., 1]) > FOOTPRINT)
        points = _levelled(points, seen, np.array(image.position))
        height = points[..., 2]
        noise = 3.0 * NOISE * np.square(depth)
        floor = seen & (np.abs(height) < 0.02 + noise)
        above = seen & (height > ABOVE + noise) & (height < HIGHEST)
        low = seen & (height < 0.6) & (depth < 2.0)
        level = _level(points, seen & (depth < LEVEL_FAR) & (height > LOW) & (height < HIGH))
        return Picture(*(_merged(p) for p in (points[floor][:, :2], points[above], points[level], points[low])))


def _checked(image: m.Rgbd) -> NDArray[np.float32]:
    """Depth (h, w) [m] of a picture; raises `PictureError` for one without a focal length, a pose or all its pixels."""
    numbers = (image.cx, image.cy, *image.position, *image.orientation)
    if not (0.0 < image.fx < MAX_VALUE and 0.0 < image.fy < MAX_VALUE and all(abs(v) < MAX_VALUE for v in numbers)):
        raise PictureError("a picture without a focal length or a pose")
    return depths(image)


def _level(points: Array, seen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Pixels (h, w) of level surfaces, up to their edges: where no normal can be had, by the height beside them."""
    inner = seen & (_rising(points, seen) > LEVEL)
    size = 2 * SPAN + 3
    share = ndimage.uniform_filter(inner.astype(float), size)
    beside = ndimage.uniform_filter(np.where(inner, points[..., 2], 0.0), size) / np.maximum(share, 1e-9)
    edge = seen & (share > 2.5 / size**2) & (np.abs(points[..., 2] - beside) < SAME_HEIGHT)
    return np.asarray(inner | edge)


def _levelled(points: Array, seen: NDArray[np.bool_], eye: Array) -> Array:
    """Points (h, w, 3) turned about the camera and shifted so that the floor lies at height 0."""
    band = seen & (np.abs(points[..., 2]) < FLOOR_BAND)
    if band.sum() < FLOOR_POINTS:
        return points
    floor = points[band][::3]
    plane = np.zeros(3)
    for limit in (FLOOR_BAND, 0.02, 0.02):
        near = np.abs(floor[:, 2] - floor @ (plane[0], plane[1], 0.0) - plane[2]) < limit
        if near.sum() < FLOOR_POINTS // 6:
            return points
        design = np.column_stack([floor[near, :2], np.ones(near.sum())])
        weight = 1.0 / np.maximum(np.hypot(*(floor[near, :2] - eye[:2]).T), 0.5) ** 2
        plane = np.linalg.lstsq(design * weight[:, None], floor[near, 2] * weight, rcond=None)[0]
    normal = np.array([-plane[0], -plane[1], 1.0])
    normal /= np.linalg.norm(normal)
    # The smallest rotation that stands the floor's normal upright.
    axis = np.cross(normal, (0.0, 0.0, 1.0))
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = np.eye(3) + k + k @ k / (1.0 + normal[2])
    turned = (points - eye) @ turn.T + eye
    foot = np.array([eye[0], eye[1], plane @ (eye[0], eye[1], 1.0)])
    turned[..., 2] -= (turn @ (foot - eye) + eye)[2]
    return np.asarray(turned)


def _rising(points: Array, seen: NDArray[np.bool_]) -> Array:
    """The vertical part (h, w) of each pixel's normal, 0 where there is none."""
    found = np.zeros(seen.shape)
    n = SPAN
    right = points[n:-n, 2 * n :] - points[n:-n, : -2 * n]
    down = points[2 * n :, n:-n] - points[: -2 * n, n:-n]
    normal = np.cross(right, down)
    length = np.linalg.norm(normal, axis=-1)
    whole = seen[n:-n, 2 * n :] & seen[n:-n, : -2 * n] & seen[2 * n :, n:-n] & seen[: -2 * n, n:-n]
    found[n:-n, n:-n] = np.where(whole & (length > 0), np.abs(normal[..., 2]) / np.maximum(length, 1e-12), 0.0)
    return found


def _merged(points: Array) -> Array:
    """One point (k, d), the mean, for each cell of PATCH that holds some of the points (n, d)."""
    return cell_means(points, PATCH)[0] if len(points) else np.empty((0, points.shape[1]))
