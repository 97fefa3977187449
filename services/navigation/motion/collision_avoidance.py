"""Collision avoidance among moving obstacles: wait or step aside when going on would come too close. Pure."""

import math
from collections.abc import Sequence

import numpy as np

from common.geometry import Array, Point
from services.navigation.motion.obstacle_tracker import Obstacle
from services.navigation.planning.costmap import Costmap

HORIZON, SAMPLE = 2.4, 0.2
"""How far ahead gaps are predicted, and the step of it [s]; chosen: a person walks through a door in that time."""
SPEED, START_LAG = 0.42, 0.25
"""Speed of the base on its way [m/s] and delay until it moves [s]; chosen: on the safe side."""
NEAR = 3.0
"""Distance from which on an obstacle cannot come close within HORIZON [m]: at walking pace."""
WANTED, ENOUGH = 0.20, 0.45
"""Gap between footprint and obstacle [m] that is wanted, and beyond which more is no better; chosen: an arm's room."""
ASIDE, DIRECTIONS = (0.35, 0.7), 16
"""Distances [m] and number of directions in which it may step aside; chosen: half a footprint and a whole one."""
MARGIN, GAINED = 0.04, 0.03
"""Clearance beyond its footprint that a step aside leaves [m]: what the base overshoots; and how much more than here it
must have where there is less [m]."""
GAIN = 0.03
"""What a step aside must be better by [score, m]; chosen: so that it does not waver."""
TO_TARGET, TO_SPOT = 0.05, 0.03
"""What a metre to the target, and one to the spot, cost in the score [m/m]; chosen: far less than a metre of gap."""


def avoid(
    here: Point, target: Point, obstacles: Sequence[Obstacle], costmap: Costmap, radius: float, stands: bool = False
) -> Point | None:
    """A better point [map] to go to than `target` while somebody passes; None when going on is fine.

    `radius` is the footprint's [m]. A robot that `stands` its ground stays where it is instead of stepping aside.
    """
    near = [o for o in obstacles if math.hypot(o.x - here[0], o.y - here[1]) < NEAR + o.radius]
    if not near:
        return None
    # Moved a little way off, the target is where the robot would go on to.
    if _gap(here, _beyond(here, target), near, radius) >= WANTED:
        return None
    if stands:
        return here
    best, best_score = here, _score(here, here, target, near, radius)
    # Where there is little room already, only towards more: step by step it would be driven into what stands.
    clear = costmap.clearance(*here)
    room, enough = min(radius + MARGIN, clear), min(radius + MARGIN, clear + GAINED)
    for distance in ASIDE:
        for k in range(DIRECTIONS):
            a = 2 * math.pi * k / DIRECTIONS
            spot = (here[0] + distance * math.cos(a), here[1] + distance * math.sin(a))
            score = _score(here, spot, target, near, radius)
            if score <= best_score + GAIN or costmap.clearance(*spot) < enough:
                continue
            if costmap.line_clearance(here, spot) >= room:
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


def _score(here: Point, spot: Point, target: Point, obstacles: Sequence[Obstacle], radius: float) -> float:
    """Gap [m] first, then little detour."""
    gap = min(_gap(here, spot, obstacles, radius), ENOUGH)
    return gap - TO_TARGET * math.dist(spot, target) - TO_SPOT * math.dist(spot, here)


def _gap(here: Point, spot: Point, obstacles: Sequence[Obstacle], radius: float) -> float:
    """The least gap [m] to any obstacle within the horizon on the way to `spot` and waiting there."""
    times = np.arange(SAMPLE, HORIZON + 1e-9, SAMPLE)
    length = math.dist(here, spot)
    share = np.minimum(np.maximum(times - START_LAG, 0.0) * SPEED, length) / max(length, 1e-9)
    x, y = here[0] + (spot[0] - here[0]) * share, here[1] + (spot[1] - here[1]) * share
    gaps: list[Array] = [
        np.hypot(o.x + o.vx * times - x, o.y + o.vy * times - y) - o.radius - radius for o in obstacles
    ]
    return float(min(g.min() for g in gaps))
