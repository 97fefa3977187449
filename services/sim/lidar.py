"""A 2-D lidar by ray casting, in a slot of the chassis, whose posts and, when low, the arm occlude some rays."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.rendering.raycast import cast
from common.robot.joints import BASE_BODY
from services.sim.robot import GLASS_GROUP, HULL_GROUP, POST, ROBOT_GROUP
from services.sim.things.primitives import GROUP

SEEN = 0
"""A group of geoms that lidars see."""
RAYS, RANGE_MIN, RANGE_MAX = 360, 0.05, 10.0
"""Rays of a turn [count] and nearest and farthest range [m], as small lidars for indoors have them."""


class Lidar:
    """360 rays counter-clockwise from -pi in the lidar's frame; `noise` [m], of each ray `missing` is the probability
    that it does not return. What stands on tables does not reach it, glass does not return its light."""

    def __init__(self, model: Any, site: int, noise: float, missing: float, rng: np.random.Generator) -> None:
        self._site, self._noise, self._missing, self._rng = site, noise, missing, rng
        angles = -math.pi + np.arange(RAYS) * (2 * math.pi / RAYS)
        self._local = np.stack([np.cos(angles), np.sin(angles), np.zeros(RAYS)], axis=1)
        self._groups = np.ones(6, np.uint8)
        self._groups[[GLASS_GROUP, ROBOT_GROUP, HULL_GROUP, GROUP]] = 0
        self._arm_groups = np.zeros(6, np.uint8)
        self._arm_groups[[ROBOT_GROUP, HULL_GROUP]] = 1
        self._base = int(model.site_bodyid[site])
        self._posts = to_posts(model, site, self._local)
        root = model.body_rootid[self._base]
        self._others = _other_robots(model, root)
        of_arm = (model.body_rootid[model.geom_bodyid] == root) & (model.geom_bodyid != self._base)
        self._arm = np.flatnonzero(of_arm & (model.geom_contype != 0))

    def scan(self, model: Any, data: Any) -> NDArray[np.float32]:
        """Ranges (360,) [m]; values above RANGE_MAX mean nothing was seen."""
        rotation = data.site_xmat[self._site].reshape(3, 3)
        origin = data.site_xpos[self._site].copy()
        directions = self._local @ rotation.T
        own = model.geom_group[self._others]
        model.geom_group[self._others] = SEEN  # what of this robot is not looked at, of another one is
        distance, *_ = cast(model, data, origin, directions, self._groups)
        model.geom_group[self._others] = own
        distance[distance < 0] = np.inf
        np.minimum(distance, self._posts, out=distance)
        if (data.geom_xpos[self._arm, 2] - model.geom_rbound[self._arm] < origin[2]).any():
            arm, *_ = cast(model, data, origin, directions, self._arm_groups, self._base)
            np.minimum(distance, np.where(arm < 0, np.inf, arm), out=distance)
        hit = distance <= RANGE_MAX
        noisy = distance + self._rng.normal(0.0, self._noise, RAYS) if self._noise else distance
        if self._missing:
            hit &= self._rng.random(RAYS) >= self._missing
        return np.where(hit, np.clip(noisy, RANGE_MIN, RANGE_MAX), RANGE_MAX + 1.0).astype(np.float32)


def _other_robots(model: Any, own: int) -> NDArray[np.intp]:
    """The geoms of robots beside the one whose outermost body is `own`."""
    names = ((b, model.body(b).name) for b in np.unique(model.body_rootid).tolist())
    others = [b for b, name in names if b != own and name.rpartition("/")[2] == BASE_BODY]
    return np.flatnonzero(np.isin(model.body_rootid[model.geom_bodyid], others) & (model.geom_contype != 0))


def to_posts(model: Any, site: int, directions: Array) -> Array:
    """Distances (n,) [m] along unit `directions` (n, 3) to the upright posts around the lidar, inf past them."""
    found = np.full(len(directions), np.inf)
    for g in range(model.ngeom):
        if model.geom_bodyid[g] != model.site_bodyid[site] or not model.geom(g).name.rpartition("/")[2].startswith(
            POST
        ):
            continue
        centre, radius = (model.geom_pos[g] - model.site_pos[site])[:2], float(model.geom_size[g, 0])
        along = directions[:, :2] @ centre
        aside = radius**2 - (centre @ centre - along**2)
        met = (along > 0) & (aside > 0)
        found[met] = np.minimum(found[met], along[met] - np.sqrt(aside[met]))
    return found
