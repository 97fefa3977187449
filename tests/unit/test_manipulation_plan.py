"""Plans of the arm alone."""

import numpy as np

from services.manipulation.grasp import approach_rotation
from services.manipulation.plan import Held, Planner
from services.sim.robot import robot_mjcf


def test_where_the_arm_is_stretched_it_leaves_the_way_it_came() -> None:
    planner = Planner(robot_mjcf(), 0)
    held = Held(
        "box", "box", approach_rotation(0.0, np.pi / 2), np.array([0.0, 0.0, 0.06]), (0.06, 0.06, 0.10), 0.06, 0.0
    )
    plan = planner.place(held, [(0.6, 0.0)], 0.72, 0.004, [], planner.arm.home.copy())
    top = planner.pose(plan.retreat[-1]).position
    assert np.allclose(top[:2], (0.6, 0.0), atol=0.01) and top[2] > 0.72 + 0.06 + 0.07
    assert np.allclose(planner.pose(plan.retreat[0]).position, (0.6, 0.0, 0.72 + 0.004 + 0.06), atol=0.01)
