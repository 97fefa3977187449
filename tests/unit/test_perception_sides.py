"""Sides of objects as seen straight on, from made pictures whose geometry is known."""

import math

import numpy as np
import pytest

from common.geometry import quat_matrix, yaw_quat
from common.messages import WorldObject
from services.perception.naming.sides import AROUND, FINER, Lens, flattened

LENS = Lens(
    np.zeros(3), np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]), (600.0, 600.0), (200.0, 150.0)
)
"""At the origin, it looks along x."""
AT = (1.0, 0.0, 0.0)


def painted(o: WorldObject, inside: "np.ndarray") -> "np.ndarray":
    """A picture that is white where the points (n, 3) of the object are seen, black elsewhere."""
    picture = np.zeros((300, 400, 3), np.uint8)
    points = inside @ quat_matrix(o.orientation).T + np.array(o.position)
    rows, columns = LENS.pixels(points)
    picture[rows.astype(int), columns.astype(int)] = 255
    return picture


def thing(kind: str, size: tuple[float, float, float], yaw: float = 0.0) -> WorldObject:
    return WorldObject(label="it", kind=kind, colour="", position=AT, size=size, orientation=yaw_quat(yaw), id="it")


@pytest.mark.parametrize("yaw", [0.0, 0.5, -0.9])
def test_a_mark_on_a_face_that_is_turned_away_stands_where_it_is_on_the_face(yaw: float) -> None:
    box = thing("box", (0.1, 0.2, 0.3), yaw)
    # A patch on the face towards -x, in the upper half, on its right as one faces it: y below 0.
    y, z = np.meshgrid(np.linspace(-0.08, -0.04, 80), np.linspace(0.06, 0.1, 80))
    patch = np.stack([np.full(y.size, -0.05), y.ravel(), z.ravel()], 1)
    shown = [
        side for side in flattened(painted(box, patch), LENS, box)
        if abs(side.shape[1] / side.shape[0] - 0.2 / 0.3) < 0.02 and side.max() > 0
    ]  # fmt: skip
    (side,) = shown
    rows, columns = np.nonzero(side[..., 0] > 100)
    assert rows.mean() / side.shape[0] == pytest.approx((0.15 - 0.08) / 0.3, abs=0.03)
    assert columns.mean() / side.shape[1] == pytest.approx((0.1 + 0.06) / 0.2, abs=0.04)


def test_what_goes_around_a_can_is_unrolled() -> None:
    can = thing("can", (0.2, 0.2, 0.3))
    angle, z = np.meshgrid(np.linspace(0.6, 0.8, 80), np.linspace(-0.02, 0.02, 80))
    # Right of its middle as the camera sees it.
    points = np.stack([-0.1 * np.cos(angle).ravel(), -0.1 * np.sin(angle).ravel(), z.ravel()], 1)
    (side,) = flattened(painted(can, points), LENS, can)
    assert side.shape[0] == pytest.approx(FINER * 600 * 0.3, rel=0.02)
    _, columns = np.nonzero(side[..., 0] > 100)
    assert columns.mean() / side.shape[1] == pytest.approx((AROUND + 0.7) / (2 * AROUND), abs=0.03)


def test_sides_that_face_away_are_not_shown() -> None:
    assert len(flattened(np.zeros((300, 400, 3), np.uint8), LENS, thing("box", (0.1, 0.2, 0.3)))) == 1
    assert len(flattened(np.zeros((300, 400, 3), np.uint8), LENS, thing("box", (0.1, 0.2, 0.3), math.pi / 4))) == 2
