"""RGB-D sensor model: what a stereo depth camera would report of a rendered image. Pure.

Source: Intel RealSense D400 series datasheet (337029-013): baseline 50 mm (D435), least range 175 mm at 640 x 480,
sub-pixel disparity of 5 bits; depth noise from Intel's "Best known methods for tuning D435": RMS of some .15 % at 1 m,
growing with the square of the distance.
"""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from common.rendering.renderer import Surfaces

Rgb = NDArray[np.uint8]
Depth = NDArray[np.floating]

BASELINE = 0.05
"""Distance of the two imagers [m]."""
NOISE_AT_1_M = 0.0015
"""Standard deviation of depth at 1 m [m]."""
SUBPIXELS = 32
"""Steps of disparity per pixel."""
LEAST_RANGE = 0.175
"""Depth [m] below which the disparity is beyond the matcher's search."""
MATCHING_WINDOW = 5
"""Side [px] of the window that is matched: noise has bumps of that size, and what is narrower gets no depth."""
EDGE = 0.04
"""Ratio of neighbouring depths from which on an edge goes through the matching window, and no depth is found."""
DARK, GLARE = 12, 250
"""Level (of 255) below which all channels are too dark to match, and above which all are saturated; chosen."""
DIM = 60
"""Level (of 255) of the brightest channel below which the noise of depth grows as that of the light does, with the
square root of how little comes back; chosen: a black rubber or plastic thing in a lit room."""
MIRRORED = 15.0
"""Angle [deg] between a surface as glossy as a mirror and the line of sight below which the projector's light comes
straight back and saturates the imagers; less gloss, less angle. Chosen: the stripe without depth on a tin."""
GLOSS_LOST, CLEAR_LOST = 0.15, 0.5
"""Shares of a mirror and of a transparent surface that find no match, as the pattern is elsewhere or twice; chosen."""
PIXEL_NOISE = 2.0
"""Standard deviation of a pixel's level (of 255) at the gain of a lit room; chosen: what an 8-bit web camera has."""
EXPOSURE, WHITE_BALANCE = 0.08, 0.04
"""Largest deviations of all channels together and of red and blue alone; chosen: automatic control that has settled."""
MOUNT_OFFSET, MOUNT_TURN = 0.003, 0.3
"""Most that a camera sits off its drawing, along and about each axis [m, deg]; chosen: a printed bracket with play."""
BLOCK = 32
"""Rows of a picture that are worked out at once [count]; chosen: what they need fits the processor's cache."""
MARGIN = 64
"""By how much [px] the noise that is drawn once is larger than a picture, which takes a piece from a random corner of
it: drawing it anew would cost as much as the picture."""
_FAINT = np.sqrt(DIM / np.clip(np.arange(256), DARK, DIM)).astype(np.float32)
"""How many times larger the noise of depth is, by the level of the brightest channel."""


@dataclass(frozen=True)
class Picture:
    """`rgb` (h, w, 3); `depth` (h, w) [mm], 0 where there is none."""

    rgb: Rgb
    depth: NDArray[np.uint16]


def exact(rgb: Rgb, depth: Depth) -> Picture:
    """The rendered image as it is; `depth` (h, w) [m], 0 for nothing."""
    return Picture(rgb, np.clip(np.round(depth * 1000), 0, 65535).astype(np.uint16))


class StereoCamera:
    """One camera of a robot: what differs from camera to camera is drawn from `seed`.

    It sits `offset` (3,) [m] and `turn` (3,) [rad, a rotation vector] off its drawing, both in its optical frame.
    """

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self._seed = seed
        gain = 1.0 + rng.uniform(-EXPOSURE, EXPOSURE)
        red, blue = 1.0 + rng.uniform(-WHITE_BALANCE, WHITE_BALANCE, 2)
        levels = np.array([gain * red, gain, gain * blue])[:, None] * np.arange(256)
        self._levels = np.clip(np.round(levels), 0, 255).astype(np.int16)
        self.offset = rng.uniform(-MOUNT_OFFSET, MOUNT_OFFSET, 3)
        self.turn = np.radians(rng.uniform(-MOUNT_TURN, MOUNT_TURN, 3))
        self._noise: dict[tuple[int, int], tuple[NDArray[np.float32], NDArray[np.int16]]] = {}

    def expose(self, rgb: Rgb, depth: Depth, focal: float, moment: int, surfaces: Surfaces | None = None) -> Picture:
        """What the sensor reports of a rendered `rgb` (h, w, 3) and `depth` (h, w) [m], 0 for nothing.

        `focal` [px]; the same `moment` [ticks] repeats the same noise. `surfaces` None: all matt and opaque.
        """
        bumps, grain = self._drawn(depth.shape)
        row, column = np.random.default_rng([self._seed, moment]).integers(MARGIN, size=2)
        piece = slice(row, row + depth.shape[0]), slice(column, column + depth.shape[1])
        noise, seen, measured = bumps[piece], np.empty_like(rgb), np.empty(depth.shape, np.uint16)
        for top in range(0, len(rgb), BLOCK):
            rows, around = slice(top, top + BLOCK), slice(max(top - 1, 0), top + BLOCK + 1)
            seen[rows] = self._seen(rgb[rows], grain[piece][rows])
            far = np.where(depth[around] > 0.0, depth[around], np.inf).astype(np.float32)
            own = slice(top - around.start, top - around.start + BLOCK)
            measured[rows] = _measure(rgb[rows], far[own], focal, noise[rows], _edges(far)[own])
        if surfaces is not None:
            measured[_unmatched(surfaces, depth, focal, noise[::-1, ::-1])] = 0
        return Picture(seen, measured)

    def _seen(self, rgb: Rgb, grain: NDArray[np.int16]) -> Rgb:
        """The colours (h, w, 3) at this camera's gain, with their noise."""
        levels = np.stack([np.take(table, rgb[..., k]) for k, table in enumerate(self._levels)], axis=-1)
        levels += grain
        return np.clip(levels, 0, 255, out=levels).astype(np.uint8)

    def _drawn(self, shape: tuple[int, ...]) -> tuple[NDArray[np.float32], NDArray[np.int16]]:
        """Noise of unit variance and of levels for pictures of a shape, always the same."""
        height, width = shape
        if (height, width) not in self._noise:
            size = height + MARGIN, width + MARGIN
            rng = np.random.default_rng([self._seed, *size])
            bumps = smoothed(rng.standard_normal(size, np.float32))
            grain = np.round(rng.normal(0.0, PIXEL_NOISE, (*size, 3))).astype(np.int16)
            self._noise[height, width] = bumps / bumps.std(), grain
        return self._noise[height, width]


def smoothed(noise: NDArray[np.float32]) -> NDArray[np.float32]:
    """The mean (h, w) over the matching window, round the edges; scipy would be too large for that alone."""
    half = MATCHING_WINDOW // 2
    for axis in (0, 1):
        total = np.zeros(noise.shape)
        for by in range(-half, half + 1):
            total += np.roll(noise, by, axis)
        noise = (total / MATCHING_WINDOW).astype(np.float32)
    return noise


def quantiles(shares: Depth) -> Depth:
    """The values (h, w) below which those shares of normal noise lie."""
    few, place = np.unique(shares, return_inverse=True)
    values = np.array([NormalDist().inv_cdf(p) if p > 0.0 else -np.inf for p in few.tolist()])
    return np.asarray(values[place.reshape(shares.shape)])


def _measure(
    rgb: Rgb, far: NDArray[np.float32], focal: float, noise: NDArray[np.float32], edges: NDArray[np.bool_]
) -> NDArray[np.uint16]:
    """Depth (h, w) [mm] from disparity with `noise` (h, w) of unit variance; 0 where none can be matched."""
    scale = np.float32(focal * BASELINE)
    true = scale / far
    red, green, blue = (rgb[..., channel] for channel in range(3))
    brightest, darkest = np.maximum(np.maximum(red, green), blue), np.minimum(np.minimum(red, green), blue)
    noise = noise * _FAINT[brightest]
    disparity = np.round((true + noise * (NOISE_AT_1_M * scale)) * SUBPIXELS)
    blind = (far < LEAST_RANGE) | np.isinf(far) | (disparity < 1.0) | _shadowed(true) | edges
    blind |= (brightest < DARK) | (darkest > GLARE)
    measured = scale * (1000 * SUBPIXELS) / np.maximum(disparity, 1.0)
    measured[blind] = 0.0
    return np.minimum(np.round(measured), 65535).astype(np.uint16)


def _shadowed(disparity: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Pixels (h, w) that the right imager does not see, because something nearer hides them from it."""
    there = np.arange(disparity.shape[1], dtype=np.float32) - disparity
    nearest = np.minimum.accumulate(there[:, ::-1], axis=1)[:, ::-1]
    hidden = np.zeros(disparity.shape, bool)
    hidden[:, :-1] = there[:, :-1] > nearest[:, 1:]
    return hidden


def _edges(far: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Pixels (h, w) on the far side of a jump of depth [m], whose window is mostly filled by what is nearer."""
    found = np.zeros(far.shape, bool)
    for first, second, here, there in (
        (far[:-1], far[1:], found[:-1], found[1:]),
        (far[:, :-1], far[:, 1:], found[:, :-1], found[:, 1:]),
    ):
        here |= first > second * np.float32(1 + EDGE)
        there |= second > first * np.float32(1 + EDGE)
    return found


def _unmatched(surfaces: Surfaces, depth: Depth, focal: float, noise: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Pixels (h, w) of glossy and of transparent surfaces that get no depth: in patches, where `noise` is low, and
    where a glossy one mirrors the projector."""
    found = surfaces.clear & (noise < NormalDist().inv_cdf(CLEAR_LOST))
    glossy = surfaces.gloss > 0.0
    rows, columns = (np.flatnonzero(glossy.any(axis=axis)) for axis in (1, 0))
    if len(rows):
        box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        gloss = surfaces.gloss[box]
        mirrored = _facing(depth, focal, *box) > np.cos(np.radians(MIRRORED * gloss))
        found[box] |= (gloss > 0.0) & (mirrored | (noise[box] < quantiles(GLOSS_LOST * gloss)))
    return np.asarray(found)


def _facing(depth: Depth, focal: float, rows: slice, columns: slice) -> Depth:
    """Cosine (n, k) of the angle between a surface's normal and the line of sight, in a piece of `depth` (h, w) [m]."""
    z = depth[rows, columns].astype(np.float64)
    if min(z.shape) < 2:
        return np.zeros(z.shape)
    height, width = depth.shape
    u, v = np.arange(columns.start, columns.stop), np.arange(rows.start, rows.stop)
    sight = np.ones((*z.shape, 3))
    sight[..., 0], sight[..., 1] = (u + 0.5 - width / 2) / focal, ((v + 0.5 - height / 2) / focal)[:, None]
    down, right = np.gradient(sight * z[..., None], axis=(0, 1))
    normal = np.cross(right, down)
    length = np.linalg.norm(normal, axis=-1) * np.linalg.norm(sight, axis=-1)
    return np.asarray(np.abs((normal * sight).sum(axis=-1)) / np.maximum(length, 1e-12))
