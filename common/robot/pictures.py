"""The pictures of a camera message as arrays, checked. Pure."""

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.messages import Rgbd


class PictureError(ValueError):
    """A picture that no camera takes; says why."""


def colours(image: Rgbd) -> NDArray[np.uint8]:
    """RGB (h, w, 3).

    Raises:
        PictureError: not as many pixels as it says.
    """
    if len(image.rgb) != 3 * image.width * image.height:
        raise PictureError(f"{len(image.rgb)} bytes of colour for {image.width} x {image.height} pixels")
    return np.frombuffer(image.rgb, np.uint8).reshape(image.height, image.width, 3)


def millimetres(image: Rgbd) -> NDArray[np.uint16]:
    """Depth (h, w) [mm] along the optical axis, 0 where nothing is seen.

    Raises:
        PictureError: not as many pixels as it says.
    """
    if len(image.depth) != 2 * image.width * image.height:
        raise PictureError(f"{len(image.depth)} bytes of depth for {image.width} x {image.height} pixels")
    return np.frombuffer(image.depth, "<u2").reshape(image.height, image.width)


def depths(image: Rgbd) -> NDArray[np.float32]:
    """Depth (h, w) [m], else as `millimetres`."""
    return millimetres(image) * np.float32(0.001)


def pinhole(image: Rgbd) -> tuple[list[float], list[float]]:
    """The camera matrix (3 x 3) and the projection (3 x 4) of the picture's camera, row-major [px]."""
    fx, fy, cx, cy = image.fx, image.fy, image.cx, image.cy
    return [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0], [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]


def rays(image: Rgbd, step: int = 1) -> Array:
    """Points (h, w, 3) on the plane one metre ahead in the optical frame, of every `step`-th row and column."""
    u = (np.arange(0, image.width, step) + 0.5 - image.cx) / image.fx
    v = (np.arange(0, image.height, step) + 0.5 - image.cy) / image.fy
    across, down = np.meshgrid(u, v)
    return np.stack([across, down, np.ones_like(across)], axis=-1)
