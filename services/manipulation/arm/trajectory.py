"""Joint paths: collision-free by straight line or RRT-Connect, then timed and sampled for streaming."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from services.manipulation.arm.arm_model import ArmModel, Array

STEP = 0.06
"""Largest change of a joint [rad] between two collision checks on a line. Chosen: 5 cm at the end of the stretched
arm."""
EXTEND = 0.35
"""Length [rad] of a new branch of the search tree in joint space. Chosen: some five collision checks."""
MAX_NODES = 1500
"""Samples after which the search gives up. Chosen: half a second of planning."""
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


def timed(path: Sequence[Array], speed: float, acceleration: float, dt: float) -> Array:
    """Set-points (n, 7) every `dt` seconds along a piecewise straight path, from rest to rest.

    The fastest joint runs a trapezoid of `speed` [rad/s] and `acceleration` [rad/s^2]; corners are rounded.
    """
    points = np.array(path)
    lengths = np.abs(np.diff(points, axis=0)).max(axis=1)
    total = float(lengths.sum())
    if total < 1e-6:
        return points[-1:]
    peak = min(speed, math.sqrt(acceleration * total))
    ramp = peak / acceleration
    duration = total / peak + ramp
    t = np.arange(dt, duration + dt, dt)
    rising = 0.5 * acceleration * np.square(np.minimum(t, ramp))
    cruise = peak * np.clip(t - ramp, 0, duration - 2 * ramp)
    falling = np.clip(t - (duration - ramp), 0, ramp)
    s = np.minimum(rising + cruise + peak * falling - 0.5 * acceleration * np.square(falling), total)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    samples = np.stack([np.interp(s, along, points[:, k]) for k in range(points.shape[1])], axis=1)
    if len(path) > 2:
        padded = np.concatenate([np.repeat(points[:1], _SMOOTH, 0), samples, np.repeat(points[-1:], _SMOOTH, 0)])
        kernel = np.ones(_SMOOTH) / _SMOOTH
        samples = np.stack([np.convolve(padded[:, k], kernel, "valid") for k in range(padded.shape[1])], axis=1)
    samples[-1] = points[-1]
    return samples
