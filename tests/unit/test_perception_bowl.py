"""A bowl seen from steeply above shows its inside, which is no wall of its own."""

import math

import numpy as np
import pytest

from common.geometry import Array
from tests.unit.test_perception_measure import CAMERA, FLOOR, NOISE, facing, look

WALL = 0.005


def bowl(x: float, y: float, foot: float, rim: float, h: float) -> Array:
    """What is seen of a bowl with a wall and a bottom of WALL: outside, rim, and the inside through the rim."""
    rng = np.random.default_rng(6)
    turn, share = rng.uniform(0, 2 * math.pi, 6000), rng.uniform(0, 1, 6000)
    out = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
    lean = np.array([0.0, 0.0, -(rim - foot) / h])
    middle = np.array([x, y, FLOOR])
    radius = foot + share * (rim - foot)
    outer = middle + radius[:, None] * out + np.outer(share * h, (0, 0, 1.0))
    inner = outer - WALL * out
    inner = inner[inner[:, 2] > FLOOR + WALL]
    bottom = middle + (foot * np.sqrt(share))[:, None] * out + (0, 0, WALL)
    rim_top = middle + (rim - WALL * share)[:, None] * out + (0, 0, h)
    up = np.tile([0.0, 0, 1], (6000, 1))
    hidden = []
    for points, normals in ((inner, -(out + lean)[(outer - WALL * out)[:, 2] > FLOOR + WALL]), (bottom, up)):
        drop = (FLOOR + h - CAMERA[2]) / (points[:, 2] - CAMERA[2])
        through = CAMERA + drop[:, None] * (points - CAMERA)
        seen = np.hypot(through[:, 0] - x, through[:, 1] - y) < rim - WALL
        hidden.append(facing(points[seen], normals[seen]))
    return np.concatenate([facing(outer, out + lean), facing(rim_top[:1500], up[:1500]), *hidden])


@pytest.mark.parametrize("x", [-0.35, 0.0, 0.5])
def test_a_plate_is_a_very_low_bowl(x: float) -> None:
    found = look(bowl(x, 0.0, 0.045, 0.075, 0.02))
    assert found.family == "bowl" and found.hollow
    assert found.size == pytest.approx((0.15, 0.15, 0.02), abs=0.012)


@pytest.mark.parametrize("x", [-0.35, 0.0, 0.5])
@pytest.mark.parametrize(("foot", "rim", "h"), [(0.035, 0.077, 0.053), (0.03, 0.08, 0.066)])
def test_a_bowl_is_one_from_above_and_from_the_side(x: float, foot: float, rim: float, h: float) -> None:
    found = look(bowl(x, 0.0, foot, rim, h))
    assert found.family == "bowl" and found.hollow
    assert found.size == pytest.approx((2 * rim, 2 * rim, h), abs=0.012)
    assert math.hypot(found.x - x, found.y) < 0.01
    assert found.residual < 0.9 * NOISE, "the inside is explained as well as the outside"
