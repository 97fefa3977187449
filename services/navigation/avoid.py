"""Out of the way of what moves: wait, or step aside, when going on would bring the robot too close. Pure."""

import math
from collections.abc import Sequence

import numpy as np

from services.navigation.costmap import Array, Costmap
from services.navigation.movers import Mover

Point = tuple[float, float]
HORIZON, SAMPLE = 2.4, 0.2
SPEED, START_LAG = 0.42, 0.25
# Gaps [m] between the robot's round footprint and a mover: what is wanted, and beyond which more is no better.
WANTED, ENOUGH = 0.20, 0.45
ASIDE, DIRECTIONS = (0.35, 0.7), 16


def avoid(here: Point, target: Point, movers: Sequence[Mover], costmap: Costmap, radius: float) -> Point | None:
    """A better point to go to than `target` while somebody passes; None when going on is fine."""
    near = [m for m in movers if math.hypot(m.x - here[0], m.y - here[1]) < 3.0 + m.radius]
    if not near:
        return None
    # Moved a little way off, the target is where the robot would go on to.
    if _gap(here, _beyond(here, target), near, radius) >= WANTED:
        return None
    best, best_score = here, _score(here, here, target, near, radius)
    room = min(radius, costmap.clearance(*here)) - 0.02
    for distance in ASIDE:
        for k in range(DIRECTIONS):
            a = 2 * math.pi * k / DIRECTIONS
            spot = (here[0] + distance * math.cos(a), here[1] + distance * math.sin(a))
            score = _score(here, spot, target, near, radius)
            if score > best_score + 0.03 and costmap.line_clearance(here, spot) >= room:
                best, best_score = spot, score
    return best


def _beyond(here: Point, target: Point) -> Point:
    """The point HORIZON seconds on in the direction of the target."""
    dx, dy = target[0] - here[0], target[1] - here[1]
    length = math.hypot(dx, dy)
    if length < 0.05:
        return target
    reach = max(length, SPEED * HORIZON)
    return here[0] + dx * reach / length, here[1] + dy * reach / length


def _score(here: Point, spot: Point, target: Point, movers: Sequence[Mover], radius: float) -> float:
    """Safety first, then little detour."""
    gap = min(_gap(here, spot, movers, radius), ENOUGH)
    return gap - 0.05 * math.dist(spot, target) - 0.03 * math.dist(spot, here)


def _gap(here: Point, spot: Point, movers: Sequence[Mover], radius: float) -> float:
    """The least gap to any mover within the horizon on the way to `spot` and waiting there."""
    times = np.arange(SAMPLE, HORIZON + 1e-9, SAMPLE)
    length = math.dist(here, spot)
    share = np.minimum(np.maximum(times - START_LAG, 0.0) * SPEED, length) / max(length, 1e-9)
    x, y = here[0] + (spot[0] - here[0]) * share, here[1] + (spot[1] - here[1]) * share
    gaps: list[Array] = [np.hypot(m.x + m.vx * times - x, m.y + m.vy * times - y) - m.radius - radius for m in movers]
    return float(min(g.min() for g in gaps))
