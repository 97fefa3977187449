"""What the wrist camera sees from before an object, held against what the grasp was planned for."""

from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array
from services.manipulation.execution.sighting import moved
from services.manipulation.grasps.target import Target

POINTS = np.random.default_rng(0).uniform([-0.08, -0.025, -0.03], [0.08, 0.025, 0.03], (600, 3))
DUMBBELL = Target("dumbbell", "tool", (0.52, 0.0, 0.63), 0.0, (0.16, 0.05, 0.06), shape="long", points=POINTS)


def seen(points: Array, shift: tuple[float, float]) -> Target:
    """As a sighting of these points tells it, the whole moved by `shift` [m]."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    x, y, z = middle + DUMBBELL.position + (*shift, 0.0)
    return replace(DUMBBELL, position=(x, y, z), points=points - middle)


@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.012, -0.007)])
def test_what_is_seen_whole_is_where_it_is_seen(shift: tuple[float, float]) -> None:
    assert moved(DUMBBELL, seen(POINTS, shift)) == pytest.approx(shift, abs=1e-3)
    can, front = replace(DUMBBELL, shape="cylinder"), POINTS[POINTS[:, 0] < 0.0]
    again = replace(can, points=front, position=(0.52 + shift[0], shift[1], 0.63))
    assert moved(can, again) == pytest.approx(shift), "of a shape that was fitted the middle is known"


def test_of_what_is_seen_in_part_the_side_that_shows_tells_nothing_of_the_other() -> None:
    piece = POINTS[(POINTS[:, 0] > -0.01) & (POINTS[:, 1] > -0.01)]
    assert moved(DUMBBELL, seen(piece, (0.0, 0.0))) == pytest.approx((0.0, 0.0), abs=1.5e-3)
    x, y = moved(DUMBBELL, seen(piece, (0.008, 0.0)))
    assert (x, y) == pytest.approx((0.008, 0.0), abs=1.5e-3)
