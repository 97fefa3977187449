"""Fit of the cameras' mounts: the head's from pictures of the arm, the wrist's from what both cameras see. Pure.

Projective point-to-plane registration of what the camera measures against the robot's description. Source: Chen and
Medioni, "Object modelling by registration of multiple range images", 1992; the association by rays is that of Newcombe
et al., "KinectFusion", 2011.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from cli.cameras.shot import STEP, Mount, Shot
from cli.cameras.surfaces import Surface
from common.geometry import Array, quat_matrix
from common.robot.pictures import depths, rays

ROUNDS = 12
"""Iterations; the error of a mount of 3 mm and .3 deg is below a hundredth of that after six."""
FARTHEST, NEAREST = 0.03, 0.006
"""Largest residual [m] that still belongs to the arm, in the first and in the last iterations."""
GRAZING = 0.35
"""Least cosine of the angle between ray and surface: at edges depth is a guess."""
LEAST = 400
"""Rays that must meet the arm in a picture: 2 % of those cast, a gripper in a corner of it."""


class Unseen(Exception):
    """The pictures do not show enough of the surface that they are registered with."""


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
    ahead, depth = rays(shot.image, STEP), depths(shot.image)[::STEP, ::STEP]
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
