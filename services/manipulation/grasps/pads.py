"""What the pads find on a surface of points: how far apart they come to lie, how much of each, on how steep a place."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from common.geometry import Array
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.clearance import FLAT, PAD, PAD_HALF

FINGER_HALF = 0.0135
"""Half the width [m] of a finger."""
BEHIND_PAD = 0.008
"""How thick [m] a fingertip is behind its pad (Robotiq 2F-85)."""
PLAY = 0.003
"""Least distance [m] of open fingers from the object on either side, and of their tips from what it rests on."""
STEP = 0.02
"""Depth [m] that counts for a part of the surface that lies deeper under the pad: an edge is no place for it."""
NEAR, LEAST_WEIGHT = 0.008, 0.05
"""Depth [m] under the pad at which what is across it at one place along the approach counts 1/e for how steep the
surface is, and what the deepest counts: of a rod that lies the pads touch the widest line, however its upper side falls
away. Chosen: the deepest of a rod of 25 mm counts a tenth."""
STEEPEST = 0.45
"""Steepest surface under a pad, as a tangent: 24 degrees, within the cone of friction 0.6 with the error of normals."""
CELLS = (3, 4)
"""Cells of a pad across its width and along the approach."""
CELL = np.array([2 * PAD_HALF / CELLS[0], 2 * PAD / CELLS[1]])
"""Size of a cell [m]."""
PADDING = np.array([CELLS[0] - 1, CELLS[1] - 1])
"""Empty cells around an object, so that pads may reach beyond it."""
HAND_DEPTH = 0.036
"""How far [m] an object may reach into the hand from the pads' middle (Robotiq 2F-85: the inner links are 30 mm behind
it, and the hand may keep back a little)."""
LONGEST = 0.06
"""Farthest [m] from an object's middle that it is taken: beyond, its weight turns it between the pads."""


@dataclass(frozen=True)
class Contact:
    """What both pads find: `width` [m] between them, `share` of the worse pad that lies on the surface, `slope` of the
    steeper side as a tangent.
    """

    width: float
    share: float
    slope: float


@dataclass(frozen=True)
class Contacts:
    """What pads find at places `at` (n, 3) [m] of their middle along the hand's axes: as `Contact`, each (n,)."""

    at: Array
    width: Array
    share: Array
    slope: Array


@dataclass(frozen=True)
class Wanted:
    """What alone is looked for: places with a `width` [m] from one to the other, `aside` (from, to) [m] from the
    object's middle along the closing direction, and the least `share` of a pad.
    """

    width: tuple[float, float] = (0.0, math.inf)
    aside: tuple[float, float] = (-math.inf, math.inf)
    share: float = 0.0


_NOWHERE = Contacts(np.empty((0, 3)), *np.empty((3, 0)))


def contacts(local: Array, floor: tuple[Array, float], opening: float, wanted: Wanted = Wanted()) -> Contacts:
    """What pads find wherever they may come to lie with one rotation.

    `local` (n, 3): the surface along the hand's axes, from the object's middle: x along the pads' width, y the closing
    direction, z the approach. `floor`: the upward direction (3,) in these axes, and the height [m] over the object's
    middle below which no fingertip may come. The surface is looked at in `CELL`s, 3 x 4 to a pad.
    """
    up, level = floor
    low = np.array([local[:, 0].min(), local[:, 2].min()])
    # The lowest pads that the floor allows lie on whole cells.
    deepest = float(_deepest(up, level, 0.0))
    if math.isfinite(deepest):
        low[1] = deepest + PAD - math.ceil((deepest + PAD - low[1]) / CELL[1]) * CELL[1]
    index = np.floor((local[:, (0, 2)] - low) / CELL).astype(int) + PADDING
    shape = (int(index[:, 0].max()) + 1 + PADDING[0], int(index[:, 1].max()) + 1 + PADDING[1])
    sides, cells = np.full((2, *shape), -np.inf), index[:, 0] * shape[1] + index[:, 1]
    for side, outward in zip(sides, (local[:, 1], -local[:, 1]), strict=True):
        np.maximum.at(side.reshape(-1), cells, outward)
    height = float(np.ptp(local @ up))
    filled = np.isfinite(sides[0])
    if height <= 2 * PAD:
        sides = np.stack([_without_upper_face(side) for side in sides])
    tops = _largest(_largest(sides, CELLS[0], 1), CELLS[1], 2)
    with np.errstate(invalid="ignore"):
        middle, width = (tops[0] - tops[1]) / 2, tops[0] + tops[1]
        reach = _passed(sides)
        fits = np.maximum(reach[0] - middle, reach[1] + middle) <= opening / 2 - PLAY
        fits &= (width > 0) & (width >= wanted.width[0]) & (width <= wanted.width[1])
        fits &= (middle >= wanted.aside[0]) & (middle <= wanted.aside[1])
    rows, columns = np.nonzero(fits)
    if not len(rows):
        return _NOWHERE
    along = low[0] + (rows + CELLS[0] / 2 - PADDING[0]) * CELL[0]
    deep = low[1] + (columns + CELLS[1] / 2 - PADDING[1]) * CELL[1]
    can = _deepest(up, level, along, middle[fits], width[fits])
    # Between whole cells the pads stay a little farther back, if something of a low thing is between them still.
    back = min(CELL[1], max(0.0, height - PLAY)) / 2
    near = (columns + CELLS[1] / 2 - _first(filled)[rows]) * CELL[1] <= HAND_DEPTH
    near &= (np.abs(along) <= LONGEST) & (deep <= can + back + 1e-6)
    at = np.stack([along, middle[fits], np.minimum(deep, can)], axis=1)[near]
    rows, columns = rows[near], columns[near]
    if not len(rows):
        return _NOWHERE
    pads = [np.lib.stride_tricks.sliding_window_view(side, CELLS)[rows, columns] for side in sides]
    with np.errstate(invalid="ignore"):
        above = [pad - pad.max(axis=(1, 2), keepdims=True, initial=-np.inf) for pad in pads]
    share, slope = np.minimum(*map(_share, above)), np.full(len(at), np.inf)
    much = share >= wanted.share
    if not much.any():
        return _NOWHERE
    least = tuple(2 if np.ptp(local[:, axis]) > 2 * size else 1 for axis, size in zip((0, 2), CELL, strict=True))
    slope[much] = np.maximum(*(_slope(side[much], least) for side in above))
    held = slope <= STEEPEST
    return Contacts(at[held], width[rows, columns][held], share[held], slope[held])


def contact_at(surface: Array, pose: Pose) -> Contact | None:
    """What both pads find where they close at a pose on a surface of points (n, 3); None when one of them finds
    nothing.
    """
    local = (surface - pose.position) @ pose.rotation
    index = np.floor((local[:, (0, 2)] + (PAD_HALF, PAD)) / CELL).astype(int)
    within = ((index >= 0) & (index < CELLS)).all(axis=1)
    if not within.any():
        return None
    left, right = np.full(CELLS, -np.inf), np.full(CELLS, np.inf)
    np.maximum.at(left, tuple(index[within].T), local[within, 1])
    np.minimum.at(right, tuple(index[within].T), local[within, 1])
    tops = float(left.max()), float(-right.min())
    above = np.stack([left - tops[0], -right - tops[1]])
    return Contact(sum(tops), float(_share(above).min()), float(_slope(above, (1, 1)).max()))


def _deepest(up: Array, level: float, along: ArrayLike, across: ArrayLike = 0.0, width: ArrayLike = 0.0) -> Array:
    """How far along the approach [m] the pads' middle can be, `along` and `across` it, with no fingertip below `level`
    where they are `width` apart.
    """
    turn, lean, down = float(up[0]), float(up[1]), -float(up[2])
    # The lowest corner of the tips: PAD beyond the middle, half a finger to either side, behind the lower pad.
    behind = np.asarray(width) / 2 + BEHIND_PAD
    tip = turn * np.asarray(along) - abs(turn) * FINGER_HALF + lean * np.asarray(across) - abs(lean) * behind
    return (tip - level) / down - PAD if down > 1e-3 else np.full_like(tip, np.inf)


def _without_upper_face(side: Array) -> Array:
    """The outermost in each cell but the first on the hand's way where that is far behind the next: of something no
    higher than the pads it holds an upper face, which begins anywhere in it, and would read as the slope of a side.
    """
    found, columns, at = side.copy(), np.arange(len(side)), np.isfinite(side).argmax(axis=1)
    upper = side[columns, at] < side[columns, np.minimum(at + 1, side.shape[1] - 1)] - STEEPEST * CELL[1]
    found[columns[upper], at[upper]] = -np.inf
    return found


def _first(filled: Array) -> Array:
    """For every place of the pads across their width, the first cells along the approach that the hand comes upon."""
    reached = np.where(filled.any(axis=1), filled.argmax(axis=1), filled.shape[1])
    return -_largest(-np.pad(reached, 1, constant_values=filled.shape[1]), CELLS[0] + 2, 0)


def _passed(sides: Array) -> Array:
    """For every place of the pads on both sides (2, rows, columns) the outermost [m] that a finger passes to there."""
    return _largest(np.maximum.accumulate(sides, axis=2), CELLS[0], 1)[..., CELLS[1] - 1 :]


def _largest(values: Array, count: int, axis: int) -> Array:
    """The largest of each `count` neighbours along an axis."""
    values = values.swapaxes(axis, 0)
    last = len(values) - count + 1
    found = values[:last].copy()
    for n in range(1, count):
        np.maximum(found, values[n : n + last], out=found)
    return found.swapaxes(0, axis)


def _share(above: Array) -> Array:
    """The share (n,) that touches of pads (n, 3, 4) of cells with their height over the outermost."""
    found: Array = (above > -FLAT).mean(axis=(1, 2))
    return found


def _slope(above: Array, least: tuple[int, ...]) -> Array:
    """The slope (n,) of what pads touch; infinite where less than `least` of the columns and rows have something in
    them: there it is not known.
    """
    filled = np.isfinite(above)
    depth = np.where(filled, np.maximum(above, -STEP), 0.0)
    of_row = np.exp(-((depth.max(axis=1, where=filled, initial=-STEP, keepdims=True) / NEAR) ** 2))
    weight = np.where(filled, np.maximum(of_row, LEAST_WEIGHT), 0.0).reshape(len(above), math.prod(CELLS))
    # Least squares of a plane through the cells; the ridge leaves directions without cells level.
    normal = (weight @ _SQUARES).reshape(-1, 3, 3) + np.diag([1e-6, 1e-6, 1e-9])
    right = (weight * depth.reshape(weight.shape)) @ _BASIS
    plane = np.linalg.solve(normal, right[..., None])[..., 0]
    known = (filled.any(axis=2).sum(axis=1) >= least[0]) & (filled.any(axis=1).sum(axis=1) >= least[1])
    found: Array = np.where(known, np.hypot(plane[:, 0], plane[:, 1]), np.inf)
    return found


_BASIS = np.stack(
    [
        *(a.ravel() for a in np.meshgrid((np.arange(CELLS[1]) - 1.5) * CELL[1], (np.arange(CELLS[0]) - 1.0) * CELL[0])),
        np.ones(math.prod(CELLS)),
    ],
    axis=1,
)
"""Of a plane: along the approach, across, and level, at the cells of a pad (12, 3)."""
_SQUARES = (_BASIS[:, :, None] * _BASIS[:, None, :]).reshape(len(_BASIS), -1)
"""Their products (12, 9)."""
