"""Prediction of where two robots will be, each on its path, and whether they meet. Pure."""

import math
from dataclasses import dataclass, field

import numpy as np

from common.geometry import Array, Point

SPEED, LAG = 0.42, 0.3
"""Speed of a base on its way [m/s] and delay until it moves [s]; chosen: what it keeps between bends."""
SPEEDS = (0.15, 0.3, 0.5)
"""Speeds [m/s] that another robot may have: in bends, between them, and the base's greatest."""
HORIZON, SAMPLE = 10.0, 0.25
"""How far ahead meetings are predicted, and the step of it [s]; chosen: a drive through a door and out of its way."""
GAP = 0.15
"""Room [m] between two footprints that pass; chosen: the errors of both poses."""
TOUCHING = 0.06
"""Room [m] that a robot that gets out of the way leaves at least; the other one brakes for what its lidar sees."""
BRAKED = 0.08
"""Room [m] at which the other one's brake has stopped it: less than what `path_follower` keeps."""
NEAR = 2.5
"""Distance [m] from which on two robots cannot come close within `SOON`; chosen."""
SOON = 2.0
"""How far ahead [s] a robot that goes first looks at those that are getting out of its way; chosen: twice its way to a
stop and the age of their message."""
_TIMES: Array = np.arange(SAMPLE, HORIZON + 1e-9, SAMPLE)


@dataclass(frozen=True)
class Way:
    """A path of points (n, 2) [map]; n is 1 for a robot that stands."""

    points: Array
    lengths: Array = field(init=False)

    def __post_init__(self) -> None:
        steps = np.hypot(*np.diff(self.points, axis=0).T) if len(self.points) > 1 else np.zeros(0)
        object.__setattr__(self, "lengths", np.concatenate(([0.0], np.cumsum(steps))))

    def at(self, distance: Array) -> Array:
        """Points (k, 2) at the lengths (k,) [m] along the path; its last point for lengths beyond its end."""
        x, y = (np.interp(distance, self.lengths, column) for column in self.points.T)
        return np.stack((x, y), axis=-1)

    def resampled(self, step: float) -> "Way":
        """The same path with a point every `step` [m]."""
        length = float(self.lengths[-1])
        return Way(self.at(np.arange(0.0, length + step / 2, step) if length > 0 else np.zeros(1)))

    def cut(self, length: float) -> "Way":
        """The first `length` [m] of the path."""
        return Way(self.points[: max(1, int(np.searchsorted(self.lengths, length, side="right")))])


@dataclass(frozen=True)
class Other:
    """Another robot: its footprint [m], the way it goes, and whether it has stood still for some time."""

    name: str
    way: Way
    radius: float
    stalled: bool = False

    @property
    def place(self) -> Point:
        x, y = self.way.points[0]
        return float(x), float(y)

    def apart(self, points: Array) -> Array:
        """Distance (n,) [m] of points (n, 2) from its way."""
        steps = points[:, None, :] - self.way.points[None, :, :]
        found: Array = np.hypot(steps[..., 0], steps[..., 1]).min(axis=1)
        return found


def passes(way: Way, radius: float, other: Other) -> bool:
    """True when a robot that goes on does not meet the other, whatever speed the other drives at."""
    mine = way.at(np.maximum(_TIMES - LAG, 0.0) * SPEED)
    apart = math.dist(way.points[0], other.place)
    needed = min(radius + other.radius + GAP, apart - 0.02)
    for speed in (0.0,) if other.stalled else SPEEDS:
        theirs = other.way.at(_TIMES * speed)
        if np.hypot(*(mine - theirs).T).min() < needed:
            return False
    return True


def closes_in(way: Way, radius: float, other: Other) -> bool:
    """True when a robot that goes on soon comes too near to the other one, which also goes on."""
    times = _TIMES[_TIMES <= SOON]
    apart = math.dist(way.points[0], other.place)
    gaps = np.hypot(*(way.at(times * SPEED) - other.way.at(times * SPEED)).T)
    return bool(gaps.min() < min(radius + other.radius + GAP, apart - 0.02))


def escapes(way: Way, radius: float, other: Other) -> bool:
    """True when a robot can drive along `way` without meeting the other, which goes on until its own brake stops it."""
    apart = math.dist(way.points[0], other.place)
    sum_of_radii = radius + other.radius
    needed, brake = min(sum_of_radii + TOUCHING, apart - 0.01), sum_of_radii + BRAKED
    mine = way.at(np.maximum(_TIMES - LAG, 0.0) * SPEED)
    for speed in (0.0, *SPEEDS[1:]):
        gone = 0.0
        for here in mine:
            there = other.way.at(np.array(gone + speed * SAMPLE))
            gap = math.dist(here, there)
            if gap < brake:
                there = other.way.at(np.array(gone))
                gap = math.dist(here, there)
            else:
                gone += speed * SAMPLE
            if gap < needed:
                return False
    return True
