"""What was measured of a segment."""

import math
from dataclasses import dataclass

from common.floor_plan import Vec3
from common.messages import End, ShapeFamily

SLICES = 8
"""Pieces of the height in which the radius of a turned shape is read off."""
LEVEL = math.pi / 2
"""Tilt [rad] of what lies on its side."""


@dataclass(frozen=True)
class Measurement:
    """Pose and extents [m] of a segment. `x`, `y`: the middle; `size`: own extents, of what lies the first along `yaw`.

    `tilt` [rad] as in `WorldObject`; `residual` [m]: mean distance of the points; `spread` [m]: standard deviation of
    extents and position. `profile` (SLICES,): radius by the widest, from the foot up; `hollow`: it is open above;
    `handle`: yaw [rad] of one that was seen, nan without. `free`: parameters of the shape; `credit`: by how much of
    its residual it is better than a shape that can take its place. `top_seen`: the points tell which end of what lies
    is the upper one, it is no guess; `end`: what the upper end of what stands, or the end of what lies that faces the
    camera, is. `rivals`: other shapes that explain the points
    nearly as well, each with its likelihood by that of this one.
    """

    family: ShapeFamily
    x: float
    y: float
    yaw: float
    size: Vec3
    residual: float
    spread: float
    tilt: float = 0.0
    profile: tuple[float, ...] = ()
    hollow: bool = False
    handle: float = math.nan
    free: int = 4
    credit: float = 0.0
    top_seen: bool = False
    end: End = ""
    rivals: "tuple[tuple[float, Measurement], ...]" = ()
