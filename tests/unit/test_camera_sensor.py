"""The RGB-D sensor model against the figures of its datasheet."""

import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial.transform import Rotation
from scipy.special import ndtri

from common.geometry import turn_matrix
from common.rendering.renderer import Surfaces
from services.camera.sensor import (
    BLOCK,
    DARK,
    DIM,
    GLARE,
    LEAST_RANGE,
    MATCHING_WINDOW,
    NOISE_AT_1_M,
    StereoCamera,
    exact,
    quantiles,
    smoothed,
)

FOCAL = 433.0
SHAPE = (240, 320)


def grey(level: int = 120) -> np.ndarray:
    return np.full((*SHAPE, 3), level, np.uint8)


@pytest.mark.parametrize("distance", [1.0, 2.0, 3.0])
def test_depth_noise_grows_with_the_square_of_the_distance(distance: float) -> None:
    depth = StereoCamera(1).expose(grey(), np.full(SHAPE, distance), FOCAL, 5).depth / 1000.0
    assert (depth > 0).all()
    assert depth.mean() == pytest.approx(distance, abs=0.001 * distance**2)
    assert depth.std() == pytest.approx(NOISE_AT_1_M * distance**2, rel=0.2)


def test_depth_of_what_is_dim_is_noisier() -> None:
    noises = [
        StereoCamera(1).expose(grey(level), np.ones(SHAPE), FOCAL, 5).depth.std() for level in (120, DIM, DIM // 4)
    ]
    assert noises[1] == noises[0] and noises[2] == pytest.approx(2 * noises[0], rel=0.1)


def test_depths_are_steps_of_the_sub_pixel_disparity() -> None:
    depth = StereoCamera(1).expose(grey(), np.full(SHAPE, 3.0), FOCAL, 5).depth
    steps = np.diff(np.unique(depth))
    assert steps.min() >= 10


@pytest.mark.parametrize("first", [BLOCK - 1, BLOCK, BLOCK + 1, BLOCK + 5])
def test_the_far_side_of_an_edge_has_no_depth_in_whichever_rows_it_lies(first: int) -> None:
    scene = np.where(np.arange(SHAPE[0]) < first, 1.0, 2.0)[:, None] * np.ones(SHAPE)
    depth = StereoCamera(1).expose(grey(), scene, FOCAL, 5).depth
    lost = np.flatnonzero((depth[:, SHAPE[1] // 2 :] == 0).all(axis=1))
    assert lost.tolist() == [first]


def test_what_is_nearer_throws_a_shadow_without_depth_to_its_left() -> None:
    scene = np.full(SHAPE, 2.0)
    scene[80:160, 150:200] = 1.0
    depth = StereoCamera(1).expose(grey(), scene, FOCAL, 5).depth
    shadow = FOCAL * 0.05 * (1 / 1.0 - 1 / 2.0)
    missing = np.flatnonzero(depth[120] == 0)
    assert missing.min() >= 150 - shadow - 2 and missing.max() <= 201
    assert (missing < 150).sum() == pytest.approx(shadow, abs=2)


@pytest.mark.parametrize(
    ("level", "distance"), [(DARK - 1, 1.0), (GLARE + 1, 1.0), (120, LEAST_RANGE - 0.01), (120, 0.0)]
)
def test_nothing_is_measured_of_what_is_dark_glaring_too_near_or_not_there(level: int, distance: float) -> None:
    assert not StereoCamera(1).expose(grey(level), np.full(SHAPE, distance), FOCAL, 5).depth.any()


def test_a_moment_repeats_and_another_differs() -> None:
    camera, depth = StereoCamera(7), np.full(SHAPE, 1.5)
    one, again, later = (camera.expose(grey(), depth, FOCAL, moment) for moment in (3, 3, 4))
    assert (one.rgb == again.rgb).all() and (one.depth == again.depth).all()
    assert (one.rgb != later.rgb).any() and (one.depth != later.depth).any()


def test_cameras_differ_in_exposure_and_white_balance() -> None:
    means = [StereoCamera(seed).expose(grey(), np.ones(SHAPE), FOCAL, 0).rgb.mean(axis=(0, 1)) for seed in range(20)]
    assert 108 < np.min(means) < 116 and 124 < np.max(means) < 136


def test_an_ideal_sensor_rounds_to_millimetres() -> None:
    assert (exact(grey(), np.full(SHAPE, 1.2345)).depth == 1234).all()


def surfaces(gloss: float = 0.0, clear: bool = False) -> Surfaces:
    return Surfaces(np.full(SHAPE, gloss), np.full(SHAPE, clear))


def cylinder(radius: float = 0.2, distance: float = 1.0) -> np.ndarray:
    """Depth of an upright cylinder that fills the middle of the picture."""
    ray = (np.arange(SHAPE[1]) + 0.5 - SHAPE[1] / 2) / FOCAL
    a, b, c = 1 + ray**2, -2 * (distance + radius), (distance + radius) ** 2 - radius**2
    inner = b**2 - 4 * a * c
    depth = np.where(inner > 0, (-b - np.sqrt(np.maximum(inner, 0.0))) / (2 * a), 0.0)
    return np.tile(depth, (SHAPE[0], 1))


def missing(depth: np.ndarray, seen: Surfaces | None) -> np.ndarray:
    picture = StereoCamera(1).expose(grey(), depth, FOCAL, 5, seen)
    found: np.ndarray = (picture.depth == 0) & (depth > 0)
    return found


def test_a_tin_has_no_depth_along_the_stripe_that_mirrors_the_projector() -> None:
    tin = cylinder()
    matt, glossy, half = (missing(tin, s).mean(axis=0) for s in (None, surfaces(1.0), surfaces(0.5)))
    middle = SHAPE[1] // 2
    # The normal is 15 degrees off the line of sight where the surface is .2 m x sin(15) aside, nearly.
    stripe = 0.2 * np.sin(np.radians(15)) * FOCAL / 1.0
    rows = slice(80, 160)
    lost = (missing(tin, surfaces(1.0))[rows] & ~missing(tin, None)[rows]).mean(axis=0) > 0.9
    assert lost[middle] and lost.sum() == pytest.approx(2 * stripe * 0.83, rel=0.15)
    assert matt[middle] == 0.0
    beside = slice(middle + 40, middle + 60)
    assert 0.08 < glossy[beside].mean() - matt[beside].mean() < 0.22
    assert 0.03 < half[beside].mean() - matt[beside].mean() < 0.12


def test_half_of_what_is_transparent_finds_no_match_in_patches() -> None:
    lost = missing(np.full(SHAPE, 1.5), surfaces(clear=True))
    assert lost.mean() == pytest.approx(0.5, abs=0.06)
    assert (lost[:, 1:] != lost[:, :-1]).mean() < 0.3, "patches, not single pixels"


def test_what_is_neither_loses_nothing() -> None:
    assert not missing(np.full(SHAPE, 1.5), surfaces()).any()


def test_the_noise_and_its_quantiles_are_those_of_scipy() -> None:
    rng = np.random.default_rng(4)
    noise = rng.standard_normal((40, 50), np.float32)
    smooth = ndimage.uniform_filter(noise, MATCHING_WINDOW, mode="wrap")
    assert np.allclose(smoothed(noise), smooth, atol=1e-7)
    shares = rng.choice([0.0, 0.05, 0.15], (4, 5))
    assert np.allclose(quantiles(shares), ndtri(shares))
    turn = rng.standard_normal(3)
    assert np.allclose(turn_matrix(turn), Rotation.from_rotvec(turn).as_matrix())
    assert np.allclose(turn_matrix(np.zeros(3)), np.eye(3))
