"""Grasps of a mug that lies: on the wall, from its open end, one finger inside and one outside."""

import math

import numpy as np
import pytest

from services.manipulation.grasps.mouth import in_the_mouth
from services.manipulation.grasps.target import Target


def mug(yaw: float, kind: str = "mug", tilt: float = math.pi / 2) -> Target:
    return Target("mug", kind, (0.6, 0.1, 0.544), yaw, (0.118, 0.088, 0.088), tilt, "round")


@pytest.mark.parametrize("yaw", [0.0, 2.1, -1.3])
def test_the_fingers_close_on_the_wall_from_the_open_end(yaw: float) -> None:
    target = mug(yaw)
    axis = np.array([math.cos(yaw), math.sin(yaw), 0.0])
    grasps = in_the_mouth(target)
    assert grasps
    for grasp in grasps:
        from_middle = grasp.pose.position - np.array(target.position)
        outward = from_middle - (from_middle @ axis) * axis
        assert 0.03 < from_middle @ axis < 0.059 and 0.038 < np.linalg.norm(outward) < 0.044
        # The palm is outside: the hand comes along the axis, towards the foot; the fingers close across the wall.
        assert grasp.pose.rotation[:, 2] @ axis < -0.8
        assert abs(grasp.pose.rotation[:, 1] @ outward) / np.linalg.norm(outward) > 0.8
        assert grasp.rim and grasp.axis == pytest.approx(math.remainder(yaw, math.tau))


def test_what_stands_or_has_no_mouth_is_not_taken_by_it() -> None:
    assert in_the_mouth(mug(0.3, tilt=0.0)) == [] == in_the_mouth(mug(0.3, "can"))
