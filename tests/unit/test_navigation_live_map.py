"""Navigation by a map that somebody else is making."""

import math
import zlib

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.geometry import Pose2, Rectangle
from common.household import load_household
from services.navigation.planning.costmap import Costmap
from tests.unit.mapping_flat import BOXES
from tests.unit.navigation_flat import SCENE, Flat

LOW = (-2.9, -3.4)


def grid(odom: Pose2 = (0.0, 0.0, 0.0), width: float = 5.3, resolution: float = 0.05) -> m.MapGrid:
    """The west of the shipped flat, free where its plan has nothing; beyond it nothing is known."""
    columns, rows = round(width / resolution), round(7.8 / resolution)
    xs, ys = (o + (np.arange(n) + 0.5) * resolution for o, n in zip(LOW, (columns, rows), strict=True))
    gx, gy = np.meshgrid(xs, ys)
    taken = np.zeros((rows, columns), np.uint8)
    for box in [w.footprint for w in SCENE.walls] + SCENE.footprints:
        taken[box.signed_distances(gx, gy) < 0.0] = 1
    cells = zlib.compress(taken.tobytes())
    return m.MapGrid(
        t=0.0, x=LOW[0], y=LOW[1], resolution=resolution, width=columns, height=rows, cells=cells, odom=odom
    )


def flat(odom: Pose2 = (0.0, 0.0, 0.0)) -> Flat:
    robot = Flat(boxes=BOXES, household=load_household("unmapped"), map="mapping")
    robot.bus.send(topics.MAP_GRID, grid(odom))
    robot.step()
    return robot


def drive(robot: Flat, x: float, y: float) -> m.NavigationFeedback:
    robot.bus.send(topics.NAV_GOAL, m.NavGoal(x=x, y=y, theta=0.0, id=f"{x} {y}"))
    for _ in range(20 * 60):
        robot.step()
        feedback = robot.last(topics.NAVIGATION_FEEDBACK)
        if feedback.goal_id == f"{x} {y}" and feedback.status in ("arrived", "failed"):
            return feedback
    raise AssertionError("the goal never ended")


def test_before_the_first_map_it_does_not_know_where_it_is() -> None:
    robot = Flat(boxes=BOXES, household=load_household("unmapped"), map="mapping")
    robot.step(20)
    assert topics.POSE.key not in robot.bus.last


def test_it_drives_by_the_grid_through_a_door() -> None:
    robot = flat()
    assert drive(robot, -0.45, 3.0).status == "arrived"
    assert math.dist(robot.true[:2], (-0.45, 3.0)) < 0.06
    assert robot.closest > 0.28


def test_what_is_unknown_is_no_way() -> None:
    feedback = drive(flat(), 4.0, -0.8)
    assert (feedback.status, feedback.code) == ("failed", "NO_PATH")


def test_its_pose_is_that_of_the_wheels_in_the_frame_of_the_map() -> None:
    robot = flat(odom=(0.3, -0.2, 0.1))
    robot.step()
    pose = robot.last(topics.POSE)
    assert (pose.x, pose.y, pose.theta) == pytest.approx((0.3, -0.2, 0.1), abs=1e-3)


def test_the_next_grid_takes_the_place_of_the_one_before() -> None:
    robot = flat()
    robot.bus.send(topics.MAP_GRID, grid(width=9.8))
    robot.step(2)
    assert drive(robot, 3.6, -1.0).status == "arrived"


@pytest.mark.parametrize("turn", [0.0, 0.3, 0.7])
@pytest.mark.parametrize("shift", [0.0, 0.02, 0.04])
def test_a_narrow_door_is_passed_however_the_cells_lie_in_it(turn: float, shift: float) -> None:
    """Of 0.75 m, with a cell of what the lidar's noise and the camera's edges add; what is narrower than the robot is
    no door."""
    size = 80
    gy, gx = np.mgrid[:size, :size] * 0.05 - 1.975
    frame = Rectangle(0.0, 0.0, 0.0, 0.0, turn)
    for width, passes in ((0.75, True), (0.50, False)):
        middles = [frame.to_map(0.0, side * (width / 2 + 2.0) + shift) for side in (-1, 1)]
        jambs = [Rectangle(*middle, 0.12, 4.0, turn) for middle in middles]
        taken = np.min([jamb.signed_distances(gx, gy) for jamb in jambs], axis=0) < 0.05
        cells = zlib.compress(taken.astype(np.uint8).tobytes())
        robot = Flat(boxes=jambs, household=load_household("unmapped"), map="mapping")
        made = m.MapGrid(t=0.0, x=-2.0, y=-2.0, resolution=0.05, width=size, height=size, cells=cells, odom=(0, 0, 0))
        robot.bus.send(topics.MAP_GRID, made)
        robot.true = robot.wheels = (*frame.to_map(-1.0, 0.0), 0.0)
        robot.step(4)
        told = drive(robot, *frame.to_map(1.0, 0.0))
        assert (told.status == "arrived") is passes, told


def test_a_grid_that_cannot_be_used_is_dropped() -> None:
    costmap = Costmap(load_household("unmapped"), 0.05, 30.0)
    with pytest.raises(ValueError, match=r"0\.1 m"):
        costmap.replace(grid(resolution=0.1))
    wrong = grid()
    wrong.width += 1
    with pytest.raises(ValueError, match="cells"):
        costmap.replace(wrong)
    robot = flat()
    robot.bus.send(topics.MAP_GRID, wrong)
    robot.step(2)
    assert drive(robot, 0.0, -1.0).status == "arrived", "the one before still counts"


def test_a_grid_that_is_none_is_counted_and_harms_nothing() -> None:
    robot = flat()
    broken = grid()
    broken.cells = b"nonsense"
    robot.bus.send(topics.MAP_GRID, broken)
    robot.step()
    assert robot.io.drops[topics.MAP_GRID.key] == 1
