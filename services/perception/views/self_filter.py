"""Robot self-filter: which pixels show the robot, and where its hand is, by the model of `robot/description`."""

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull

from common.body_extent import corners
from common.geometry import Array, Mask, Pose2
from common.robot.model import RobotKinematics
from services.perception.views.view import View

STEP = 4
"""Every so many rows and columns of a picture are tested; the gaps are filled [pixels]."""
REACH = 1.1
"""Distance [m] from the base's axis beyond which no part of the robot is."""
MARGIN = 0.025
"""Distance [m] from the robot's geoms up to which pixels are its own. Chosen: errors of depth and of joint angles in
motion."""
ROUNDING = 1e-4
"""More than single precision is off [m] within REACH."""


class RobotModel(RobotKinematics):
    """The robot's geoms as what a picture of it shows."""

    def __init__(self, mjcf: str) -> None:
        super().__init__(mjcf)
        self._faces = {g: _faces(self.model, g) for g in range(self.model.ngeom) if _is_mesh(self.model, g)}
        self.solid = [g for g in range(self.model.ngeom) if self.model.geom_type[g] != mujoco.mjtGeom.mjGEOM_PLANE]

    def hand(self, base: Pose2) -> tuple[float, float, float]:
        """Where the middle between the finger pads is, in frame map."""
        x, y, z = self.data.site("pinch").xpos
        c, s = np.cos(base[2]), np.sin(base[2])
        return float(base[0] + c * x - s * y), float(base[1] + s * x + c * y), float(z)

    def mask(self, view: View, base: Pose2) -> Mask:
        """The pixels (h, w) that show the robot itself."""
        coarse = view.points[::STEP, ::STEP].astype(np.float64)
        c, s = np.cos(base[2]), np.sin(base[2])
        dx, dy = coarse[..., 0] - base[0], coarse[..., 1] - base[1]
        local = np.stack([c * dx + s * dy, c * dy - s * dx, coarse[..., 2]], axis=-1)
        near = (np.hypot(local[..., 0], local[..., 1]) < REACH) & (view.depth[::STEP, ::STEP] > 0)
        own = np.zeros(near.shape, bool)
        own[near] = self._touched(local[near])
        # An edge may run between two of the pixels that were looked at.
        own = ndimage.binary_dilation(own, np.ones((3, 3)))
        h, w = view.shape
        full: Mask = np.repeat(np.repeat(own, STEP, axis=0), STEP, axis=1)[:h, :w]
        return full

    def _touched(self, points: Array) -> Mask:
        """Which of the points (n, 3) in the base frame are within MARGIN of the body's geoms."""
        touched = np.zeros(len(points), bool)
        # A geom is near the points within its bounding sphere only, which single precision and its error tell.
        x, y, z = np.ascontiguousarray(points.T, np.float32)
        centres = self.data.geom_xpos[self.solid].astype(np.float32)
        reaches = (self.model.geom_rbound[self.solid] + (MARGIN + ROUNDING)).astype(np.float32)
        for g, (cx, cy, cz), reach in zip(self.solid, centres, reaches, strict=True):
            few = np.flatnonzero((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2 < reach * reach)
            if len(few):
                touched[few] |= self.distance_to(points[few], g) < MARGIN
        return touched

    def distance_to(self, points: Array, g: int) -> Array:
        """Distance [m] of points (n, 3) in the base frame from a geom."""
        local = (points - self.data.geom_xpos[g]) @ self.data.geom_xmat[g].reshape(3, 3)
        if g in self._faces:
            normals, offsets = self._faces[g]
            return np.asarray(np.maximum((local @ normals.T + offsets).max(axis=1), 0.0))
        return _outside(np.abs(local), int(self.model.geom_type[g]), self.model.geom_size[g])


def _is_mesh(model: mujoco.MjModel, geom: int) -> bool:
    return bool(model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH)


def _faces(model: mujoco.MjModel, geom: int) -> tuple[Array, Array]:
    """Outward normals (k, 3) and offsets (k,) of a mesh's convex hull: inside, every normal @ point + offset <= 0."""
    planes = ConvexHull(corners(model, int(model.geom_dataid[geom]))).equations
    return planes[:, :3], planes[:, 3]


def _outside(local: Array, kind: int, size: NDArray[np.float64]) -> Array:
    """Distance of |x|, |y|, |z| in a geom's frame from its surface, 0 inside."""
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return np.asarray(np.maximum(np.linalg.norm(local, axis=1) - size[0], 0.0))
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        along = np.maximum(local[:, 2] - size[1], 0.0)
        return np.asarray(np.maximum(np.hypot(np.hypot(local[:, 0], local[:, 1]), along) - size[0], 0.0))
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        radial = np.maximum(np.hypot(local[:, 0], local[:, 1]) - size[0], 0.0)
        return np.asarray(np.hypot(radial, np.maximum(local[:, 2] - size[1], 0.0)))
    return np.asarray(np.linalg.norm(np.maximum(local - size, 0.0), axis=1))
