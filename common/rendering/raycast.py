"""Images by MuJoCo's ray casting, for machines without any GL library."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from common.rendering.looks import HIDDEN_GROUP, SKY, geom_colours

NEAR = 0.02
"""Distance [m] within which a hit is the camera's own housing."""
FAR = 30.0
"""Length of a ray [m]."""
CHUNK = 16384
"""Rays of one call; chosen: 400 kB of directions fit the processor's cache."""
_DRAWN = (np.arange(mujoco.mjNGROUP) < HIDDEN_GROUP).astype(np.uint8)
_SKY = np.array(SKY, np.float64)
_LIGHT = np.array([0.3, -0.4, 0.87])


def directions(rotation: NDArray[np.float64], fovy: float, width: int, height: int) -> NDArray[np.float64]:
    """Unit directions (height * width, 3) in the world for a MuJoCo camera frame; `fovy` in degrees."""
    focal = height / 2 / np.tan(np.radians(fovy) / 2)
    u, v = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
    rays = np.stack([u / focal, -v / focal, -np.ones_like(u)], axis=-1).reshape(-1, 3)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    turned: NDArray[np.float64] = rays @ rotation.T
    return turned


def cast(
    model: Any,
    data: Any,
    origin: NDArray[np.float64],
    rays: NDArray[np.float64],
    groups: NDArray[np.uint8] = _DRAWN,
    exclude: int = -1,
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64]]:
    """Distance (n,) [m], -1 for nothing, geom (n,) and normal (n, 3) along unit rays (n, 3) from `origin` (3,).

    `groups` (6,): the geom groups that count; `exclude`: the number of a body that does not.
    """
    count = len(rays)
    distance, geom, normal = np.empty(count), np.empty(count, np.int32), np.zeros((count, 3))
    for a in range(0, count, CHUNK):
        b = min(count, a + CHUNK)
        part, flat = np.ascontiguousarray(rays[a:b]).reshape(-1), normal[a:b].reshape(-1)
        mujoco.mj_multiRay(model, data, origin, part, groups, 1, exclude, geom[a:b], distance[a:b], flat, b - a, FAR)
    return distance, geom, normal


def image(
    model: Any,
    data: Any,
    position: NDArray[np.float64],
    rotation: NDArray[np.float64],
    fovy: float,
    width: int,
    height: int,
    body: int = -1,
) -> tuple[NDArray[np.uint8], NDArray[np.float64], NDArray[np.int32]]:
    """RGB (height, width, 3), depth (height, width) [m] along the optical axis, 0 where nothing is seen, and geoms
    (height, width), -1 for none. What is transparent is opaque here.

    `body`: the one the camera is built into, whose case does not hide the view.
    """
    rays = directions(rotation, fovy, width, height)
    distance, geom, normal = cast(model, data, position, rays)
    case = (distance >= 0) & (distance < NEAR)
    if body >= 0 and case.any():
        distance[case], geom[case], normal[case] = cast(model, data, position, rays[case], exclude=body)
    seen = (distance >= 0) & (distance < FAR)
    depth = np.where(seen, distance * (rays @ -rotation[:, 2]), 0.0).reshape(height, width)
    colours = geom_colours(model) * 255
    light = 0.55 + 0.45 * np.abs(normal @ _LIGHT)
    rgb = np.where(seen[:, np.newaxis], colours[geom] * light[:, np.newaxis], _SKY)
    shown = np.where(seen, geom, -1).reshape(height, width)
    return np.clip(rgb, 0, 255).astype(np.uint8).reshape(height, width, 3), depth, shown


def render(*view: Any) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """RGB and depth alone, of the same arguments as `image`."""
    return image(*view)[:2]
