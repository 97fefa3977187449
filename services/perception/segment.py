"""Which pixels stand up from a surface, cut into things. Pure.

The furniture of the floor plan says where surfaces can be; the image says how high they are. Everything above a
surface, inside its edges and not too tall is kept, cut where the depth jumps, and pieces that stand in the same
spot are joined again.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.scene import Receptacle, Scene
from services.perception.view import Mask, View

CLEARANCE = 0.008
MAX_HEIGHT = 0.30
PLANE_SEARCH = 0.025
MIN_PLANE = 60
MIN_PIXELS = 24
JUMP = 0.022
JUMP_PER_METRE = 0.012
JOIN = 0.02
JOINED_EXTENT = 0.17
MAX_EXTENT = 0.30
WALL_MARGIN = 0.035
FLOOR_MARGIN = 0.10
FLOOR_RANGE = 2.2


@dataclass(frozen=True)
class Surface:
    """A horizontal surface as it was seen: `height` [m] measured, `name` "" for the floor."""

    name: str
    height: float


@dataclass(frozen=True)
class Piece:
    """One thing on a surface: its pixels (rows, columns) and their points (n, 3) in frame map."""

    surface: Surface
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    points: NDArray[np.float64]
    cut: bool


def pieces(view: View, scene: Scene, max_range: float, robot: Mask | None = None) -> list[Piece]:
    """The things that stand on the surfaces of the scene. `robot` marks the pixels that show the robot itself."""
    depth = view.depth
    usable = (depth > 0.05) & (depth < max_range)
    if robot is not None:
        usable &= ~robot
    found: list[Piece] = []
    points = view.points
    free = usable & (points[..., 2] < MAX_HEIGHT) & (depth < FLOOR_RANGE) & ~_near_walls(points, scene, FLOOR_MARGIN)
    usable &= ~_near_walls(points, scene, WALL_MARGIN)
    for r in scene.receptacles:
        inside = usable & _inside(points, r, -0.012)
        if np.count_nonzero(inside) >= MIN_PIXELS:
            found += _on(view, Surface(r.name, r.center[2]), inside)
        free &= ~_in_box(
            points, r.center[0], r.center[1], r.yaw, r.size[0] + 2 * FLOOR_MARGIN, r.size[1] + 2 * FLOOR_MARGIN
        )
    for box in scene.furniture:
        size = box.size[0] + 2 * FLOOR_MARGIN, box.size[1] + 2 * FLOOR_MARGIN
        free &= ~_in_box(points, box.center[0], box.center[1], box.yaw, *size)
    if np.count_nonzero(free) >= MIN_PLANE:
        found += _on(view, Surface("", 0.0), free)
    return found


def _in_box(points: NDArray[np.float32], x: float, y: float, yaw: float, sx: float, sy: float) -> Mask:
    c, s = math.cos(yaw), math.sin(yaw)
    dx, dy = points[..., 0] - x, points[..., 1] - y
    inside: Mask = (np.abs(c * dx + s * dy) < sx / 2) & (np.abs(c * dy - s * dx) < sy / 2)
    return inside


def _inside(points: NDArray[np.float32], r: Receptacle, margin: float) -> Mask:
    inside = _in_box(points, r.center[0], r.center[1], r.yaw, r.size[0] + 2 * margin, r.size[1] + 2 * margin)
    z = points[..., 2] - r.center[2]
    return inside & (z > -PLANE_SEARCH) & (z < MAX_HEIGHT)


def _near_walls(points: NDArray[np.float32], scene: Scene, margin: float) -> Mask:
    near = np.zeros(points.shape[:2], bool)
    for wall in scene.walls:
        dx, dy = wall.end[0] - wall.start[0], wall.end[1] - wall.start[1]
        middle = ((wall.start[0] + wall.end[0]) / 2, (wall.start[1] + wall.end[1]) / 2)
        length, width = math.hypot(dx, dy), wall.thickness + 2 * margin
        near |= _in_box(points, *middle, math.atan2(dy, dx), length + width, width)
    return near


def _on(view: View, expected: Surface, inside: Mask) -> list[Piece]:
    """Pieces above one surface, its height measured where enough of it is visible."""
    z = view.points[..., 2]
    level = z[inside & (np.abs(z - expected.height) < PLANE_SEARCH)]
    if len(level) >= MIN_PLANE:
        heights, edges = np.histogram(level, bins=25)
        peak = int(heights.argmax())
        level = level[np.abs(level - (edges[peak] + edges[peak + 1]) / 2) < 0.006]
        surface = Surface(expected.name, float(np.median(level)))
    else:
        surface = expected
    above = inside & (z > surface.height + CLEARANCE) & (z < surface.height + MAX_HEIGHT)
    labels = ndimage.label(_cut(above, view.depth))[0]
    parts = []
    for n, box in enumerate(ndimage.find_objects(labels), 1):
        rows, columns = np.nonzero(labels[box] == n)
        if len(rows) >= MIN_PIXELS // 3:
            parts.append((rows + box[0].start, columns + box[1].start))
    return [p for p in _join(view, surface, parts) if len(p.rows) >= MIN_PIXELS and _is_thing(p)]


def _is_thing(piece: Piece) -> bool:
    """Neither as wide as furniture nor reaching up like a wall."""
    top = float(piece.points[:, 2].max()) - piece.surface.height
    return _extent([piece.points]) < MAX_EXTENT and top < MAX_HEIGHT - 0.01


def _cut(mask: Mask, depth: NDArray[np.float32]) -> Mask:
    """The mask without the far side of every depth jump."""
    kept = mask.copy()
    for axis in (0, 1):
        a = [slice(None), slice(None)]
        b = [slice(None), slice(None)]
        a[axis], b[axis] = slice(None, -1), slice(1, None)
        first, second = tuple(a), tuple(b)
        step = depth[second] - depth[first]
        limit = JUMP + JUMP_PER_METRE * np.minimum(depth[first], depth[second])
        kept[second] &= ~(step > limit)
        kept[first] &= ~(step < -limit)
    return kept


def _extent(parts: Sequence[NDArray[np.float64]]) -> float:
    low = np.min([p[:, :2].min(axis=0) for p in parts], axis=0)
    high = np.max([p[:, :2].max(axis=0) for p in parts], axis=0)
    return float((high - low).max())


def _join(view: View, surface: Surface, parts: list[tuple[NDArray[np.intp], NDArray[np.intp]]]) -> list[Piece]:
    """Parts of one thing, such as the two sides of a mug's rim or a bottle's cap, stand in the same spot."""
    clouds = [view.points[rows, columns].astype(np.float64) for rows, columns in parts]
    groups = list(range(len(parts)))
    order = sorted(range(len(parts)), key=lambda i: -len(clouds[i]))
    for n, i in enumerate(order):
        for j in order[n + 1 :]:
            if groups[i] == groups[j]:
                continue
            members = [k for k in range(len(parts)) if groups[k] in (groups[i], groups[j])]
            if _extent([clouds[k] for k in members]) < JOINED_EXTENT and _gap(clouds[i], clouds[j]) < JOIN:
                old, new = groups[j], groups[i]
                groups = [new if g == old else g for g in groups]
    found = []
    h, w = view.shape
    for group in sorted(set(groups)):
        members = [k for k in range(len(parts)) if groups[k] == group]
        rows = np.concatenate([parts[k][0] for k in members])
        columns = np.concatenate([parts[k][1] for k in members])
        cut = bool(rows.min() <= 1 or columns.min() <= 1 or rows.max() >= h - 2 or columns.max() >= w - 2)
        found.append(Piece(surface, rows, columns, np.concatenate([clouds[k] for k in members]), cut))
    return found


def _gap(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Horizontal distance between two clouds, from a sample of each."""
    pa = a[:: max(1, len(a) // 120), :2]
    pb = b[:: max(1, len(b) // 120), :2]
    distance = np.linalg.norm(pa[:, None] - pb[None], axis=2)
    return float(distance.min())
