"""A free camera that looks at the robot from a side where no wall stands between."""

from typing import Any

import numpy as np

from common.rendering.renderer import Renderer, View

HEIGHT, DISTANCE, ELEVATION = 0.5, 3.2, -42.0
"""Height of the point looked at [m], distance from it [m] and elevation [deg] of the camera; chosen: the robot and what
it works at fill the picture."""
TURNS = (0.0, 45.0, -45.0, 90.0, -90.0, 135.0, -135.0, 180.0)
"""Turns [deg] that are tried one after the other, the least first."""
NEAR = 0.9
"""What is hit within so many metres of the robot's middle is the robot, or what it works at."""


def free_view(renderer: Renderer, azimuth: float = 225.0) -> View:
    """A view of the robot from behind `azimuth` [deg], or from the next direction that is free."""
    model, data = renderer.model, renderer.data
    x, y = (float(v) for v in data.body("base").xpos[:2])
    views = [View((x, y, HEIGHT), DISTANCE, azimuth + turn, ELEVATION) for turn in TURNS]
    return next((view for view in views if _clear(model, data, view)), views[0])


def _clear(model: Any, data: Any, view: View) -> bool:
    """True when nothing stands between eye and robot; cast from the robot outwards, where walls are thick."""
    import mujoco  # after the renderer has chosen its GL library

    a, e = np.radians(view.azimuth), np.radians(view.elevation)
    back = -np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    groups = np.array([1, 1, 1, 1, 0, 0], np.uint8)
    start = np.array(view.lookat) + NEAR * back
    found = mujoco.mj_ray(model, data, start, back, groups, 1, -1, np.zeros(1, np.int32))
    return bool(found < 0 or found > view.distance - NEAR)
