"""Angles, planar poses, rectangles on the floor plan and quaternions (w, x, y, z)."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Point = tuple[float, float]
Pose2 = tuple[float, float, float]
IDENTITY_POSE: Pose2 = (0.0, 0.0, 0.0)
"""Where a frame lies in itself [m, m, rad]."""
SIDES: tuple[tuple[float, float], ...] = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
"""Of a rectangle, as unit steps outwards in its own frame."""
Number = TypeVar("Number", float, NDArray[np.floating])
"""A coordinate, or an array of them of any shape."""


def wrap(angle: float) -> float:
    """The angle [rad] brought into (-pi, pi]."""
    wrapped = math.fmod(angle + math.pi, 2 * math.pi)
    return wrapped - math.pi if wrapped > 0 else wrapped + math.pi


def compose(a: Pose2, b: Pose2) -> Pose2:
    """Pose b, given in frame a, in the frame that a is given in."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], wrap(a[2] + b[2])


def inverse(a: Pose2) -> Pose2:
    """The pose of the parent frame seen from frame a."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return -c * a[0] - s * a[1], s * a[0] - c * a[1], wrap(-a[2])


def to_frame(frame: Pose2, point: tuple[float, float]) -> tuple[float, float]:
    """A point of the parent frame in `frame`."""
    x, y, _ = compose(inverse(frame), (point[0], point[1], 0.0))
    return x, y


def pose_at(rows: Sequence[tuple[float, Pose2]], t: float) -> Pose2:
    """The pose at `t` [s] between the two of (time, pose) around it; the first or the last one beyond them."""
    after = bisect_right(rows, t, key=lambda row: row[0])
    if after in (0, len(rows)):
        return rows[min(after, len(rows) - 1)][1]
    (t0, a), (t1, b) = rows[after - 1], rows[after]
    s = (t - t0) / (t1 - t0)
    return a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), wrap(a[2] + s * wrap(b[2] - a[2]))


def from_segment(x: float, y: float, a: tuple[float, float], b: tuple[float, float]) -> float:
    """Distance [m] of a point from the straight line from `a` to `b`."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    t = min(1.0, max(0.0, ((x - a[0]) * dx + (y - a[1]) * dy) / max(dx * dx + dy * dy, 1e-9)))
    return math.hypot(x - a[0] - t * dx, y - a[1] - t * dy)


class Rectangle(NamedTuple):
    """A rectangle on the floor plan: centre (x, y), `length` along its own x, `width` along its own y [m], `yaw` [rad].

    Its own frame has the origin at the centre. Points are in the frame that the rectangle is given in.
    """

    x: float
    y: float
    length: float
    width: float
    yaw: float = 0.0

    def to_local(self, x: Number, y: Number) -> tuple[Number, Number]:
        """Points in the rectangle's own frame."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        dx, dy = x - self.x, y - self.y
        return c * dx + s * dy, c * dy - s * dx

    def to_map(self, u: Number, v: Number) -> tuple[Number, Number]:
        """Points (u, v) of the rectangle's own frame in the frame that it is given in."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return self.x + c * u - s * v, self.y + s * u + c * v

    @property
    def corners(self) -> list[tuple[float, float]]:
        """Counter-clockwise, in the frame that it is given in."""
        half = ((1, 1), (-1, 1), (-1, -1), (1, -1))
        return [self.to_map(i * self.length / 2, j * self.width / 2) for i, j in half]

    def direction(self, u: float, v: float) -> tuple[float, float]:
        """A vector (u, v) of the rectangle's own frame in the frame that it is given in."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return c * u - s * v, s * u + c * v

    def contains(self, x: float, y: float, margin: float = 0.0) -> bool:
        """True when the point lies in the rectangle, or at most `margin` [m] beyond one of its sides."""
        u, v = self.to_local(x, y)
        return abs(u) <= self.length / 2 + margin and abs(v) <= self.width / 2 + margin

    def distance(self, x: float, y: float) -> float:
        """Distance [m] of the point from the rectangle, 0 within it."""
        u, v = self.to_local(x, y)
        return math.hypot(max(abs(u) - self.length / 2, 0.0), max(abs(v) - self.width / 2, 0.0))

    def nearest(self, x: float, y: float) -> tuple[float, float]:
        """The point of the rectangle that is nearest to a point."""
        u, v = self.to_local(x, y)
        half, across = self.length / 2, self.width / 2
        return self.to_map(min(max(u, -half), half), min(max(v, -across), across))

    def meets(self, start: tuple[float, float], end: tuple[float, float]) -> bool:
        """True when the straight line from one point to the other touches the rectangle; slab method."""
        a, b = self.to_local(*start), self.to_local(*end)
        enters, leaves = 0.0, 1.0
        for from_, to, half in zip(a, b, (self.length / 2, self.width / 2), strict=True):
            way = to - from_ or 1e-12
            one, two = sorted(((-half - from_) / way, (half - from_) / way))
            enters, leaves = max(enters, one), min(leaves, two)
        return enters <= leaves

    def signed_distances(self, x: Array, y: Array) -> Array:
        """Distance [m] of each point from the rectangle's edge, negative within it."""
        u, v = self.to_local(x, y)
        u, v = np.abs(u) - self.length / 2, np.abs(v) - self.width / 2
        found: Array = np.hypot(np.maximum(u, 0.0), np.maximum(v, 0.0)) + np.minimum(np.maximum(u, v), 0.0)
        return found

    def grown(self, margin: float) -> "Rectangle":
        """The rectangle with every side `margin` [m] farther out."""
        return self._replace(length=self.length + 2 * margin, width=self.width + 2 * margin)


def transformed(frame: Pose2, points: Array) -> Array:
    """Points (n, 2) of `frame` in its parent."""
    c, s = np.cos(frame[2]), np.sin(frame[2])
    moved: Array = points @ np.array([[c, s], [-s, c]]) + frame[:2]
    return moved


def cell_means(points: Array, side: float) -> tuple[Array, NDArray[np.intp], NDArray[np.intp]]:
    """The mean (k, d) of those of the points (n, d), at least one, that share a cell of `side`; the first of them (k,),
    and how many they are (k,)."""
    cells = np.floor(points / side).astype(np.int64)
    cells -= cells.min(axis=0)
    # One number for a cell, in the same order: rows of an array sort slowly.
    numbers = np.ravel_multi_index(tuple(cells.T), tuple(cells.max(axis=0) + 1))
    _, first, place, counts = np.unique(numbers, return_index=True, return_inverse=True, return_counts=True)
    sums = np.stack([np.bincount(place, column) for column in points.T], axis=1)
    return sums / counts[:, None], first, counts


def quantile(values: Array, share: float) -> float:
    """The value below which a `share` of some (n,) lies, as `np.quantile`, whose checks take ten times as long."""
    at = (len(values) - 1) * share
    low = int(at)
    high, rest = min(low + 1, len(values) - 1), at - low
    parts = np.partition(values, (low, high))
    a, b = float(parts[low]), float(parts[high])
    return a + (b - a) * rest if rest < 0.5 else b - (b - a) * (1.0 - rest)


def yaw_matrix(yaw: float) -> Array:
    """Rotation matrix (3, 3) by `yaw` about z."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def yaw_quat(yaw: float) -> tuple[float, float, float, float]:
    """Rotation by `yaw` about z."""
    return math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)


def quat_yaw(q: tuple[float, float, float, float]) -> float:
    """Heading of a rotation: the angle of its x axis in the ground plane."""
    w, x, y, z = q
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def turn_matrix(turn: Array) -> Array:
    """Rotation matrix (3, 3) of a rotation vector (3,) [rad]."""
    angle = float(np.linalg.norm(turn))
    x, y, z = (float(v) for v in 0.5 * np.sinc(angle / math.tau) * turn)
    return quat_matrix((math.cos(angle / 2), x, y, z))


def quat_matrix(q: tuple[float, float, float, float]) -> Array:
    """Rotation matrix (3, 3) of a unit quaternion."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def matrix_quat(r: Array) -> tuple[float, float, float, float]:
    """Unit quaternion with w >= 0 of a rotation matrix (3, 3); Shepperd's method."""
    t = np.array([r[0, 0] + r[1, 1] + r[2, 2], r[0, 0], r[1, 1], r[2, 2]])
    i = int(np.argmax(t))
    if i == 0:
        q = np.array([1 + t[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    else:
        a, b, c = [(0, 1, 2), (1, 2, 0), (2, 0, 1)][i - 1]
        q = np.zeros(4)
        q[0] = r[c, b] - r[b, c]
        q[1 + a] = 1 + r[a, a] - r[b, b] - r[c, c]
        q[1 + b] = r[a, b] + r[b, a]
        q[1 + c] = r[a, c] + r[c, a]
    q /= np.linalg.norm(q)
    w, x, y, z = (float(v) for v in (q if q[0] >= 0 else -q))
    return w, x, y, z
