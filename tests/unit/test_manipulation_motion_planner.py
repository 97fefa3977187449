"""Plans of the arm alone."""

from itertools import pairwise

import numpy as np

from services.manipulation.arm_model import Obstacle
from services.manipulation.grasp import approach_rotation
from services.manipulation.grasped_object import GraspedObject
from services.manipulation.motion_planner import Planner
from services.manipulation.plan_place import plan_place
from services.sim.model import own


def test_where_the_arm_is_stretched_it_leaves_the_way_it_came() -> None:
    planner = Planner(own().mjcf, 0)
    held = GraspedObject(
        "box", "box", approach_rotation(0.0, np.pi / 2), np.array([0.0, 0.0, 0.06]), (0.06, 0.06, 0.10), 0.06, 0.0
    )
    plan = plan_place(planner, held, [(0.5, 0.0)], 0.65, 0.004, [], planner.arm.home.copy())
    top = planner.arm.pose(plan.retreat[-1]).position
    assert np.allclose(top[:2], (0.5, 0.0), atol=0.01) and top[2] > 0.65 + 0.06 + 0.07
    assert np.allclose(planner.arm.pose(plan.retreat[0]).position, (0.5, 0.0, 0.65 + 0.004 + 0.06), atol=0.01)


def test_on_its_way_home_the_arm_keeps_clear_of_what_it_put_down() -> None:
    planner = Planner(own().mjcf, 0)
    size, yaw, spot = (0.06, 0.08, 0.13), 1.5875, (0.520, 0.001)
    turn, offset = approach_rotation(0.0167, np.pi / 6), np.array([0.0, 0.0, 0.078])
    held = GraspedObject("box", "box", turn, offset, size, 0.06, yaw)
    plan = plan_place(planner, held, [spot], 0.46, 0.004, [], planner.arm.home.copy())
    planner.arm.set_obstacles([Obstacle((*spot, 0.46 + size[2] / 2), size, yaw)])
    way = [plan.retreat[-1], *plan.home]
    between = (a + (b - a) * s for a, b in pairwise(way) for s in np.linspace(0, 1, 40))
    assert not any(planner.arm.collides(q) for q in between)
