"""A 2-D lidar by MuJoCo ray casting; the robot's own geoms are in a group that the rays skip."""

import math
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from services.sim.objects import GROUP
from services.sim.robot import HULL_GROUP, ROBOT_GROUP

RAYS, RANGE_MIN, RANGE_MAX = 360, 0.05, 10.0
_TAKES_NORMAL = "normal" in (mujoco.mj_multiRay.__doc__ or "")


def cast(
    model: Any, data: Any, origin: NDArray[np.float64], directions: NDArray[np.float64], groups: NDArray[np.uint8]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Distances [m] (-1: nothing) and geom ids along unit `directions` (n, 3) from `origin` (3,)."""
    n = len(directions)
    geom, distance = np.empty(n, np.int32), np.empty(n)
    flat = np.ascontiguousarray(directions, dtype=np.float64).reshape(-1)
    middle = (geom, distance, None) if _TAKES_NORMAL else (geom, distance)
    mujoco.mj_multiRay(model, data, origin, flat, groups, 1, -1, *middle, n, 100.0)
    return distance, geom


class Lidar:
    """360 rays counter-clockwise from -pi in the lidar's frame; `noise` [m], of each ray `missing` is the probability
    that it does not return."""

    def __init__(self, model: Any, site: int, noise: float, missing: float, rng: np.random.Generator) -> None:
        self._site, self._noise, self._missing, self._rng = site, noise, missing, rng
        angles = -math.pi + np.arange(RAYS) * (2 * math.pi / RAYS)
        self._local = np.stack([np.cos(angles), np.sin(angles), np.zeros(RAYS)], axis=1)
        self._groups = np.ones(6, np.uint8)
        self._groups[[ROBOT_GROUP, HULL_GROUP, GROUP]] = 0

    def scan(self, model: Any, data: Any) -> NDArray[np.float32]:
        """Ranges (360,) [m]; values above RANGE_MAX mean nothing was seen."""
        rotation = data.site_xmat[self._site].reshape(3, 3)
        origin = data.site_xpos[self._site].copy()
        distance, _ = cast(model, data, origin, self._local @ rotation.T, self._groups)
        hit = (distance >= 0) & (distance <= RANGE_MAX)
        noisy = distance + self._rng.normal(0.0, self._noise, RAYS) if self._noise else distance
        if self._missing:
            hit &= self._rng.random(RAYS) >= self._missing
        return np.where(hit, np.clip(noisy, RANGE_MIN, RANGE_MAX), RANGE_MAX + 1.0).astype(np.float32)
