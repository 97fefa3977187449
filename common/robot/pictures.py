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


def depths(image: Rgbd) -> NDArray[np.float32]:
    """Depth (h, w) [m] along the optical axis, 0 where nothing is seen.

    Raises:
        PictureError: not as many pixels as it says.
    """
    if len(image.depth) != 2 * image.width * image.height:
        raise PictureError(f"{len(image.depth)} bytes of depth for {image.width} x {image.height} pixels")
    return np.frombuffer(image.depth, "<u2").reshape(image.height, image.width) * np.float32(0.001)


def rays(image: Rgbd, step: int = 1) -> Array:
    """Points (h, w, 3) on the plane one metre ahead in the optical frame, of every `step`-th row and column."""
    u = (np.arange(0, image.width, step) + 0.5 - image.cx) / image.fx
    v = (np.arange(0, image.height, step) + 0.5 - image.cy) / image.fy
    across, down = np.meshgrid(u, v)
    return np.stack([across, down, np.ones_like(across)], axis=-1)
