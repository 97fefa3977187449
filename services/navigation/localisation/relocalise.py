"""Global localisation: where in the map a scan was taken, by a coarse grid search and fine matching of the best."""

import math

import numpy as np

from common.geometry import Pose2
from services.navigation.localisation.distance_field import Array, DistanceField
from services.navigation.localisation.localise import Localiser

STEP, TURNS = 0.25, 48
"""Grid of positions [m] and number of headings; chosen: the fine matching converges from half of it."""
RAYS = 60
"""Rays of the scan that the coarse search uses [count]; chosen: keeps the whole search near 0.1 s."""
SPREAD = 0.15
"""Standard deviation of an end point in the coarse search [m]; chosen: about half of STEP."""
BEST = 16
"""Guesses that are matched finely [count]; chosen: rooms look alike."""
BODY = 0.25
"""Distance from walls within which the robot cannot stand [m]; chosen: less than its footprint."""


def relocalise(
    field: DistanceField, points: Array, low: tuple[float, float], high: tuple[float, float]
) -> tuple[Pose2, float]:
    """The pose that explains scan end points (n, 2) [base frame] best, and the share of them it explains; ~0.1 s."""
    xs, ys = np.arange(low[0], high[0], STEP), np.arange(low[1], high[1], STEP)
    spots = np.stack([axis.ravel() for axis in np.meshgrid(xs, ys)], axis=1)
    spots = spots[~field.near(spots, BODY)]
    if not len(spots) or len(points) < RAYS // 2:
        return (0.0, 0.0, 0.0), 0.0
    rays = points[:: max(1, len(points) // RAYS)]
    found: list[tuple[float, Pose2]] = []
    for k in range(TURNS):
        a = 2 * math.pi * k / TURNS
        turned = rays @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]])
        ends = (spots[:, None, :] + turned[None, :, :]).reshape(-1, 2)
        close = np.square(field.nearest(ends) / SPREAD).reshape(len(spots), -1)
        score = np.exp(-0.5 * np.minimum(close, 16.0)).mean(axis=1)
        for n in np.argsort(score)[-3:]:
            found.append((float(score[n]), (float(spots[n, 0]), float(spots[n, 1]), a)))
    best: tuple[float, Pose2] = (0.0, (0.0, 0.0, 0.0))
    for _, guess in sorted(found, reverse=True)[:BEST]:
        localiser = Localiser(field)
        localiser.place(guess, (STEP, STEP, 2 * math.pi / TURNS))
        localiser.correct(points)
        localiser.correct(points)
        if localiser.fit > best[0]:
            best = localiser.fit, localiser.pose
    return best[1], best[0]
