"""What lay, or stood on its head, as it will stand: the hand keeps its place on the object."""

import math
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array
from services.manipulation.grasps.grasped_object import GraspedObject, attach
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.target import Target

FORWARD, WIDEST = 0.12, 0.076
MUG = Target("my mug", "mug", (0.6, 0.1, 0.75), 0.4, (0.07, 0.07, 0.1), tilt=math.pi)


def above_the_foot(held: GraspedObject) -> Array:
    """Where the pinch point is on the upright object: height over its foot, and distance from its axis [m]."""
    return np.array([held.offset[2], math.hypot(held.offset[0], held.offset[1])])


def test_what_stands_on_its_head_is_turned_over() -> None:
    first = candidates(MUG, FORWARD, WIDEST)[0]
    assert first.turns_over
    held = attach(MUG, first)
    # The pinch point is as far below the upper end, which is the foot, as it will be above the foot.
    below = MUG.bottom + MUG.size[2] - first.pose.position[2]
    assert above_the_foot(held) == pytest.approx([below, 0.0], abs=1e-9)
    # The hand comes from the same side, from below the level instead of above it, its fingers exchanged.
    was, now = first.pose.rotation, held.rotation
    assert now[:, 2] == pytest.approx([was[0, 2], was[1, 2], -was[2, 2]])
    assert abs(now[:, 1] @ was[:, 1]) == pytest.approx(1.0)
    assert np.linalg.det(now) == pytest.approx(1.0)


def test_what_stands_upright_is_not() -> None:
    assert not any(g.turns_over for g in candidates(replace(MUG, tilt=0.0), FORWARD, WIDEST))
    block = replace(MUG, kind="block", size=(0.05, 0.05, 0.05))
    assert not any(g.turns_over for g in candidates(block, FORWARD, WIDEST))


def test_a_handle_points_to_the_other_side_of_the_approach_when_its_mug_is_turned_over() -> None:
    first = candidates(MUG, FORWARD, WIDEST)[0]
    azimuth = math.atan2(first.pose.rotation[1, 2], first.pose.rotation[0, 2])
    held = attach(MUG, first)
    assert math.remainder(held.yaw - azimuth, math.tau) == pytest.approx(-math.remainder(MUG.yaw - azimuth, math.tau))


def test_what_lay_is_held_as_far_from_its_foot_as_it_was_taken() -> None:
    laid = Target("my can", "can", (0.6, 0.0, 0.73), 0.3, (0.12, 0.06, 0.06), tilt=math.pi / 2)
    grasp = candidates(laid, FORWARD, WIDEST)[0]
    assert grasp.axis is not None
    held = attach(laid, grasp)
    assert held.size == (0.06, 0.06, 0.12)
    assert above_the_foot(held) == pytest.approx([0.06, 0.0], abs=1e-9)
    assert held.as_found is not None
    assert held.as_found.size == laid.size
