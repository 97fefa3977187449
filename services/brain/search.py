"""Where to look for an object that is not in view. Pure."""

import math
from collections.abc import Sequence

from common.scene import Place, Scene

TURN = 2 * math.pi / 3
View = tuple[float, float, float]


def turned(pose: View, turns: int) -> View:
    """The same spot, `turns` thirds of a circle to the left."""
    x, y, theta = pose
    angle = theta + turns * TURN
    return x, y, math.atan2(math.sin(angle), math.cos(angle))


def next_place(pose: View, scene: Scene, visited: Sequence[str]) -> Place | None:
    """The nearest named place that was not searched yet; None when there is none left."""
    left = [p for p in (*scene.places, scene.home) if p.name not in visited]
    return min(left, key=lambda p: math.hypot(p.x - pose[0], p.y - pose[1]), default=None)
