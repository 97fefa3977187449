"""Surfaces that pictures are registered with: the arm by its description, the room by another camera. Pure."""

from collections.abc import Sequence
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial.transform import Rotation

from cli.cameras.shot import Mount, Shot
from common.geometry import Array, quat_matrix
from common.messages import Rgbd
from common.rendering.raycast import cast
from common.robot.joints import ARM
from common.robot.model import RobotKinematics, arm_limits, home_arm, subtree
from common.robot.pictures import depths, rays

SMOOTH, JUMP = 7, 0.03
"""Side [px] of the window over which a surface's normal is taken, and change of depth [m] within it that is an edge."""
NEAR_BY = 0.04
"""Steps [m] along a ray that is followed to what another camera saw."""
FROM_LIMIT = 0.03
"""How far [rad] the arm stays from its joints' limits: drives stop before them."""


Match = tuple[Array, Array, NDArray[np.bool_]]
"""Points (n, 3) on the surface and its normals (n, 3) in the base frame, and which of them (n,) hold."""


class Surface(Protocol):
    """A surface that pictures are registered with."""

    def take(self, shot: Shot) -> None:
        """Set the robot's pose to that at the time of the picture."""

    def match(self, origin: Array, directions: Array, points: Array, shape: tuple[int, int]) -> Match:
        """The surface that belongs to each measured point (n, 3), seen from `origin` along unit `directions` (n, 3);
        `shape` (h, w) of the picture that they make, n = h w."""


class Arm(RobotKinematics):
    """The arm and hand as surfaces; `lowest` and `highest` joint angles (7,) [rad], `home` the carry pose (7,)."""

    def __init__(self, mjcf: str) -> None:
        super().__init__(mjcf)
        self._base = int(self.model.body("base").id)
        first = self.model.body(int(self.model.jnt_bodyid[self.model.joint(ARM[0]).id])).name
        self._moving = np.isin(self.model.geom_bodyid, list(subtree(self.model, first)))
        low, high = arm_limits(self.model)
        self.lowest, self.highest = low + FROM_LIMIT, high - FROM_LIMIT
        self.home = home_arm(self.model)

    def collides(self) -> bool:
        """The arm touches the robot or itself."""
        mujoco.mj_collision(self.model, self.data)
        return bool((self.data.contact.dist[: self.data.ncon] < 0.0).any()) if self.data.ncon else False

    def reach(self) -> tuple[float, float]:
        """Lowest point of the arm, and its farthest one from the base's middle [m], by bounding spheres."""
        outer = self._moving
        centres, radii = self.data.geom_xpos[outer], self.model.geom_rbound[outer]
        return float((centres[:, 2] - radii).min()), float((np.hypot(centres[:, 0], centres[:, 1]) + radii).max())

    def cast(self, origin: Array, directions: Array) -> tuple[Array, Array]:
        """Distances (n,) [m] (-1: nothing) and normals (n, 3) along unit `directions` (n, 3) in the base frame."""
        distances, _, normals = cast(self.model, self.data, origin, directions, exclude=self._base)
        return distances, normals

    def take(self, shot: Shot) -> None:
        self.pose(shot.joints, shot.width)

    def match(self, origin: Array, directions: Array, points: Array, shape: tuple[int, int]) -> Match:
        distances, normals = self.cast(origin, directions)
        hit = _inner(distances.reshape(shape) > 0.0).ravel()
        return origin + directions * np.maximum(distances, 0.0)[:, None], normals, hit


class SeenRoom:
    """The room as measured by another camera that does not move, its own `mount` taken into account.

    Of `images` the farthest depth counts: the arm was in front of something else in each.
    """

    def __init__(self, images: Sequence[Rgbd], mount: Mount) -> None:
        image = images[0]
        nominal = quat_matrix(image.orientation)
        self._rotation = nominal @ Rotation.from_rotvec(mount.turn).as_matrix()
        self._position = np.array(image.position) + nominal @ mount.offset
        self._focal, self._middle = (image.fx, image.fy), (image.cx, image.cy)
        ahead = rays(image)
        seen = np.array([depths(each) for each in images], np.float64)
        behind = (seen > 0.0) & (seen > seen.max(axis=0) - JUMP)
        depth = (seen * behind).sum(axis=0) / np.maximum(behind.sum(axis=0), 1)
        smooth = ndimage.median_filter(depth, SMOOTH)
        self._depth = np.where(np.abs(smooth - depth) < JUMP, smooth, 0.0)
        points = (ahead * self._depth[..., None]) @ self._rotation.T + self._position
        across, down = (np.gradient(ndimage.uniform_filter(points, (SMOOTH, SMOOTH, 0)), axis=axis) for axis in (1, 0))
        normals = np.cross(across, down)
        normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-12)
        steady = ndimage.minimum_filter(self._depth, SMOOTH) > 0.0
        steep = ndimage.maximum_filter(self._depth, SMOOTH) - ndimage.minimum_filter(self._depth, SMOOTH)
        self._points, self._normals, self._usable = points, normals, steady & (steep < JUMP)

    def take(self, shot: Shot) -> None:
        """Do nothing: the surface is the same in every picture."""

    def match(self, origin: Array, directions: Array, points: Array, shape: tuple[int, int]) -> Match:
        local = (points - self._position) @ self._rotation
        ahead = local[:, 2] > 0.0
        depth = np.where(ahead, local[:, 2], 1.0)
        u = np.floor(local[:, 0] / depth * self._focal[0] + self._middle[0]).astype(int)
        v = np.floor(local[:, 1] / depth * self._focal[1] + self._middle[1]).astype(int)
        height, width = self._depth.shape
        inside = ahead & (u >= 0) & (u < width) & (v >= 0) & (v < height)
        row, column = np.where(inside, v, 0), np.where(inside, u, 0)
        return self._points[row, column], self._normals[row, column], inside & self._usable[row, column]

    def share(self, origin: Array, directions: Array) -> float:
        """How many of the rays from `origin` (3,) along `directions` (n, 3) in the base frame meet what was seen."""
        met = np.zeros(len(directions), bool)
        for distance in np.arange(0.25, 1.5, NEAR_BY):
            points = origin + directions * distance
            there, _, usable = self.match(origin, directions, points, (1, len(points)))
            met |= usable & (np.linalg.norm(there - points, axis=1) < NEAR_BY)
        return float(met.mean())


def _inner(hit: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """A mask (h, w) without its pixels at the rim."""
    inner = hit.copy()
    inner[1:] &= hit[:-1]
    inner[:-1] &= hit[1:]
    inner[:, 1:] &= hit[:, :-1]
    inner[:, :-1] &= hit[:, 1:]
    return inner
