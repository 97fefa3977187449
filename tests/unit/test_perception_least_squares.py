"""The solver against SciPy's, and the slopes of the shapes against differences."""

import math

import numpy as np
import pytest
from scipy.optimize import least_squares

from common.floor_plan import Vec3
from common.geometry import Array
from common.kinds import KINDS
from services.perception.shapes import known as shapes
from services.perception.shapes.least_squares import solve
from services.perception.shapes.primitives import Silhouette, fit

SIZES: dict[str, Vec3] = {
    "mug": (0.074, 0.074, 0.095), "bowl": (0.14, 0.14, 0.06), "bottle": (0.066, 0.066, 0.22),
    "can": (0.066, 0.066, 0.115), "ball": (0.066, 0.066, 0.066), "apple": (0.072, 0.072, 0.072),
    "block": (0.05, 0.05, 0.05), "box": (0.06, 0.08, 0.13),
}  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
def test_a_circle_among_strays_is_where_scipy_finds_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 2.5, 120)
    ring = np.stack([0.4 + 0.05 * np.cos(angle), -0.2 + 0.05 * np.sin(angle)], axis=1) + rng.normal(0, 0.001, (120, 2))
    ring[:15] += rng.uniform(-0.03, 0.03, (15, 2))

    def circle(p: Array) -> tuple[Array, Array]:
        apart = ring - p[:2]
        far = np.linalg.norm(apart, axis=1)
        return far - p[2], np.column_stack([-apart / far[:, None], -np.ones(len(far))])

    start = np.array([*ring.mean(axis=0), 0.03])
    found, cost = solve(circle, start, 0.004, 40)
    theirs = least_squares(lambda p: circle(p)[0], start, loss="soft_l1", f_scale=0.004)
    assert np.abs(found - theirs.x).max() < 2e-5
    assert cost == pytest.approx(theirs.cost, rel=1e-4)
    assert np.hypot(found[0] - 0.4, found[1] + 0.2) < 0.002


def test_what_no_residual_depends_on_stays_where_it_was() -> None:
    def flat(p: Array) -> tuple[Array, Array]:
        return np.array([p[0] - 2.0, p[0] - 2.0]), np.array([[1.0, 0.0], [1.0, 0.0]])

    found, _ = solve(flat, np.array([1.0, 5.0]), 1.0, 40)
    assert found == pytest.approx([2.0, 5.0], abs=1e-5)


@pytest.mark.parametrize("kind", SIZES)
def test_slopes_of_a_shape_are_the_differences_of_its_distances(kind: str) -> None:
    rng = np.random.default_rng(2)
    size, p = SIZES[kind], np.array([0.3, -0.2, 0.4])[: 3 if KINDS[kind].shape == "box" else 2]
    cloud = rng.uniform(-0.09, 0.09, (400, 3)) + np.array([0.3, -0.2, 0.7 + size[2] / 2])
    apart, slopes = shapes.residuals(KINDS[kind], size, cloud, 0.7, p)
    near = apart > 1e-4  # on the surface itself distances have a kink
    for k in range(len(p)):
        step = np.eye(len(p))[k] * 1e-7
        ahead, behind = (shapes.residuals(KINDS[kind], size, cloud, 0.7, q)[0] for q in (p + step, p - step))
        wrong = np.abs((ahead - behind) / 2e-7 - slopes[:, k])[near] > 1e-4
        assert np.count_nonzero(wrong) <= 2, "edges, where two faces are equally near"


def test_ends_of_a_box_turn_with_it() -> None:
    size, camera, p = (0.06, 0.08, 0.13), np.array([-0.8, 0.1, 1.3]), np.array([0.3, -0.2, 0.4])
    bearings, slopes = shapes.end_bearings(size, p, camera, -0.2)
    assert bearings[0] < bearings[1]
    wide = math.hypot(*size[:2]) / math.hypot(1.1, 0.3)
    assert 0.06 / 1.2 < bearings[1] - bearings[0] < wide
    for k in range(3):
        ahead = shapes.end_bearings(size, p + np.eye(3)[k] * 1e-6, camera, -0.2)[0]
        assert (ahead - bearings) / 1e-6 == pytest.approx(slopes[:, k], abs=1e-3)


@pytest.mark.parametrize(("drawn_to", "found"), [(0.26, 0.26), (0.60, 0.22)])
def test_a_shape_does_not_grow_far_beyond_what_is_seen(drawn_to: float, found: float) -> None:
    points, nowhere = np.zeros((100, 3)), Silhouette(np.zeros(2), 0.0, np.full(2, math.nan), 1.0)
    solution = fit(
        lambda p, points: np.repeat(p - drawn_to, len(points), axis=1), lambda outline, p: np.empty((len(p), 0)),
        np.array([0.22]), points, nowhere, 0.0015, (np.array([0.22]), np.array([0.02])),
    )  # fmt: skip
    assert solution.p[0] == pytest.approx(found, abs=0.01)
