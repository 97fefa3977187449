"""Global localisation: the poses in the map from which a scan may have been taken, the most plausible first. Pure.

A coarse search on a grid of positions and headings by the likelihood field of the scan's end points, fine matching of
the best, and what no end point tells: rays that pass through what is solid in the map.
Source of the likelihood field: Thrun, Burgard, Fox, "Probabilistic Robotics", 2005, section 6.4.
"""

import math
from dataclasses import dataclass

import numpy as np

from common.geometry import Array, Pose2, wrap
from services.navigation.localisation.distance_field import DistanceField
from services.navigation.localisation.localise import INLIER, Localiser

STEP, TURNS = 0.25, 48
"""Grid of positions [m] and number of headings; chosen: the fine matching converges from half of it."""
RAYS = 60
"""Rays of the scan that the coarse search uses [count]; chosen: keeps the whole search near 0.1 s."""
SPREAD = 0.15
"""Standard deviation of an end point in the coarse search [m]; chosen: about half of STEP."""
PER_TURN, BEST = 6, 48
"""Guesses kept of each heading, and those matched finely [count]; chosen: rooms look alike."""
BODY = 0.25
"""Distance from walls within which the robot cannot stand [m]; chosen: less than its footprint."""
APART, TURNED = 0.4, 0.35
"""Poses nearer to each other than this [m, rad] are the same; chosen: what the fine matching converges from."""
SAMPLE, SHORT = 0.06, 0.25
"""Spacing of the points of a ray that are looked at, and how far before its end the last is [m]: half a wall and less,
so that none is stepped over, and more than the errors of a pose."""
SOLID = -0.03
"""Signed distance [m] from which on a point of a ray lies in something solid: more than the field's grid."""
MOST_SAMPLES = 160
"""Points of one ray at most [count]: 10 m, the lidar's range."""


@dataclass
class Hypothesis:
    """A pose that a `localiser` tracks, and its plausibility, `score`, from -1 to 1."""

    localiser: Localiser
    score: float

    @property
    def pose(self) -> Pose2:
        return self.localiser.pose


def hypotheses(
    field: DistanceField, points: Array, low: tuple[float, float], high: tuple[float, float]
) -> list[Hypothesis]:
    """Distinct poses that explain scan end points (n, 2) [base frame], best first; none for a scan of too few points.

    `low` and `high` are corners of the map [m]. 0.1 s for the shipped flat.
    """
    xs, ys = np.arange(low[0], high[0], STEP), np.arange(low[1], high[1], STEP)
    spots = np.stack([axis.ravel() for axis in np.meshgrid(xs, ys)], axis=1)
    spots = spots[~field.near(spots, BODY)]
    if not len(spots) or len(points) < RAYS // 2:
        return []
    rays = points[:: max(1, len(points) // RAYS)]
    guesses: list[tuple[float, Pose2]] = []
    for k in range(TURNS):
        a = 2 * math.pi * k / TURNS
        turned = rays @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]])
        ends = (spots[:, None, :] + turned[None, :, :]).reshape(-1, 2)
        close = np.square(field.nearest(ends) / SPREAD).reshape(len(spots), -1)
        score = np.exp(-0.5 * np.minimum(close, 16.0)).mean(axis=1)
        for n in np.argsort(score)[-PER_TURN:]:
            guesses.append((float(score[n]), (float(spots[n, 0]), float(spots[n, 1]), a)))
    found: list[Hypothesis] = []
    for _, guess in sorted(guesses, reverse=True)[:BEST]:
        localiser = Localiser(field)
        localiser.place(guess, (STEP, STEP, 2 * math.pi / TURNS))
        localiser.correct(rays)
        localiser.correct(points)
        found.append(Hypothesis(localiser, plausibility(field, localiser.pose, points)))
    return distinct(found)


def distinct(found: list[Hypothesis]) -> list[Hypothesis]:
    """The best of each group of poses that are the same, best first."""
    kept: list[Hypothesis] = []
    for one in sorted(found, key=lambda h: -h.score):
        if not any(same(one.pose, other.pose) for other in kept):
            kept.append(one)
    return kept


def plausibility(field: DistanceField, pose: Pose2, points: Array) -> float:
    """Share of the scan's rays that end on the map, less the share of those that pass through something solid.

    What stands about and is not in the map shortens rays: they count for nothing. `points` (n, 2) [base frame].
    """
    if field.near(np.array([pose[:2]]), BODY)[0]:
        return -1.0
    c, s = math.cos(pose[2]), math.sin(pose[2])
    ways = points @ np.array([[c, s], [-s, c]])
    here = np.array(pose[:2])
    on_map = np.abs(field.nearest(here + ways)) < INLIER
    lengths = np.hypot(*ways.T)
    count = int(min(MOST_SAMPLES, max(2.0, lengths.max() / SAMPLE)))
    steps = np.arange(1, count + 1) * SAMPLE
    directions = ways / np.maximum(lengths, 1e-9)[:, None]
    samples = here + directions[:, None, :] * steps[None, :, None]
    solid = field.nearest(samples.reshape(-1, 2)).reshape(len(points), count) < SOLID
    through = (solid & (steps[None, :] < lengths[:, None] - SHORT)).any(axis=1)
    return float(np.mean(on_map & ~through) - np.mean(through))


def same(a: Pose2, b: Pose2) -> bool:
    """True for poses that are so near that they are one hypothesis."""
    return math.dist(a[:2], b[:2]) < APART and abs(wrap(a[2] - b[2])) < TURNED
