"""What the pads find on a surface of points: how far apart they come to lie, how much of each, on how steep a place."""

import math
from dataclasses import dataclass

import numpy as np

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


def contacts(local: Array, floor: tuple[Array, float], opening: float) -> list[tuple[Array, Contact]]:
    """What pads find wherever they may come to lie with one rotation, and where (3,) their middle is then [m].

    `local` (n, 3): the surface along the hand's axes, from the object's middle: x along the pads' width, y the closing
    direction, z the approach. `floor`: the upward direction (3,) in these axes, and the height [m] over the object's
    middle below which no fingertip may come. The surface is looked at in `CELL`s, 3 x 4 to a pad.
    """
    up, level = floor
    low = np.array([local[:, 0].min(), local[:, 2].min()])
    # The lowest pads that the floor allows lie on whole cells.
    deepest = _deepest(up, level, 0.0)
    if math.isfinite(deepest):
        low[1] = deepest + PAD - math.ceil((deepest + PAD - low[1]) / CELL[1]) * CELL[1]
    index = np.floor((local[:, (0, 2)] - low) / CELL).astype(int) + PADDING
    shape = (int(index[:, 0].max()) + 1 + PADDING[0], int(index[:, 1].max()) + 1 + PADDING[1])
    left, right = np.full(shape, -np.inf), np.full(shape, np.inf)
    np.maximum.at(left, (index[:, 0], index[:, 1]), local[:, 1])
    np.minimum.at(right, (index[:, 0], index[:, 1]), local[:, 1])
    first, sides = _first(np.isfinite(left)), [left, -right]
    height = float(np.ptp(local @ up))
    if height <= 2 * PAD:
        sides = [_without_upper_face(side) for side in sides]
    pads = [np.lib.stride_tricks.sliding_window_view(side, CELLS) for side in sides]
    tops = [pad.max(axis=(2, 3)) for pad in pads]
    with np.errstate(invalid="ignore"):
        middle, width = (tops[0] - tops[1]) / 2, tops[0] + tops[1]
        reach = [_passed(side) for side in sides]
        fits = np.maximum(reach[0] - middle, reach[1] + middle) <= opening / 2 - PLAY
    least = tuple(2 if np.ptp(local[:, axis]) > 2 * size else 1 for axis, size in zip((0, 2), CELL, strict=True))
    shares, slopes = zip(*(_touched(pad, top, least) for pad, top in zip(pads, tops, strict=True)), strict=True)
    share, slope = np.minimum(*shares), np.maximum(*slopes)
    # Between whole cells the pads stay a little farther back, if something of a low thing is between them still.
    back = min(CELL[1], max(0.0, height - PLAY)) / 2
    found = []
    for i, k in zip(*np.nonzero(fits & (width > 0) & (slope <= STEEPEST)), strict=True):
        along = float(low[0] + (i + CELLS[0] / 2 - PADDING[0]) * CELL[0])
        deep = float(low[1] + (k + CELLS[1] / 2 - PADDING[1]) * CELL[1])
        within = (k + CELLS[1] / 2 - first[i]) * CELL[1] <= HAND_DEPTH
        across, apart = float(middle[i, k]), float(width[i, k])
        can = _deepest(up, level, along, across, apart)
        if within and abs(along) <= LONGEST and deep <= can + back + 1e-6:
            at = np.array([along, across, min(deep, can)])
            found.append((at, Contact(apart, float(share[i, k]), float(slope[i, k]))))
    return found


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
    touched = [
        _touched(pad[None, None], np.array([[top]]), (1, 1)) for pad, top in zip((left, -right), tops, strict=True)
    ]
    shares, slopes = zip(*touched, strict=True)
    return Contact(sum(tops), float(np.minimum(*shares)[0, 0]), float(np.maximum(*slopes)[0, 0]))


def _deepest(up: Array, level: float, along: float, across: float = 0.0, width: float = 0.0) -> float:
    """How far along the approach [m] the pads' middle can be, `along` and `across` it, with no fingertip below `level`
    where they are `width` apart.
    """
    turn, lean, down = float(up[0]), float(up[1]), -float(up[2])
    # The lowest corner of the tips: PAD beyond the middle, half a finger to either side, behind the lower pad.
    tip = turn * along - abs(turn) * FINGER_HALF + lean * across - abs(lean) * (width / 2 + BEHIND_PAD)
    return (tip - level) / down - PAD if down > 1e-3 else math.inf


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
    wide = np.pad(reached, 1, constant_values=filled.shape[1])
    found: Array = np.lib.stride_tricks.sliding_window_view(wide, CELLS[0] + 2).min(axis=1)
    return found


def _passed(side: Array) -> Array:
    """For every pad's place the outermost [m] that a finger passes on its way there."""
    so_far = np.maximum.accumulate(side, axis=1)
    found: Array = np.lib.stride_tricks.sliding_window_view(so_far, (CELLS[0], 1))[:, CELLS[1] - 1 :].max(axis=(2, 3))
    return found


def _touched(pad: Array, top: Array, least: tuple[int, ...]) -> tuple[Array, Array]:
    """For pads (n, m, 3, 4) of cells with the outermost height in each: the share that touches, the slope of that.

    The slope is infinite where less than `least` of the columns and rows have something in them: there it is not known.
    """
    with np.errstate(invalid="ignore"):
        above = pad - top[..., None, None]
    share = (above > -FLAT).mean(axis=(2, 3))
    filled = np.isfinite(above)
    v, u = np.meshgrid((np.arange(CELLS[1]) - 1.5) * CELL[1], (np.arange(CELLS[0]) - 1.0) * CELL[0])
    basis = np.stack([u, v, np.ones(CELLS)])
    depth = np.where(filled, np.maximum(above, -STEP), 0.0)
    of_row = np.exp(-((depth.max(axis=2, where=filled, initial=-STEP, keepdims=True) / NEAR) ** 2))
    weight = np.where(filled, np.maximum(of_row, LEAST_WEIGHT), 0.0)
    # Least squares of a plane through the cells; the ridge leaves directions without cells level.
    normal = np.einsum("nmij,aij,bij->nmab", weight, basis, basis) + np.diag([1e-6, 1e-6, 1e-9])
    right = np.einsum("nmij,aij->nma", weight * depth, basis)
    plane = np.linalg.solve(normal, right[..., None])[..., 0]
    known = (filled.any(axis=3).sum(axis=2) >= least[0]) & (filled.any(axis=2).sum(axis=2) >= least[1])
    return share, np.where(known, np.hypot(plane[..., 0], plane[..., 1]), np.inf)
