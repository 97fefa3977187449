"""Where to stand to look at the surfaces of a scene with the head camera, and what is seen from there."""

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from common.approach import BIN_RIM
from common.geometry import Pose2
from common.scene import Receptacle, Scene
from services.navigation.config import Camera
from services.navigation.costmap import Array, Costmap
from services.navigation.floorplan import Rectangle

Seen = NDArray[np.bool_]
SPACING = 0.12
LIFT = 0.05
# Robot's middle to the edge it looks over, and the step from one view to the next along the edge [m].
DISTANCES = (0.50, 0.85)
ALONG = 0.55


class Views:
    """`poses` to look from, `points` (p, 3) of the surfaces to look at, and which of them each pose `shows`."""

    def __init__(self, scene: Scene, camera: Camera) -> None:
        self._camera = camera
        surfaces = [r for r in scene.receptacles if r.kind != "bin"]
        self.points: Array = np.concatenate([_surface(r) for r in surfaces] or [np.empty((0, 3))])
        self._tall = _tall(scene, camera.height)
        self.poses: list[Pose2] = [pose for r in surfaces for pose in _stands(r)]
        self.shows: list[Seen] = [self.visible(pose) for pose in self.poses]

    def visible(self, pose: Pose2) -> Seen:
        """Which points (p,) the camera sees from a pose: in the picture, near enough, no wall between."""
        c = self._camera
        cos, sin = math.cos(pose[2]), math.sin(pose[2])
        eye = np.array([pose[0] + c.forward * cos, pose[1] + c.forward * sin])
        to = self.points[:, :2] - eye
        ahead, left = cos * to[:, 0] + sin * to[:, 1], cos * to[:, 1] - sin * to[:, 0]
        up = self.points[:, 2] - c.height
        tilt, lift = math.cos(c.pitch), math.sin(c.pitch)
        depth, down = ahead * tilt - up * lift, -(ahead * lift + up * tilt)
        inside: Seen = (depth > 0.2) & (np.hypot(to[:, 0], to[:, 1]) < c.reach)
        inside &= (np.abs(left) < depth * math.tan(c.width / 2)) & (np.abs(down) < depth * math.tan(c.tallness / 2))
        for rectangle in self._tall:
            if not inside.any():
                break
            inside[inside] = ~_crosses(eye, self.points[inside, :2], rectangle)
        return inside


@lru_cache(maxsize=4)
def views_of(scene: Scene, camera: Camera) -> Views:
    """The views of a scene, made once."""
    return Views(scene, camera)


def next_view(
    views: Views, worth: Array, tried: set[int], cost: Callable[[Pose2], float], costmap: Costmap, radius: float
) -> int | None:
    """The pose that shows the most for its way; `worth` (p,) is what each point counts, `cost` the way there [m]."""
    best, best_score = None, 0.0
    for n, (pose, shows) in enumerate(zip(views.poses, views.shows, strict=True)):
        if n in tried or costmap.clearance(pose[0], pose[1]) < radius:
            continue
        way = cost(pose)
        if not math.isfinite(way):
            continue
        gain = float(worth[shows].sum())
        score = gain / (way + 2.0) if gain >= 1.0 else 0.0
        if score > best_score:
            best, best_score = n, score
    return best


def _surface(r: Receptacle) -> Array:
    """Points of a surface on a grid, a little above it."""
    counts = [max(2, math.ceil(extent / SPACING)) for extent in r.size]
    u, v = (np.linspace(-extent / 2 + 0.04, extent / 2 - 0.04, n) for extent, n in zip(r.size, counts, strict=True))
    x, y = (axis.ravel() for axis in np.meshgrid(u, v))
    c, s = math.cos(r.yaw), math.sin(r.yaw)
    return np.stack([r.center[0] + c * x - s * y, r.center[1] + s * x + c * y, np.full(x.shape, r.center[2] + LIFT)], 1)


def _stands(r: Receptacle) -> list[Pose2]:
    """Poses before each free edge that face the surface."""
    found = []
    c, s = math.cos(r.yaw), math.sin(r.yaw)
    for ax, ay in r.approach:
        edge, length = (r.size[0] / 2, r.size[1]) if ax else (r.size[1] / 2, r.size[0])
        count = max(1, math.ceil(length / ALONG) - 1)
        sides = (np.arange(count) - (count - 1) / 2) * ALONG
        for distance in DISTANCES:
            out = edge + distance + (BIN_RIM if r.depth else 0.0)
            for side in sides.tolist():
                lx, ly = (ax * out, side) if ax else (side, ay * out)
                x, y = r.center[0] + c * lx - s * ly, r.center[1] + s * lx + c * ly
                found.append((x, y, math.atan2(-(s * ax + c * ay), -(c * ax - s * ay))))
    return found


def _tall(scene: Scene, height: float) -> list[Rectangle]:
    """What nobody looks over: walls, and furniture nearly as high as the camera."""
    found: list[Rectangle] = []
    for wall in scene.walls:
        dx, dy = wall.end[0] - wall.start[0], wall.end[1] - wall.start[1]
        middle = (wall.start[0] + wall.end[0]) / 2, (wall.start[1] + wall.end[1]) / 2
        found.append((*middle, math.hypot(dx, dy) + wall.thickness, wall.thickness, math.atan2(dy, dx)))
    for box in scene.furniture:
        if box.center[2] + box.size[2] / 2 > height - 0.3:
            found.append((box.center[0], box.center[1], box.size[0], box.size[1], box.yaw))
    return found


def _crosses(eye: Array, points: Array, rectangle: Rectangle) -> Seen:
    """Which lines of sight from `eye` (2,) to `points` (n, 2) pass through a rectangle; slab method."""
    x, y, sx, sy, yaw = rectangle
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    start, end = (eye - (x, y)) @ turn, (points - (x, y)) @ turn
    way = end - start
    way[np.abs(way) < 1e-9] = 1e-9
    half = np.array([sx, sy]) / 2
    one, two = (-half - start) / way, (half - start) / way
    enters, leaves = np.minimum(one, two).max(axis=1), np.maximum(one, two).min(axis=1)
    found: Seen = (enters < leaves) & (leaves > 0.0) & (enters < 0.98)
    return found
