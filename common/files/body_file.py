"""An MJCF file that a world names as an object: read, checked and measured."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from common.geometry import Array


class BodyError(ValueError):
    """A body file that cannot be used; the message says why."""


def load(path: Path) -> tuple[Any, Any]:
    """The compiled model, and its data with everything in place.

    Raises:
        BodyError: no such file, or none that MuJoCo can read.
    """
    import mujoco

    if not path.is_file():
        raise BodyError(f"no body file {path}")
    try:
        model: Any = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise BodyError(f"{path}: MuJoCo cannot read it: {error}") from None
    data: Any = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data


def standing(up: str) -> Array:
    """The rotation (3, 3) that turns the file's axis `up` (x, y or z) upwards."""
    return {
        "x": np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]),
        "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    }.get(up, np.eye(3))


def bounds(model: Any, data: Any, turn: Array) -> tuple[Array, Array]:
    """Lowest and highest corner (3,) [m] of all that is no plane, after the rotation `turn` (3, 3)."""
    import mujoco

    from common import body_extent

    solid = [g for g in range(model.ngeom) if model.geom_type[g] != mujoco.mjtGeom.mjGEOM_PLANE]
    turned = [(g, turn @ data.geom_xmat[g].reshape(3, 3), turn @ data.geom_xpos[g]) for g in solid]
    low, high = np.array([body_extent.bounds(model, *each) for each in turned]).reshape(-1, 2, 3).swapaxes(0, 1)
    return low.min(axis=0, initial=np.inf), high.max(axis=0, initial=-np.inf)


def middle(model: Any, data: Any, turn: Array) -> Array:
    """The middle (3,) [m] of the bounding box after the rotation `turn` (3, 3)."""
    low, high = bounds(model, data, turn)
    return np.asarray((low + high) / 2)


@cache
def extents(path: Path, up: str = "z") -> tuple[float, float, float]:
    """Full extents (x, y, z) [m] of what a body file holds, standing with its axis `up` upwards.

    Raises:
        BodyError: it cannot be read, or holds nothing.
    """
    low, high = bounds(*load(path), standing(up))
    if not np.isfinite(low).all():
        raise BodyError(f"{path}: it has no geoms")
    x, y, z = (round(float(v), 4) for v in high - low)
    return x, y, z
