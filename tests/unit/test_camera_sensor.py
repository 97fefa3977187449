"""The RGB-D sensor model against the figures of its datasheet."""

import numpy as np
import pytest

from services.camera.sensor import DARK, GLARE, LEAST_RANGE, NOISE_AT_1_M, StereoCamera, exact

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


def test_depths_are_steps_of_the_sub_pixel_disparity() -> None:
    depth = StereoCamera(1).expose(grey(), np.full(SHAPE, 3.0), FOCAL, 5).depth
    steps = np.diff(np.unique(depth))
    assert steps.min() >= 10


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
