"""Comparison of a map made by the robot with the truth: errors of walls and surfaces, and what was missed. Pure."""

import math
from typing import NamedTuple

import numpy as np

from common.floor_plan import FloorPlan, Receptacle
from common.geometry import Rectangle
from common.household import Household
from common.scene import Scene

WALL, HEIGHT, OUTLINE = 0.03, 0.01, 0.05
"""Aims [m]: the distance of a wall's face from the nearest true one, a surface's height, and each of its edges."""
SAME = 0.35
"""Middles of surfaces farther apart [m] are not the same one."""
SPACING = 0.05
"""Between the points of a wall that are compared [m]."""


class Errors(NamedTuple):
    """Of one home [m]; `missed` and `extra` name surfaces, `covered` is the share of true walls that were found."""

    walls: np.ndarray
    covered: float
    heights: list[float]
    outlines: list[float]
    found: int
    missed: list[str]
    extra: list[str]

    def row(self) -> dict[str, object]:
        """The errors as a row of the report: in cm, median and 90 % quantile of walls, median and worst of surfaces."""
        aims = {"walls": (self.walls, 0.9), "heights": (self.heights, 1.0), "outlines": (self.outlines, 1.0)}
        return {
            **{name: centimetres(values, share) for name, (values, share) in aims.items()},
            "walls_covered": round(self.covered, 3), "surfaces": self.found, "missed": self.missed, "extra": self.extra,
        }  # fmt: skip


def compare(made: Household, truth: Scene) -> Errors:
    """Compare a mapped floor plan with the true one."""
    heights, outlines, missed = [], [], []
    left = list(made.receptacles)
    for r in truth.receptacles:
        near = [o for o in left if math.dist(o.center[:2], r.center[:2]) < SAME and bool(o.depth) == bool(r.depth)]
        if not near:
            missed.append(r.name)
            continue
        own = min(near, key=lambda o: math.dist(o.center[:2], r.center[:2]))
        left.remove(own)
        heights.append(abs(_top(own) - _top(r)))
        outlines.append(edge_error(own.outline, r.outline))
    extra = [r.name for r in left if not any(b.outline.contains(*r.center[:2]) for b in truth.furniture)]
    walls, covered = wall_errors(made, truth)
    return Errors(walls, covered, heights, outlines, len(heights), missed, extra)


def _top(r: Receptacle) -> float:
    return r.depth or r.center[2]


def edge_error(a: Rectangle, b: Rectangle) -> float:
    """The mean distance [m] of the corners of two rectangles, in the best order."""
    one, two = a.corners, b.corners
    return min(sum(math.dist(one[i], two[(i + k) % 4]) for i in range(4)) / 4 for k in range(4)) / math.sqrt(2)


def wall_errors(made: FloorPlan, truth: FloorPlan) -> tuple[np.ndarray, float]:
    """Distances [m] of the mapped walls' faces from the nearest true face of anything, and the share of the true walls
    that have a mapped face within twice the aim."""
    faces = [face for w in truth.walls for face in _faces(w.footprint)]
    solid = [f for box in truth.footprints for f in _faces(box)]
    errors: list[float] = []
    mapped: list[np.ndarray] = []
    for wall in made.walls:
        pair = _faces(wall.footprint)[:2]
        mapped += pair
        # Of a wall that was seen from one side the other one is a guess.
        errors += list(np.minimum(*(_nearest(p, faces + solid) for p in pair)))
    points = np.concatenate([f for w in truth.walls for f in _faces(w.footprint)[:2]])
    # A face that is in no room, nobody can see.
    free = np.any([r.outline.signed_distances(points[:, 0], points[:, 1]) < -0.02 for r in truth.rooms], axis=0)
    for box in truth.footprints:
        free &= box.grown(0.10).signed_distances(points[:, 0], points[:, 1]) > 0.0
    near = _nearest(points[free], mapped) < 2 * WALL if mapped else np.zeros(1, bool)
    return np.array(errors or [math.inf]), float(np.mean(near))


def _faces(r: Rectangle) -> list[np.ndarray]:
    """Points (n, 2) along the sides of a rectangle, the long ones first."""
    found = []
    for along, across, turned in ((r.length, r.width, False), (r.width, r.length, True)):
        u = np.linspace(-along / 2, along / 2, max(2, int(along / SPACING)))
        for side in (-0.5, 0.5):
            v = np.full(len(u), side * across)
            x, y = r.to_map(v, u) if turned else r.to_map(u, v)
            found.append(np.stack([x, y], axis=1))
    return found


def _nearest(points: np.ndarray, faces: list[np.ndarray]) -> np.ndarray:
    """Distance (n,) of each point from the nearest of the faces, as straight lines between their points."""
    best = np.full(len(points), np.inf)
    for face in faces:
        a, b = face[0], face[-1]
        way = b - a
        share = np.clip((points - a) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
        np.minimum(best, np.hypot(*(points - a - share[:, None] * way).T), out=best)
    return best


def centimetres(values: object, share: float) -> tuple[float, float] | None:
    """Median and quantile `share` [cm] of errors [m]; None of none."""
    rows = np.asarray(values, float)
    if not rows.size:
        return None
    return round(float(np.median(rows)) * 100, 2), round(float(np.quantile(rows, share)) * 100, 2)
