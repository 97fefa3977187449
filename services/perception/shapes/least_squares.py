"""Robust least squares in two or three unknowns, the way of `scipy.optimize.least_squares` with loss soft_l1 (trust
region), at a fraction of its overhead. Pure."""

from collections.abc import Callable

import numpy as np

from common.geometry import Array

ENOUGH = 1e-6
"""A step that lowers the cost by less than this share is the last."""
TINY = 1e-12
"""What no divisor falls below [of its unit, or of the largest]."""
# What is known at unknowns (k,): the residuals (n,) and their slopes (n, k).
Residuals = Callable[[Array], tuple[Array, Array]]


def solve(residuals: Residuals, start: Array, scale: float, tries: int) -> tuple[Array, float]:
    """The unknowns (k,) that make the residuals small, and their cost; a residual counts less beyond `scale`."""
    p = np.asarray(start, np.float64)
    apart, slopes = residuals(p)
    cost, weight = _cost(apart, scale)
    radius = float(np.linalg.norm(p))
    for _ in range(tries):
        gradient = (weight * apart) @ slopes
        curvature = (slopes * (weight**3)[:, None]).T @ slopes
        step = _within(radius, curvature, gradient)
        then = residuals(p + step)
        new, new_weight = _cost(then[0], scale)
        length = float(np.linalg.norm(step))
        promised = -float(gradient @ step + step @ curvature @ step / 2)
        kept = (cost - new) / max(promised, TINY * cost)
        if kept < 0.25:
            radius = length / 4
        elif kept > 0.75 and length > 0.95 * radius:
            radius *= 2
        last = length < ENOUGH or (kept > 0.25 and cost - new < ENOUGH * cost)
        if new < cost:
            p, cost, weight, (apart, slopes) = p + step, new, new_weight, then
        if last:
            break
    return p, cost


def _cost(apart: Array, scale: float) -> tuple[float, Array]:
    """Sum of the losses, and the weight (n,) of each residual."""
    root = np.sqrt(1.0 + (apart / scale) ** 2)
    return float(root.sum() - len(root)) * scale * scale, 1.0 / root


def _within(radius: float, curvature: Array, gradient: Array) -> Array:
    """The step of at most that length that promises most."""
    bends, axes = np.linalg.eigh(curvature)
    along = gradient @ axes
    bends = np.maximum(bends, TINY * bends[-1] + TINY)
    damping = 0.0
    for _ in range(10):
        moves = along / (bends + damping)
        length = float(np.sqrt(moves @ moves))
        if length <= 1.01 * radius:
            break
        damping += (length / radius - 1) * length * length / float(moves @ (moves / (bends + damping)))
    return np.asarray(-axes @ moves * min(1.0, radius / max(length, TINY)))
