"""Shapes measured from the points of one view: sizes that are in no scene, noise of a bought camera, no CAD."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from common.geometry import Array
from common.kinds import LOOKS
from common.naming.looks import likely
from services.perception.shapes import primitives, turned
from services.perception.shapes.measure import Measurement, measure
from services.perception.unlisted import MOST_POINTS, measures_of, thinned

CAMERA = np.array([-1.0, -0.4, 1.3])
FLOOR, NOISE = 0.72, 0.0025


def facing(points: Array, normals: Array) -> Array:
    """What of a surface the camera sees, along the line of sight by as much off as its noise."""
    rays = points - CAMERA
    seen = points[(rays * normals).sum(axis=1) < 0]
    away = seen - CAMERA
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    return np.asarray(seen + away * np.random.default_rng(len(seen)).normal(0.0, NOISE, (len(seen), 1)))


def cylinder(x: float, y: float, r: float, h: float) -> Array:
    rng = np.random.default_rng(1)
    turn, up, out = rng.uniform(0, 2 * math.pi, 1500), rng.uniform(0, h, 1500), r * np.sqrt(rng.uniform(0, 1, 500))
    wall = np.stack([x + r * np.cos(turn), y + r * np.sin(turn), FLOOR + up], 1)
    round_about = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
    lid = np.stack([x + out * np.cos(turn[:500]), y + out * np.sin(turn[:500]), np.full(500, FLOOR + h)], 1)
    return np.concatenate([facing(wall, round_about), facing(lid, np.tile([0.0, 0, 1], (500, 1)))])


def oval(x: float, y: float, yaw: float, size: tuple[float, float, float]) -> Array:
    rng = np.random.default_rng(6)
    turn, up, out = rng.uniform(0, 2 * math.pi, 2500), rng.uniform(0, size[2], 2500), np.sqrt(rng.uniform(0, 1, 500))
    c, s, (a, b) = math.cos(yaw), math.sin(yaw), (size[0] / 2, size[1] / 2)
    to_map = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]).T
    wall = np.stack([a * np.cos(turn), b * np.sin(turn), up], 1) @ to_map + [x, y, FLOOR]
    normals = np.stack([b * np.cos(turn), a * np.sin(turn), 0 * turn], 1) @ to_map
    lid = np.stack([a * out * np.cos(turn[:500]), b * out * np.sin(turn[:500]), np.full(500, size[2])], 1)
    return np.concatenate([facing(wall, normals), facing(lid @ to_map + [x, y, FLOOR], np.tile([0.0, 0, 1], (500, 1)))])


def lying(x: float, y: float, yaw: float, r: float, length: float) -> Array:
    rng = np.random.default_rng(2)
    turn, along = rng.uniform(0, 2 * math.pi, 2000), rng.uniform(-length / 2, length / 2, 2000)
    ahead, side, up = (
        np.array([math.cos(yaw), math.sin(yaw), 0]),
        np.array([-math.sin(yaw), math.cos(yaw), 0]),
        [0, 0, 1],
    )
    normals = np.outer(np.cos(turn), side) + np.outer(np.sin(turn), up)
    points = np.outer(along, ahead) + r * normals + [x, y, FLOOR + r]
    return facing(points, normals)


def ends(x: float, y: float, yaw: float, r: float, length: float, open_at: int) -> Array:
    """Lids of what `lying` has: a closed one, and at the end `open_at` (1, -1) an opening with the wall behind it."""
    rng, ahead = np.random.default_rng(5), np.array([math.cos(yaw), math.sin(yaw), 0.0])
    side, up, middle = np.array([-math.sin(yaw), math.cos(yaw), 0.0]), np.array([0, 0, 1.0]), [x, y, FLOOR + r]
    turn, out = rng.uniform(0, 2 * math.pi, 900), r * np.sqrt(rng.uniform(0, 1, 900))
    round_about = np.outer(np.cos(turn), side) + np.outer(np.sin(turn), up)
    lid = out[:, None] * round_about - open_at * length / 2 * ahead + middle
    found = [facing(lid, np.tile(-open_at * ahead, (900, 1)))]
    inside = np.outer(rng.uniform(-length / 2, length / 2, 900), ahead) + 0.95 * r * round_about
    eye = CAMERA - middle
    share = (open_at * length / 2 - eye @ ahead) / (inside @ ahead - eye @ ahead)
    crossing = eye + share[:, None] * (inside - eye)
    crossing -= np.outer(crossing @ ahead, ahead)
    through = (np.linalg.norm(crossing, axis=1) < 0.95 * r) & (share > 0) & (share < 1)
    return np.concatenate([*found, facing(inside[through] + middle, -round_about[through])])


def box(x: float, y: float, yaw: float, size: tuple[float, float, float]) -> Array:
    rng = np.random.default_rng(3)
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
    found = []
    for axis in range(3):
        for sign in (-1, 1):
            local = rng.uniform(-0.5, 0.5, (700, 3)) * size
            local[:, axis] = sign * size[axis] / 2
            points = local @ turn.T + [x, y, FLOOR + size[2] / 2]
            found.append(facing(points, np.tile(sign * turn[:, axis], (700, 1))))
    return np.concatenate(found)


def ball(x: float, y: float, r: float) -> Array:
    normals = np.random.default_rng(4).normal(size=(2500, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return facing(normals * r + [x, y, FLOOR + r], normals)


def look(points: Array) -> Measurement:
    return measure(points, FLOOR, CAMERA, (True, True), 0.0, NOISE)


def near(m: Measurement, x: float, y: float, size: tuple[float, float, float]) -> None:
    assert math.dist((m.x, m.y), (x, y)) < 0.006
    assert sorted(m.size) == pytest.approx(sorted(size), abs=0.009)


@pytest.mark.parametrize(("r", "h"), [(0.033, 0.12), (0.045, 0.10), (0.06, 0.17), (0.025, 0.08)])
def test_a_can_of_any_size_is_round_and_as_wide_as_it_is(r: float, h: float) -> None:
    m = look(cylinder(0.2, 0.1, r, h))
    assert m.family == "round"
    assert not m.hollow
    near(m, 0.2, 0.1, (2 * r, 2 * r, h))


@pytest.mark.parametrize("yaw", [0.0, 0.4, 1.1, 2.6])
@pytest.mark.parametrize("size", [(0.07, 0.07, 0.2), (0.05, 0.05, 0.05), (0.19, 0.06, 0.24), (0.2, 0.13, 0.03)])
def test_a_box_of_any_size_keeps_its_sides(yaw: float, size: tuple[float, float, float]) -> None:
    m = look(box(0.15, -0.1, yaw, size))
    assert m.family == "box"
    near(m, 0.15, -0.1, size)
    if size[0] > 1.5 * size[1]:
        assert abs(math.remainder(m.yaw - yaw, math.pi)) < 0.1


@pytest.mark.parametrize("yaw", [0.3, 1.2, 2.4])
@pytest.mark.parametrize("size", [(0.08, 0.045, 0.2), (0.1, 0.06, 0.24)])
def test_an_oval_bottle_is_as_deep_as_it_is_and_looks_like_something_round(
    yaw: float, size: tuple[float, float, float]
) -> None:
    m = look(oval(0.1, 0.0, yaw, size))
    assert m.family == "box" and "round" in [shape.family for _, shape in m.rivals]
    near(m, 0.1, 0.0, size)
    assert abs(math.remainder(m.yaw - yaw, math.pi)) < 0.2


@pytest.mark.parametrize("r", [0.03, 0.037, 0.05])
def test_a_ball_is_one(r: float) -> None:
    m = look(ball(0.3, 0.0, r))
    assert m.family == "ball"
    near(m, 0.3, 0.0, (2 * r, 2 * r, 2 * r))


@pytest.mark.parametrize("yaw", [0.2, 1.2, 2.3])
def test_what_is_long_and_round_lies(yaw: float) -> None:
    m = look(lying(0.2, 0.0, yaw, 0.032, 0.22))
    assert m.family == "long"
    assert m.tilt == pytest.approx(math.pi / 2)
    assert m.size == pytest.approx((0.22, 0.064, 0.064), abs=0.012)
    assert abs(math.remainder(m.yaw - yaw, math.pi)) < 0.1
    assert "bottle" in likely(LOOKS, measures_of(m, m.spread), ["green"])


@pytest.mark.parametrize("yaw", [0.35, 0.9, -0.5])
@pytest.mark.parametrize("top", [1, -1])
def test_the_open_end_of_a_mug_that_lies_is_its_top(yaw: float, top: int) -> None:
    points = np.concatenate([lying(0.2, 0.0, yaw, 0.038, 0.095), ends(0.2, 0.0, yaw, 0.038, 0.095, top)])
    m = look(points)
    assert m.tilt == pytest.approx(math.pi / 2)
    assert m.top_seen
    # Of the two ends the far one shows nothing: it is told by the near one.
    assert m.hollow == (top < 0)
    assert abs(math.remainder(m.yaw - yaw - (math.pi if top < 0 else 0.0), 2 * math.pi)) < 0.15


def test_a_neck_is_the_top_and_no_opening() -> None:
    body, neck = lying(0.2, 0.0, 1.2, 0.035, 0.15), lying(0.0, 0.0, 1.2, 0.014, 0.06)
    shift = 0.105 * np.array([math.cos(1.2), math.sin(1.2), 0.0]) + [0.2, 0.0, 0.021]
    m = look(np.concatenate([body, neck[::3] + shift]))
    assert not m.hollow
    assert m.top_seen
    assert abs(math.remainder(m.yaw - 1.2, 2 * math.pi)) < 0.1


def test_what_no_primitive_explains_is_irregular_and_still_has_extents() -> None:
    arms = np.concatenate([box(0.2, 0.0, 0.0, (0.2, 0.02, 0.02)), box(0.2, 0.0, math.pi / 2, (0.2, 0.02, 0.09))])
    m = look(arms)
    assert m.family == "irregular"
    # The smallest rectangle around a cross stands at 45 degrees to its arms.
    assert m.size[:2] == pytest.approx((0.156, 0.156), abs=0.03)


def test_a_hidden_end_does_not_make_a_can_narrow() -> None:
    points = cylinder(0.2, 0.0, 0.04, 0.11)
    bearing = np.arctan2(points[:, 1] - CAMERA[1], points[:, 0] - CAMERA[0])
    half = points[bearing > np.median(bearing)]
    m = measure(half, FLOOR, CAMERA, (False, True), 0.0, NOISE)
    assert math.dist((m.x, m.y), (0.2, 0.0)) < 0.03


def test_what_is_long_is_told_of_without_gaps_that_a_finger_goes_through() -> None:
    side = np.random.default_rng(0).uniform((0.0, 0.0, 0.0), (0.25, 0.06, 0.001), (5000, 3))
    apart, _ = cKDTree(thinned(side)).query(side)
    assert np.quantile(apart, 0.99) < 0.006


def test_points_are_few_and_on_the_surface() -> None:
    points = thinned(cylinder(0.2, 0.1, 0.04, 0.12))
    assert 50 < len(points) <= MOST_POINTS
    rho = np.hypot(points[:, 0] - 0.2, points[:, 1] - 0.1)
    assert np.median(np.abs(rho[points[:, 2] < FLOOR + 0.11] - 0.04)) < 0.003


def test_nothing_that_is_turned_is_wider_than_its_outline() -> None:
    rng, eye = np.random.default_rng(3), np.array([0.0, -1.2, 0.5])
    drill = np.concatenate([
        rng.uniform((-0.1, -0.02, 0.15), (0.1, -0.019, 0.19), (280, 3)),
        rng.uniform((-0.1, -0.02, 0.188), (0.1, 0.02, 0.19), (140, 3)),
        rng.uniform((0.0, -0.018, 0.05), (0.035, -0.017, 0.15), (120, 3)),
    ])  # fmt: skip
    outline = primitives.silhouette(drill, eye, (True, True), 0.0008)
    found = turned.standing(drill, 0.19, outline, eye, NOISE, np.zeros(len(drill), bool))
    assert found.size[0] < 0.25 or found.residual > 0.03


def test_what_shows_too_little_of_itself_is_not_taken_for_a_wide_wall() -> None:
    rng, eye = np.random.default_rng(3), np.array([0.0, -1.2, 0.5])
    wall = rng.uniform((-0.05, -0.002, 0.0), (0.05, 0.002, 0.055), (200, 3))
    wall[:, 1] += wall[:, 0] ** 2
    outline = primitives.silhouette(wall, eye, (False, False), 0.0008)
    found = turned.standing(wall, 0.055, outline, eye, NOISE, np.zeros(len(wall), bool))
    assert found.size[0] < 0.25 or found.residual > 0.03
