"""Dynamic obstacle tracker: clusters of lidar points that the map does not explain, followed from scan to scan."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, Point

GAP = 0.25
"""Distance between neighbouring points that separates clusters [m]; chosen: a person's legs stay one cluster."""
MATCH = 0.45
"""Distance of a cluster from a track's prediction up to which it is the same [m]; chosen: less than two people's."""
MIN_POINTS, MAX_EXTENT = 3, 1.0
"""Least points [count] and greatest extent [m] of a cluster; chosen: noise is smaller, furniture larger."""
STOOD = 0.3
"""Share of a cluster on what has stood there from which it is that [-]; chosen: a new side of it comes in sight."""
DEPTH, MIN_RADIUS = 0.12, 0.12
"""How far the middle of a person lies behind the side that is seen, and the least radius [m]; chosen: half a body."""
POSITION_GAIN, SPEED_GAIN = 0.5, 0.25
"""Gains alpha and beta of the filter [-]; chosen: smooth at 10 scans a second."""
MIN_SPEED, MAX_SPEED = 0.2, 2.0
"""Speeds of what moves [m/s]; chosen: above the drift of a standing cluster, up to a hurried walk."""
MIN_SIGHTINGS, MAX_SILENCE = 4, 0.6
"""Scans before a track counts [count] and time without one after which it ends [s]; chosen: 0.4 s, six scans."""
WALKED = 0.5
"""Way [m] from where it was first seen after which a track is a person, who may walk on: more than the apparent motion
of what stands."""
HIDDEN, STRIDES = 3.0, 1.0
"""Time [s] for which somebody who went out of sight is expected to show again, at up to this speed [m/s]; chosen:
behind another person or a door's frame, at a walk."""
SHRINK = 0.9
"""Share of its radius that a track keeps when less of it is seen [-]."""


@dataclass
class Obstacle:
    """A tracked cluster: middle [m], velocity [m/s] and radius [m], in frame map; `walked`: it is no furniture."""

    x: float
    y: float
    radius: float
    seen_at: float
    vx: float = 0.0
    vy: float = 0.0
    sightings: int = 1
    start: Point = (math.nan, math.nan)
    walked: bool = False

    @property
    def moves(self) -> bool:
        return self.sightings >= MIN_SIGHTINGS and math.hypot(self.vx, self.vy) > MIN_SPEED


class ObstacleTracker:
    """Alpha-beta filters, one for each obstacle.

    Source: Kalata, "The tracking index", IEEE Trans. Aerospace and Electronic Systems 20(2), 1984.
    """

    def __init__(self) -> None:
        self._tracks: list[Obstacle] = []
        self._hidden: list[Obstacle] = []

    def update(self, points: Array, eye: Point, now: float, stood: NDArray[np.bool_] | None = None) -> None:
        """Take the unexplained points (n, 2) [map] of a scan, in the order of their angles, seen from `eye`.

        `stood` (n,): which of them are on what has stood there. As the robot drives past it, it seems to move.
        """
        free = list(self._tracks)
        for x, y, radius in clusters(points, eye, stood):
            best = min(free, key=lambda t: math.hypot(*_ahead(t, now, x, y)), default=None)
            if best is None or math.hypot(*_ahead(best, now, x, y)) > MATCH:
                self._tracks.append(Obstacle(x, y, radius, now, start=(x, y), walked=self._shows_again(x, y, now)))
                continue
            free.remove(best)
            _correct(best, x, y, radius, now)
        self._hidden = [t for t in self._hidden if now - t.seen_at < HIDDEN]
        self._hidden += [t for t in self._tracks if t.walked and now - t.seen_at >= MAX_SILENCE]
        self._tracks = [t for t in self._tracks if now - t.seen_at < MAX_SILENCE]

    def _shows_again(self, x: float, y: float, now: float) -> bool:
        """A person who went out of sight may have come to a point by now; each shows again once."""
        for person in self._hidden:
            if math.dist((person.x, person.y), (x, y)) < MATCH + STRIDES * (now - person.seen_at):
                self._hidden.remove(person)
                return True
        return False

    def people(self) -> list[Obstacle]:
        """What moves, and what stands after it has walked."""
        return [t for t in self._tracks if t.moves or t.walked]


def clusters(points: Array, eye: Point, stood: NDArray[np.bool_] | None = None) -> list[tuple[float, float, float]]:
    """Middle and radius [m] of each group of neighbouring points (n, 2) [map], seen from `eye`, but for what `stood`
    (n,) there."""
    if len(points) < MIN_POINTS:
        return []
    ends = np.nonzero(np.hypot(*np.diff(points, axis=0).T) > GAP)[0] + 1
    shares = [float(part.mean()) for part in np.split(stood, ends)] if stood is not None else [0.0] * (len(ends) + 1)
    found = []
    for group, share in zip(np.split(points, ends), shares, strict=True):
        extent = float(np.hypot(*(group.max(axis=0) - group.min(axis=0))))
        if len(group) < MIN_POINTS or extent > MAX_EXTENT or share > STOOD:
            continue
        x, y = group.mean(axis=0).tolist()
        away = math.hypot(x - eye[0], y - eye[1]) or 1.0
        found.append((x + DEPTH * (x - eye[0]) / away, y + DEPTH * (y - eye[1]) / away, max(MIN_RADIUS, extent / 2)))
    return found


def _ahead(t: Obstacle, now: float, x: float, y: float) -> tuple[float, float]:
    """Vector [m] from where the track should be now to (x, y)."""
    dt = now - t.seen_at
    return x - t.x - t.vx * dt, y - t.y - t.vy * dt


def _correct(t: Obstacle, x: float, y: float, radius: float, now: float) -> None:
    dt = max(now - t.seen_at, 1e-3)
    dx, dy = _ahead(t, now, x, y)
    t.x += t.vx * dt + POSITION_GAIN * dx
    t.y += t.vy * dt + POSITION_GAIN * dy
    t.vx += SPEED_GAIN * dx / dt
    t.vy += SPEED_GAIN * dy / dt
    speed = math.hypot(t.vx, t.vy)
    if speed > MAX_SPEED:
        t.vx, t.vy = t.vx * MAX_SPEED / speed, t.vy * MAX_SPEED / speed
    t.walked = t.walked or (t.moves and math.dist((t.x, t.y), t.start) > WALKED)
    t.radius = max(radius, SHRINK * t.radius)
    t.seen_at, t.sightings = now, t.sightings + 1
