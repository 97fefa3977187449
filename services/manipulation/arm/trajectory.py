"""Joint paths: collision-free by straight line or RRT-Connect, then timed and sampled for streaming."""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from common.geometry import Array
from services.manipulation.arm.arm_model import ArmModel

STEP = 0.06
"""Largest change of a joint [rad] between two collision checks on a line. Chosen: 5 cm at the end of the stretched
arm."""
EXTEND = 0.35
"""Length [rad] of a new branch of the search tree in joint space. Chosen: some five collision checks."""
MAX_NODES = 1500
"""Samples after which the search gives up. Chosen: half a second of planning."""
PAUSE = 0.3
"""Length [rad] of a path in the open, between two near things, that is passed as slowly as they are. Chosen: what is
gained there the arm loses on stopping twice."""
_SMOOTH = 5
"""Set-points over which corners of a path are averaged: 0.1 s at 50 Hz."""


def free_line(collides: Callable[[Array], bool], start: Array, end: Array) -> bool:
    """True when no configuration on the straight joint line collides."""
    count = max(1, math.ceil(float(np.abs(end - start).max()) / STEP))
    return not any(collides(start + (end - start) * (i / count)) for i in range(1, count + 1))


def connect(arm: ArmModel, start: Array, goal: Array, rng: np.random.Generator) -> list[Array] | None:
    """A collision-free joint path from start to goal, shortened; None if none was found.

    RRT-Connect: Kuffner and LaValle, ICRA 2000.
    """
    if free_line(arm.collides, start, goal):
        return [start, goal]
    if arm.collides(goal):
        return None
    span = np.maximum(np.abs(goal - start), 0.6)
    low = np.maximum(np.minimum(start, goal) - span, np.where(arm.unlimited, -np.inf, arm.low))
    high = np.minimum(np.maximum(start, goal) + span, np.where(arm.unlimited, np.inf, arm.high))
    trees: list[tuple[list[Array], list[int]]] = [([start], [-1]), ([goal], [-1])]
    for _ in range(MAX_NODES):
        sample = rng.uniform(low, high)
        reached = _extend(arm, trees[0], sample, False)
        if reached is not None:
            met = _extend(arm, trees[1], trees[0][0][reached], True)
            if met is not None and np.allclose(trees[1][0][met], trees[0][0][reached], atol=1e-6):
                ahead, behind = _trace(trees[0], reached)[::-1], _trace(trees[1], met)
                path = ahead + behind[1:]
                return _shorten(arm, path if path[0] is start else path[::-1], rng)
        trees.reverse()
    return None


def _extend(arm: ArmModel, tree: tuple[list[Array], list[int]], towards: Array, greedy: bool) -> int | None:
    nodes, parents = tree
    near = int(np.argmin(np.square(np.array(nodes) - towards).sum(axis=1)))
    last = None
    while True:
        gap = towards - nodes[near]
        distance = float(np.linalg.norm(gap))
        if distance < 1e-9:
            return near
        new = towards if distance <= EXTEND else nodes[near] + gap * (EXTEND / distance)
        if not free_line(arm.collides, nodes[near], new):
            return last
        nodes.append(new)
        parents.append(near)
        near = last = len(nodes) - 1
        if not greedy or distance <= EXTEND:
            return last


def _trace(tree: tuple[list[Array], list[int]], node: int) -> list[Array]:
    nodes, parents = tree
    path = []
    while node >= 0:
        path.append(nodes[node])
        node = parents[node]
    return path


def _shorten(arm: ArmModel, path: list[Array], rng: np.random.Generator) -> list[Array]:
    for _ in range(60):
        if len(path) <= 2:
            break
        i, j = sorted(rng.choice(len(path), 2, replace=False))
        if j - i > 1 and free_line(arm.collides, path[i], path[j]):
            path = path[: i + 1] + path[j:]
    return path


def back_along(path: Sequence[Array], now: Array) -> list[Array]:
    """The way back to the beginning of a path from `now`, somewhere on it, without going deeper first."""
    nearest = int(np.argmin([np.abs(q - now).max() for q in path]))
    return list(path[max(nearest - 1, 0) :: -1])


def parallel(path: Sequence[Array], now: Array) -> list[Array]:
    """A path moved so that it begins `now`, a little off its beginning."""
    return [q + now - path[0] for q in path]


def divided(path: Sequence[Array], first: Callable[[Array], bool]) -> tuple[list[Array], list[Array]]:
    """A path in two: as long as `first` holds of its configurations, and the rest, which begins where the one ends."""
    head = [path[0]]
    for n, (a, b) in enumerate(itertools.pairwise(path)):
        count = max(1, math.ceil(float(np.abs(b - a).max()) / STEP))
        for i in range(1, count + 1):
            q = a + (b - a) * (i / count)
            if not first(q):
                return [*head, q], [q, *path[n + 1 :]]
        head.append(b)
    return head, []


@dataclass(frozen=True)
class Leg:
    """A part of a joint path, a list of (7,); `near` something, so that it is followed slowly."""

    path: list[Array]
    near: bool


def legs(path: Sequence[Array], near: Callable[[Array], bool]) -> list[Leg]:
    """A path in parts that are `near` something or not, in turn; each begins where the one before it ends."""
    found: list[Leg] = []
    left = list(path)
    while left:
        slow = near(left[0])
        head, left = divided(left, near if slow else lambda q: not near(q))
        slow = slow or (bool(found) and bool(left) and _length(head) < PAUSE)
        if found and found[-1].near == slow:
            found[-1] = Leg([*found[-1].path, *head[1:]], slow)
        else:
            found.append(Leg(head, slow))
    return found


def whole(parts: Sequence[Leg]) -> list[Array]:
    """The path that was divided into parts."""
    return [q for part in parts for q in part.path]


def _length(path: Sequence[Array]) -> float:
    """The way [rad] of the joint that moves most."""
    return float(sum(np.abs(b - a).max() for a, b in itertools.pairwise(path)))


def timed(path: Sequence[Array], speed: float, acceleration: float, dt: float) -> Array:
    """Set-points (n, 7) every `dt` seconds along a piecewise straight path, from rest to rest.

    The fastest joint keeps to `speed` [rad/s] and `acceleration` [rad/s^2], also where the path turns: corners are
    rounded over `_SMOOTH` set-points and passed as slowly as that asks for.
    """
    points = np.array(path)
    points = points[np.concatenate([[True], np.abs(np.diff(points, axis=0)).max(axis=1) > 1e-6])]
    if len(points) < 2:
        return np.array(path)[-1:]
    gaps = np.diff(points, axis=0)
    lengths = np.abs(gaps).max(axis=1)
    turns = np.abs(np.diff(gaps / lengths[:, None], axis=0)).max(axis=1)
    corners = np.minimum(speed, acceleration * _SMOOTH * dt / np.maximum(turns, 1e-9))
    s = _along(lengths, corners, speed, acceleration, dt)
    at = np.concatenate([[0.0], np.cumsum(lengths)])
    samples = np.stack([np.interp(s, at, points[:, k]) for k in range(points.shape[1])], axis=1)
    if len(points) > 2:
        padded = np.concatenate([np.repeat(points[:1], _SMOOTH, 0), samples, np.repeat(points[-1:], _SMOOTH, 0)])
        kernel = np.ones(_SMOOTH) / _SMOOTH
        samples = np.stack([np.convolve(padded[:, k], kernel, "valid") for k in range(padded.shape[1])], axis=1)
    samples[-1] = points[-1]
    return samples


def turned_back(sent: Array, joints: Array, speed: float, back: float, deceleration: float, dt: float) -> Array:
    """Set-points (m, 7) every `dt` seconds that turn round on a path.

    It was `sent` (n, 7) until now; they end `back` [rad] before where on it the arm is with its `joints` (7,), and go
    back at most with `speed` [rad/s].

    All joints brake together, as the path has them: where each brakes as it can, those of the wrist stop first, and the
    hand goes on another way, into what it has met.
    """
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(sent, axis=0)).max(axis=1))])
    nearest = int(np.argmin(np.abs(sent - joints).max(axis=1)))
    at, end = float(way[-1]), max(float(way[nearest]) - back, 0.0)
    # Braking it goes on along the path's last piece.
    velocity, change = (at - float(way[-2])) / dt if len(way) > 1 else 0.0, deceleration * dt
    ahead = sent[-1] - sent[-2] if len(way) > 1 and velocity else np.zeros(sent.shape[1])
    found = []
    while velocity > 0 or at > end + 1e-9:
        left = max(at - end, 0.0)
        wanted = -min(speed, math.sqrt(2 * deceleration * left + change**2 / 4) - change / 2, left / dt)
        velocity = max(velocity - change, wanted)
        at += velocity * dt
        beyond = max(at - float(way[-1]), 0.0) / max(float(np.abs(ahead).max()), 1e-9)
        found.append([np.interp(at, way, column) for column in sent.T] + beyond * ahead)
    return np.array(found) if found else sent[nearest : nearest + 1]


def _along(lengths: Array, corners: Array, speed: float, acceleration: float, dt: float) -> Array:
    """Way covered (n,) [rad] every `dt` seconds on pieces of `lengths` (m,), from rest to rest and with at most the
    speeds `corners` (m - 1,) between them.
    """
    limits = np.concatenate([[0.0], corners, [0.0]])
    for i in range(1, len(limits)):
        limits[i] = min(limits[i], math.sqrt(limits[i - 1] ** 2 + 2 * acceleration * lengths[i - 1]))
    for i in range(len(limits) - 2, -1, -1):
        limits[i] = min(limits[i], math.sqrt(limits[i + 1] ** 2 + 2 * acceleration * lengths[i]))
    begin, end = limits[:-1], limits[1:]
    peak = np.minimum(speed, np.sqrt(acceleration * lengths + (begin**2 + end**2) / 2))
    rise, fall = (peak - begin) / acceleration, (peak - end) / acceleration
    level = np.maximum(lengths - (begin + peak) / 2 * rise - (peak + end) / 2 * fall, 0.0) / peak
    # Three phases a piece: speed at its beginning, acceleration, duration.
    times = np.stack([rise, level, fall], axis=1).reshape(-1)
    speeds = np.stack([begin, peak, peak], axis=1).reshape(-1)
    gains = np.tile([acceleration, 0.0, -acceleration], len(lengths))
    starts = np.concatenate([[0.0], np.cumsum(times)])
    ways = np.concatenate([[0.0], np.cumsum(speeds * times + gains * times**2 / 2)])
    t = np.arange(dt, starts[-1] + dt, dt)
    n = np.clip(np.searchsorted(starts, t, side="right") - 1, 0, len(times) - 1)
    since = np.minimum(t - starts[n], times[n])
    way: Array = np.minimum(ways[n] + speeds[n] * since + gains[n] * since**2 / 2, lengths.sum())
    return way
