"""What was felt of something that reaches lower than believed, as a turn about the pads."""

import math

import numpy as np
import pytest

from common.geometry import Array, turn_matrix
from services.manipulation.grasps.grasp import approach_rotation
from services.manipulation.grasps.grasped_object import GraspedObject
from services.manipulation.grasps.sagging import STEP, sagged

SIZE, GRASPED = (0.20, 0.03, 0.03), 0.06
"""A bar along x; how far [m] from its middle it is held, from above."""


def bar(at: float, points: Array | None = None) -> GraspedObject:
    return GraspedObject(
        "bar", "tool", approach_rotation(0.0, np.pi / 2), np.array([at, 0.0, SIZE[2] / 2]), SIZE, SIZE[1], 0.0,
        points=points,
    )  # fmt: skip


def lowest(angle: float) -> float:
    """How much lower the far end of the bar is, turned by `angle` [rad] about where it is held."""
    return (GRASPED + SIZE[0] / 2) * math.sin(angle) + SIZE[2] / 2 * (math.cos(angle) - 1)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("angle", [0.3, 0.8, 1.2])
def test_the_hand_is_turned_back_by_as_much_as_the_object_has_turned(side: float, angle: float) -> None:
    held = bar(side * GRASPED)
    found = sagged(held, lowest(angle))
    assert found is not None
    # It went down on the side away from the pads: the hand leans the other way.
    back = held.rotation @ found.rotation.T
    assert back == pytest.approx(turn_matrix(np.array([0.0, -side * angle, 0.0])), abs=STEP)
    assert found.offset == pytest.approx(held.offset), "the pads are where they were on it"


def test_it_can_be_put_down_as_it_hangs_where_the_hand_cannot_turn_it_back() -> None:
    held = bar(GRASPED)
    found = sagged(held, lowest(0.8))
    assert found is not None and found.as_found is not None
    hangs = found.as_found
    assert hangs.rotation == pytest.approx(held.rotation)
    assert hangs.offset[2] == pytest.approx(held.offset[2] + lowest(0.8), abs=0.02)
    assert hangs.size[2] > 3 * SIZE[2]


def test_what_hangs_straight_down_reaches_no_lower() -> None:
    assert sagged(bar(GRASPED), GRASPED + SIZE[0] / 2 + 0.03) is None
    assert sagged(bar(0.0), 0.05) is None, "its weight turns it neither way"


def test_the_heavy_end_by_what_was_seen_goes_down() -> None:
    head = np.random.default_rng(0).uniform([-0.10, -0.015, 0.0], [-0.06, 0.015, 0.015], (300, 3))
    handle = np.random.default_rng(1).uniform([-0.06, -0.005, 0.0], [0.10, 0.005, 0.015], (100, 3))
    found = sagged(bar(-0.01, np.concatenate([head, handle])), 0.05)
    assert found is not None
    assert found.rotation[0, 2] < 0, "the hand points to the head as it brings that up"
