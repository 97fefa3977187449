"""Where cameras really sit: the head's from pictures of the robot's arm, the wrist's from what both see. Pure.

Projective point-to-plane registration of what the camera measures against the robot's description. Source: Chen and
Medioni, "Object modelling by registration of multiple range images", 1992; the association by rays is that of Newcombe
et al., "KinectFusion", 2011.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial.transform import Rotation

from common.geometry import quat_matrix
from common.messages import Rgbd
from common.robot import ARM, RobotKinematics, arm_limits, home_arm, subtree

Array = NDArray[np.float64]

STEP = 3
"""Every which row and column of a picture is used."""
ROUNDS = 12
"""Iterations; the error of a mount of 3 mm and .3 deg is below a hundredth of that after six."""
FARTHEST, NEAREST = 0.03, 0.006
"""Largest residual [m] that still belongs to the arm, in the first and in the last iterations."""
GRAZING = 0.35
"""Least cosine of the angle between ray and surface: at edges depth is a guess."""
SMOOTH, JUMP = 7, 0.03
"""Side [px] of the window over which a surface's normal is taken, and change of depth [m] within it that is an edge."""
TRUE_OFFSET, TRUE_TURN = 0.001, np.radians(0.1)
"""Error of a mount [m, rad] that does not matter: it moves what is seen at 1 m by 3 mm, half of what a grasp bears."""
NEAR_BY = 0.04
"""Steps [m] along a ray that is followed to what another camera saw."""
FROM_LIMIT = 0.03
"""How far [rad] the arm stays from its joints' limits: drives stop before them."""
LEAST = 400
"""Rays that must meet the arm in a picture: 2 % of those cast, a gripper in a corner of it."""


class Unseen(Exception):
    """The pictures do not show enough of what is registered."""


Match = tuple[Array, Array, NDArray[np.bool_]]
"""Points (n, 3) on the surface and its normals (n, 3) in the base frame, and which of them (n,) hold."""


class Surface(Protocol):
    """What pictures are registered against."""

    def take(self, shot: "Shot") -> None:
        """The robot as it stood when the picture was taken."""

    def match(self, origin: Array, directions: Array, points: Array, shape: tuple[int, int]) -> Match:
        """The surface that belongs to each measured point (n, 3), seen from `origin` along unit `directions` (n, 3);
        `shape` (h, w) of the picture that they make, n = h w."""


@dataclass(frozen=True)
class Shot:
    """A picture and the arm's joints (7,) [rad] and the gripper's width [m] when it was taken."""

    image: Rgbd
    joints: Array
    width: float


@dataclass(frozen=True)
class Mount:
    """Where a camera sits, seen from where its drawing has it, in its optical frame (x right, y down, z forward).

    `offset` (3,) [m], `turn` (3,) [rad, a rotation vector]; the deviations (3,) are those of the mean over pictures,
    by leaving out each in turn. `residual` [m]: median distance of what was measured from the arm's surface.
    """

    offset: Array
    turn: Array
    offset_deviation: Array
    turn_deviation: Array
    residual: float
    pictures: int

    def as_drawn(self) -> bool:
        """Within `TRUE_OFFSET` and `TRUE_TURN` and twice the deviation of where it is taken to be."""
        off, by = float(np.linalg.norm(self.offset)), 2 * float(np.linalg.norm(self.offset_deviation))
        turned, about = float(np.linalg.norm(self.turn)), 2 * float(np.linalg.norm(self.turn_deviation))
        return off < TRUE_OFFSET + by and turned < TRUE_TURN + about


class Arm(RobotKinematics):
    """The arm and hand as surfaces; `lowest` and `highest` joint angles (7,) [rad], `home` the carry pose (7,)."""

    def __init__(self, mjcf: str) -> None:
        super().__init__(mjcf)
        self._base = int(self.model.body("base").id)
        first = self.model.body(int(self.model.jnt_bodyid[self.model.joint(ARM[0]).id])).name
        self._moving = np.isin(self.model.geom_bodyid, list(subtree(self.model, first)))
        self._groups = np.array([1, 1, 1, 1, 0, 0], np.uint8)
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
        count = len(directions)
        distances, normals = np.empty(count), np.empty((count, 3))
        geoms, flat = np.empty(count, np.int32), normals.reshape(-1)
        rays = np.ascontiguousarray(directions).reshape(-1)
        mujoco.mj_multiRay(
            self.model, self.data, origin, rays, self._groups, 1, self._base, geoms, distances, flat, count, 10.0
        )
        return distances, normals

    def take(self, shot: Shot) -> None:
        self.pose(shot.joints, shot.width)

    def match(self, origin: Array, directions: Array, points: Array, shape: tuple[int, int]) -> Match:
        distances, normals = self.cast(origin, directions)
        hit = _inner(distances.reshape(shape) > 0.0).ravel()
        return origin + directions * np.maximum(distances, 0.0)[:, None], normals, hit


class Room:
    """What another camera that does not move saw of the world around, its own `mount` taken into account.

    Of `images` the farthest depth counts: the arm was in front of something else in each.
    """

    def __init__(self, images: Sequence[Rgbd], mount: "Mount") -> None:
        image = images[0]
        nominal = quat_matrix(image.orientation)
        self._rotation = nominal @ Rotation.from_rotvec(mount.turn).as_matrix()
        self._position = np.array(image.position) + nominal @ mount.offset
        self._focal, self._middle = (image.fx, image.fy), (image.cx, image.cy)
        ahead = rays(image, 1)[0]
        depths = np.array([rays(each, 1)[1] for each in images])
        behind = (depths > 0.0) & (depths > depths.max(axis=0) - JUMP)
        depth = (depths * behind).sum(axis=0) / np.maximum(behind.sum(axis=0), 1)
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
        """It stays as it is."""

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


def rays(image: Rgbd, step: int = STEP) -> tuple[Array, Array]:
    """Points (h, w, 3) on the plane one metre ahead in the optical frame, and depth (h, w) [m], every `step` pixels."""
    depth = np.frombuffer(image.depth, "<u2").reshape(image.height, image.width)[::step, ::step] / 1000.0
    u = (np.arange(0, image.width, step) + 0.5 - image.cx) / image.fx
    v = (np.arange(0, image.height, step) + 0.5 - image.cy) / image.fy
    across, down = np.meshgrid(u, v)
    return np.stack([across, down, np.ones_like(across)], axis=-1), depth


def fit(surface: Surface, shots: Sequence[Shot]) -> Mount:
    """The mount that explains all pictures best.

    Raises:
        Unseen: fewer than three pictures that show the surface.
    """
    offset, turn = np.zeros(3), Rotation.identity()
    parts: list[tuple[Array, Array]] = []
    residuals = np.zeros(0)
    for number in range(ROUNDS):
        limit = NEAREST if number >= ROUNDS // 2 else FARTHEST
        found = [_normal_equations(surface, shot, offset, turn, limit) for shot in shots]
        parts = [(a, b) for a, b, r in found if len(r) >= LEAST]
        if len(parts) < 3:
            raise Unseen(f"{len(parts)} of {len(shots)} pictures show what is registered; three are needed")
        residuals = np.concatenate([r for _, _, r in found])
        step = _solve(parts)
        turned = Rotation.from_rotvec(step[3:])
        offset, turn = turned.apply(offset) + step[:3], turned * turn
    each = np.array([_solve(parts[:i] + parts[i + 1 :]) for i in range(len(parts))])
    spread = np.sqrt((len(parts) - 1) / len(parts) * np.square(each - each.mean(axis=0)).sum(axis=0))
    return Mount(
        offset, turn.as_rotvec(), spread[:3], spread[3:], float(np.median(np.abs(residuals))), len(parts)
    )  # fmt: skip


def _solve(parts: Sequence[tuple[Array, Array]]) -> Array:
    matrix, vector = sum(a for a, _ in parts), sum(b for _, b in parts)
    return np.asarray(np.linalg.solve(np.asarray(matrix), np.asarray(vector)))


def _normal_equations(
    surface: Surface, shot: Shot, offset: Array, turn: Rotation, limit: float
) -> tuple[Array, Array, Array]:
    """A (6, 6) and b (6,) of the step [m, rad] in the drawing's optical frame, and the residuals (n,) [m]."""
    surface.take(shot)
    ahead, depth = rays(shot.image)
    nominal, seen = quat_matrix(shot.image.orientation), depth.ravel() > 0.0
    # In the drawing's optical frame: where the camera is, and where its pixels look.
    looks = turn.apply(ahead.reshape(-1, 3))
    directions = looks @ nominal.T
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points = looks * depth.ravel()[:, None] + offset
    start = np.array(shot.image.position)
    measured = start + points @ nominal.T
    there, normals, hit = surface.match(start + nominal @ offset, directions, measured, depth.shape)
    residuals = ((measured - there) * normals).sum(axis=1)
    good = hit & seen & (np.abs(residuals) < limit) & (np.abs((normals * directions).sum(axis=1)) > GRAZING)
    facing = normals[good] @ nominal
    jacobian = np.hstack([facing, np.cross(points[good], facing)])
    return jacobian.T @ jacobian, -jacobian.T @ residuals[good], residuals[good]


def _inner(hit: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Without the pixels (h, w) at the rim."""
    inner = hit.copy()
    inner[1:] &= hit[:-1]
    inner[:-1] &= hit[1:]
    inner[:, 1:] &= hit[:, :-1]
    inner[:, :-1] &= hit[:, 1:]
    return inner
