"""Where to look for an object that is not in view: standing poses from which surfaces can be seen. Pure.

Every surface of the scene is a set of sample points; a view covers those within the camera's range and angle that no
wall or tall piece of furniture hides. The next view is the one that shows most that is new for the way there.
"""

import math
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from common.scene import Room, Scene
from services.brain.floor import clearance

View = tuple[float, float, float]
Mask = NDArray[np.bool_]
STEP = 0.5
SPACING = 0.25
HEADINGS = 12
HALF_ANGLE = math.radians(33)
NEAR, FAR = 0.75, 2.4
BODY = 0.48
TALL = 1.0
WAY = 1.5
ROOM_CHANGE = 3.0


@cache
def lookout(scene: Scene) -> "Lookout":
    """The views of a scene, which take a while to work out."""
    return Lookout(scene)


class Lookout:
    """Views of one scene."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def turns(self, pose: View, visited: list[View]) -> View | None:
        """The heading at this spot that shows most that is new; None when turning shows nothing."""
        views = [(pose[0], pose[1], 2 * math.pi * k / HEADINGS) for k in range(HEADINGS)]
        seen = self.covered(visited)
        gains = [int(np.count_nonzero(self._covers(v) & ~seen)) for v in views]
        best = int(np.argmax(gains))
        return _wrapped(views[best]) if gains[best] else None

    def next(self, pose: View, visited: list[View]) -> View | None:
        """The most worthwhile view elsewhere; None when everything has been looked at."""
        seen = self.covered(visited)
        table, views = self._table
        gains = np.count_nonzero(table & ~seen, axis=1).astype(np.float64)
        if not gains.max(initial=0.0) >= 2:
            return None
        way = np.hypot(views[:, 0] - pose[0], views[:, 1] - pose[1])
        room = self._scene.room_at(pose[0], pose[1])
        other = np.array([r is not room for r in self._rooms])
        worth = gains / (WAY + way + ROOM_CHANGE * other)
        x, y, theta = (float(v) for v in views[int(worth.argmax())])
        return _wrapped((x, y, theta))

    def covered(self, visited: list[View]) -> Mask:
        """Which samples were in one of the views."""
        seen = np.zeros(len(self._samples), bool)
        for view in visited:
            seen |= self._covers(view)
        return seen

    # --- geometry
    @cached_property
    def _samples(self) -> NDArray[np.float64]:
        """Points (n, 2) of all surfaces on which things may stand, the delivery place aside."""
        points = []
        for r in self._scene.receptacles:
            if r.name == self._scene.delivery:
                continue
            nx, ny = (max(1, round(v / SPACING)) for v in r.size)
            c, s = math.cos(r.yaw), math.sin(r.yaw)
            for i in range(nx):
                for j in range(ny):
                    u, v = ((i + 0.5) / nx - 0.5) * r.size[0], ((j + 0.5) / ny - 0.5) * r.size[1]
                    points.append((r.center[0] + c * u - s * v, r.center[1] + s * u + c * v))
        return np.array(points).reshape(-1, 2)

    @cached_property
    def _table(self) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        """Coverage (views, samples) and the views (n, 3) of a grid over the free floor."""
        low, high = self._scene.low, self._scene.high
        rows, views = [], []
        for x in np.arange(low[0] + STEP / 2, high[0], STEP):
            for y in np.arange(low[1] + STEP / 2, high[1], STEP):
                if not self._free(float(x), float(y)):
                    continue
                visible = self._visible(float(x), float(y))
                if not visible.any():
                    continue
                bearing = np.arctan2(self._samples[:, 1] - y, self._samples[:, 0] - x)
                for k in range(HEADINGS):
                    heading = 2 * math.pi * k / HEADINGS
                    row = visible & (np.abs(_wrap(bearing - heading)) < HALF_ANGLE)
                    if row.any():
                        rows.append(row)
                        views.append((x, y, heading))
        return np.array(rows).reshape(len(views), -1), np.array(views).reshape(-1, 3)

    @cached_property
    def _rooms(self) -> list[Room | None]:
        return [self._scene.room_at(float(x), float(y)) for x, y, _ in self._table[1]]

    def _covers(self, view: View) -> Mask:
        x, y, theta = view
        bearing = np.arctan2(self._samples[:, 1] - y, self._samples[:, 0] - x)
        covers: Mask = self._visible(x, y) & (np.abs(_wrap(bearing - theta)) < HALF_ANGLE)
        return covers

    def _visible(self, x: float, y: float) -> Mask:
        distance = np.hypot(self._samples[:, 0] - x, self._samples[:, 1] - y)
        visible: Mask = (distance > NEAR) & (distance < FAR)
        eye = np.array([x, y])
        for a, b in self._screens:
            visible &= ~_crossed(eye, self._samples, np.array(a), np.array(b))
        return visible

    @cached_property
    def _screens(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Lines on the floor that the camera does not look over."""
        found = [(w.start, w.end) for w in self._scene.walls]
        for box in self._scene.furniture:
            if box.center[2] + box.size[2] / 2 > TALL:
                c, s = math.cos(box.yaw), math.sin(box.yaw)
                x, y, hx, hy = *box.center[:2], box.size[0] / 2, box.size[1] / 2
                corners = [
                    (x + c * i * hx - s * j * hy, y + s * i * hx + c * j * hy)
                    for i, j in ((1, 1), (1, -1), (-1, -1), (-1, 1))
                ]
                found += list(zip(corners, corners[1:] + corners[:1], strict=True))
        return found

    def _free(self, x: float, y: float) -> bool:
        """Room for the robot to stand and turn."""
        return clearance(self._scene, x, y) >= BODY and self._scene.room_at(x, y) is not None


def _wrap(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    wrapped: NDArray[np.float64] = (angle + np.pi) % (2 * np.pi) - np.pi
    return wrapped


def _wrapped(view: View) -> View:
    return round(view[0], 3), round(view[1], 3), round(math.remainder(view[2], 2 * math.pi), 3)


def _cross(ax: NDArray[np.float64], ay: NDArray[np.float64], bx: float, by: float) -> NDArray[np.float64]:
    return ax * by - ay * bx


def _crossed(
    eye: NDArray[np.float64], points: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]
) -> Mask:
    """Whether the line from `eye` to each point crosses the segment a-b."""
    d, w = points - eye, b - a
    denominator = _cross(d[:, 0], d[:, 1], float(w[0]), float(w[1]))
    safe = np.where(np.abs(denominator) < 1e-12, 1e-12, denominator)
    t = ((a[0] - eye[0]) * w[1] - (a[1] - eye[1]) * w[0]) / safe
    u = ((a[0] - eye[0]) * d[:, 1] - (a[1] - eye[1]) * d[:, 0]) / safe
    crossed: Mask = (t > 0) & (t < 1) & (u >= 0) & (u <= 1)
    return crossed
