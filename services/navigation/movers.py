"""People and other things on the move: clusters of lidar points that the map does not explain, tracked over scans."""

import math
from dataclasses import dataclass

import numpy as np

from services.navigation.floorplan import Array

Point = tuple[float, float]
GAP, MATCH = 0.25, 0.45
MIN_POINTS, MAX_EXTENT = 3, 1.0
# A person seen from the front: the middle lies this far behind the surface [m].
DEPTH = 0.12
POSITION_GAIN, SPEED_GAIN = 0.5, 0.25
MIN_SPEED, MAX_SPEED = 0.2, 2.0
MIN_SIGHTINGS, MAX_SILENCE = 4, 0.6


@dataclass
class Mover:
    """A tracked cluster: middle, velocity and radius, in frame map."""

    x: float
    y: float
    radius: float
    seen_at: float
    vx: float = 0.0
    vy: float = 0.0
    sightings: int = 1

    @property
    def moves(self) -> bool:
        return self.sightings >= MIN_SIGHTINGS and math.hypot(self.vx, self.vy) > MIN_SPEED


class Movers:
    """Alpha-beta tracks; `update` takes the unexplained points of a scan in the order of their angles."""

    def __init__(self) -> None:
        self._tracks: list[Mover] = []

    def update(self, points: Array, eye: Point, now: float) -> None:
        free = list(self._tracks)
        for x, y, radius in clusters(points, eye):
            best = min(free, key=lambda t: math.hypot(*_ahead(t, now, x, y)), default=None)
            if best is None or math.hypot(*_ahead(best, now, x, y)) > MATCH:
                self._tracks.append(Mover(x, y, radius, now))
                continue
            free.remove(best)
            _correct(best, x, y, radius, now)
        self._tracks = [t for t in self._tracks if now - t.seen_at < MAX_SILENCE]

    def moving(self) -> list[Mover]:
        """Those that move."""
        return [t for t in self._tracks if t.moves]


def clusters(points: Array, eye: Point) -> list[tuple[float, float, float]]:
    """Middle and radius of each group of neighbouring points (n, 2)."""
    if len(points) < MIN_POINTS:
        return []
    gaps = np.hypot(*np.diff(points, axis=0).T)
    found = []
    for group in np.split(points, np.nonzero(gaps > GAP)[0] + 1):
        extent = float(np.hypot(*(group.max(axis=0) - group.min(axis=0))))
        if len(group) < MIN_POINTS or extent > MAX_EXTENT:
            continue
        x, y = group.mean(axis=0).tolist()
        away = math.hypot(x - eye[0], y - eye[1]) or 1.0
        found.append((x + DEPTH * (x - eye[0]) / away, y + DEPTH * (y - eye[1]) / away, max(0.12, extent / 2)))
    return found


def _ahead(t: Mover, now: float, x: float, y: float) -> tuple[float, float]:
    """How far (x, y) is from where the track should be."""
    dt = now - t.seen_at
    return x - t.x - t.vx * dt, y - t.y - t.vy * dt


def _correct(t: Mover, x: float, y: float, radius: float, now: float) -> None:
    dt = max(now - t.seen_at, 1e-3)
    dx, dy = _ahead(t, now, x, y)
    t.x += t.vx * dt + POSITION_GAIN * dx
    t.y += t.vy * dt + POSITION_GAIN * dy
    t.vx += SPEED_GAIN * dx / dt
    t.vy += SPEED_GAIN * dy / dt
    speed = math.hypot(t.vx, t.vy)
    if speed > MAX_SPEED:
        t.vx, t.vy = t.vx * MAX_SPEED / speed, t.vy * MAX_SPEED / speed
    t.radius = max(radius, 0.9 * t.radius)
    t.seen_at, t.sightings = now, t.sightings + 1
