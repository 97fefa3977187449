"""What an object that nobody listed is: shape family, pose and extents of one segment, from its points alone. Pure.

Every primitive that its outline allows is fitted with free parameters; the one that explains points and silhouette
best is the shape. What no primitive explains is `irregular`: its oriented extents are reported.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from services.perception.shapes import lying, oval, primitives, turned
from services.perception.shapes.measurement import Measurement
from services.perception.shapes.primitives import Silhouette

THINNEST = 0.003
"""Least height [m] of an object. Chosen: that of the lowest points which are told from their surface."""
SAMPLE = 180
"""Points of a segment that are used, evenly spread. Chosen: more only takes longer."""
IRREGULAR, IRREGULAR_NOISE = 0.003, 0.8
"""Mean distance [m], plus that of noise, from which on no primitive explains the points."""
SOLID, GAPS = 0.86, 0.02
"""Share of its convex hull that the outline of a convex shape covers at least, and the distance [m] that what is
missing counts as. Chosen: boxes and balls have .90 and more, crossed arms half."""
HANDLED = 0.35
"""Share of that for a shape with a handle, which leaves a gap."""
LAID = 0.95
"""Length on the floor plan by height from which a shape may lie on its side: the shortest mug is as long as wide."""
VAGUE, VAGUE_NOISE, VAGUELY, LEAST_NOISE = 0.006, 4.0, 1.75, 0.001
"""Spread [m] of what lies, plus that of noise, which is much, and how much of it times the points' distance by their
noise (`LEAST_NOISE` [m] at least) is too much: the points do not tell where its axis is, and do not fit it. Chosen:
cans, bottles and mugs on their side have 1 and less, a mug of which one end is seen 1.7; teapots 2 to 13."""
DOUBT, DOUBT_NOISE = 0.0003, 0.12
"""Difference [m] of two shapes' costs, plus that of noise, at which the worse one is 1/e as likely."""
LEAST_RIVAL = 0.1
"""Likelihood of another shape, by that of the best, from which it is told of."""
OUTLINE = 0.02
"""Standard deviation [m] of the extents of what is seen from above, by its outline: that of pixels that show two things
at its edge."""
UNEXPLAINED = 0.7
"""Mean distance by the points' noise from which a box or something round may be an oval. Chosen: a box has .5 to .6,
a can .5 to .8, a bottle of shampoo taken for a box .75 to 1.5."""
COMPLEX = 0.06
"""What each free parameter costs, as a share of the residual: the simpler of two equal shapes is taken."""


def measure(
    points: Array,
    floor: float,
    camera: Array,
    seen: tuple[bool, bool],
    half_pixel: float,
    noise: float,
    dark: Array | None = None,
    of_handle: NDArray[np.bool_] | None = None,
) -> Measurement:
    """The shape of points (n, 3) [map] that stand on height `floor` and were seen from `camera` (3,).

    `seen`: its right and left end are in view; `half_pixel` [rad]; `noise`: standard deviation [m] of the points.
    `dark` (m, 3): where the rest of its outline is about, of which no distance is known. `of_handle` (n,): which points
    are of a handle by the picture.
    """
    local = points - (0.0, 0.0, floor)
    every = max(1, len(local) // SAMPLE)
    used = local[::every]
    thin = of_handle[::every] if of_handle is not None else np.zeros(len(used), bool)
    whole = local if dark is None or not len(dark) else np.concatenate([local, dark - (0.0, 0.0, floor)])
    outline = primitives.silhouette(whole, camera, seen, half_pixel)
    eye = camera - (0.0, 0.0, floor)
    steep = abs(eye[2] - local[:, 2].mean()) / max(1e-3, float(np.linalg.norm(eye - local.mean(axis=0))))
    h = max(THINNEST, primitives.top_of(whole, noise * steep))
    shapes = [_box(used, h, outline, noise)]
    _, _, extents, _ = primitives.rectangle(used[:, :2], 12)[0]
    wide, narrow = float(extents.max()), float(extents.min())
    if len(whole) > len(local):
        # What faces away from the lamps is missing: it may be as deep as it is wide.
        wide = narrow = max(wide, float(outline.distance * np.ptp(outline.ends)) if all(seen) else wide)
    if narrow > 0.45 * wide or not all(seen):
        shapes.append(turned.standing(used, h, outline, eye, noise, thin))
    if 0.6 < h / wide < 1.5:
        shapes.append(_ball(used, h, outline, noise))
    if wide > LAID * h:
        laid = lying.lying(used, h, outline, eye, noise)
        shapes += [s for s in laid if not all(seen) or not _vague(s, noise)]
    if h > 0.6 * wide and len(whole) == len(local) and min(s.residual for s in shapes) > UNEXPLAINED * noise:
        shapes += [found] if (found := oval.standing(used, h, outline, noise)) is not None else []
    gaps = GAPS * max(0.0, SOLID - primitives.solidity(whole, eye))
    shapes = [replace(s, residual=s.residual + (gaps if math.isnan(s.handle) else HANDLED * gaps)) for s in shapes]
    costs = [(1 - s.credit) * s.residual + COMPLEX * s.free * (0.001 + 0.3 * noise) for s in shapes]
    best = shapes[int(np.argmin(costs))]
    shares = [math.exp((min(costs) - cost) / (DOUBT + DOUBT_NOISE * noise)) for cost in costs]
    rivals = [(w, s) for w, s in zip(shares, shapes, strict=True) if w > LEAST_RIVAL and s.family != best.family]
    if best.family == "box" and best.profile:
        # An oval is held like a box and looks like something round.
        across = math.sqrt(best.size[0] * best.size[1])
        rivals.append((1.0, replace(best, family="round", size=(across, across, h))))
    best = replace(best, rivals=tuple(rivals))
    if best.residual > IRREGULAR + IRREGULAR_NOISE * noise:
        best = _irregular(used, h, noise, best.residual)
    return replace(best, yaw=math.remainder(best.yaw, math.tau))


def _vague(laid: Measurement, noise: float) -> bool:
    """A shape on its side is not what the points are of."""
    much = laid.spread / (VAGUE + VAGUE_NOISE * noise)
    return much * laid.residual / max(noise, LEAST_NOISE) > VAGUELY


def _ball(points: Array, h: float, outline: Silhouette, noise: float) -> Measurement:
    (x, y), r = turned.start(points, outline)
    start = np.array([x, y, (r + h / 2) / 2])
    solution = primitives.fit(primitives.ball(), primitives.round_ends(0.0), start, points, outline, noise)
    x, y, r = (float(v) for v in solution.p)
    off = solution.residual + 0.3 * max(0.0, abs(2 * r - h) - 0.004 - noise)
    return Measurement("ball", x, y, 0.0, (2 * r, 2 * r, 2 * r), off, turned.spread(solution, slice(0, 3)), free=3)


def _box(points: Array, h: float, outline: Silhouette, noise: float) -> Measurement:
    away = np.array([math.cos(outline.ahead), math.sin(outline.ahead)])
    tried, ends = [], primitives.corner_ends(lies=False)
    for _, yaw, extents, middle in primitives.rectangle(points[:, :2], 12)[:2]:
        # Of what shows one face only the depth is a guess: as deep as it is wide, moved back.
        length, width = (max(float(e), 0.01) for e in extents)
        start = np.array([*middle, yaw, length, width])
        # What is seen from above is seen to its far side; only its outline says so, no point of that side does.
        wide = np.array([1.0, 1.0, 1.0, *([0.3, 0.3] if _front_only(points, h) else [OUTLINE, OUTLINE])])
        if min(length, width) < 0.35 * max(length, width) and h > 0.06 and _front_only(points, h):
            thin = 4 if width < length else 3
            guess = 0.7 * max(length, width)
            start[:2] += away * (guess - start[thin]) / 2
            start[thin], wide[thin] = guess, 0.02
        tried.append(primitives.fit(primitives.box(h), ends, start, points, outline, noise, (start, wide)))
    solution = min(tried, key=lambda s: s.residual)
    x, y, yaw, length, width = (float(v) for v in solution.p)
    length, width = max(0.008, abs(length)), max(0.008, abs(width))
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    yaw = math.remainder(yaw, math.pi)
    spread = float(np.sqrt(np.diag(solution.covariance)[[0, 1, 3, 4]].max()))
    unlikely = 0.0015 if width < 0.3 * min(length, h) else 0.0
    return Measurement("box", x, y, yaw, (length, width, h), solution.residual + unlikely, spread, free=5)


def _front_only(points: Array, h: float) -> bool:
    """Hardly any point is of the top."""
    return bool(np.mean(points[:, 2] > h - 0.01) < 0.08)


def _irregular(points: Array, h: float, noise: float, residual: float) -> Measurement:
    """Oriented extents of what is no primitive: the best of these leaves `residual` [m]."""
    _, yaw, extents, middle = primitives.rectangle(points[:, :2], 12)[0]
    length, width = (max(float(e), 0.01) for e in extents)
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    x, y = (float(v) for v in middle)
    return Measurement("irregular", x, y, math.remainder(yaw, math.pi), (length, width, h), residual, 0.01 + noise)
