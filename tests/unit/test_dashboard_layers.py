"""Costmap and grasp candidates as pictures, and how far the robot is from its set-points."""

from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from common import messages as m
from common.geometry import matrix_quat
from common.household import load_household
from services.dashboard.panels.tracking_error import arm_error, off_path
from services.dashboard.scene.layers import FOOTPRINT, STATES, Layers, forks, picture
from services.manipulation.grasps.grasp import shown
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.target import Target
from services.navigation.planning.costmap import Costmap


def test_the_costmap_is_opaque_at_obstacles_and_clear_in_the_open() -> None:
    scene = load_household("apartment")
    costmap = Costmap(scene, 0.05, 30.0)
    sent = costmap.picture(3.0)
    image = picture(sent)
    assert image.shape == (sent.height, sent.width, 4)
    wall = scene.walls[0]
    row, column = costmap.cell((wall.start[0] + wall.end[0]) / 2, (wall.start[1] + wall.end[1]) / 2)
    assert image[row, column, 3] > 100
    open_cells = costmap.static_distance > 1.2
    assert open_cells.any()
    assert image[open_cells][:, 3].max() == 0
    near = (costmap.static_distance > 0) & (costmap.static_distance < FOOTPRINT - 0.02)
    assert image[near][:, 3].min() > 100


def test_candidates_are_shown_where_they_are_in_the_map() -> None:
    can = Target("green can", "can", (0.7, 0.1, 0.5), 0.0, (0.066, 0.066, 0.12))
    options = candidates(can, 0.12, 0.076)
    names = [one.name for one in options]
    found = shown(can, options, (2.0, 1.0, pi / 2), 5.0, [names[0]], names[1], "goal-1")
    assert [one.name for one in found.candidates] == names
    assert [one.state for one in found.candidates[:3]] == ["failed", "chosen", "open"]
    x, y, _ = found.candidates[1].position
    assert (x, y) == pytest.approx((2.0 - 0.1, 1.0 + 0.7))


def test_a_fork_is_as_wide_as_the_grasp_and_points_along_the_approach() -> None:
    down = np.array([[1.0, 0, 0], [0, -1.0, 0], [0, 0, -1.0]])
    one = m.GraspCandidate(name="a", position=(1.0, 2.0, 0.5), orientation=matrix_quat(down), width=0.06)
    segments, colours = forks([one])
    assert segments.shape == colours.shape == (4, 2, 3)
    assert segments[0, 0, 2] > segments[0, 1, 2] > 0.5, "the hand comes from above"
    assert abs(segments[1, 0, 1] - segments[1, 1, 1]) == pytest.approx(0.072)
    assert tuple(colours[0, 0]) == STATES["open"]
    assert len(forks([])[0]) == 0


def test_the_objects_of_a_question_are_numbered_until_it_is_answered() -> None:
    shown: list[str] = []

    def add_label(name: str, text: str, position: m.Vec3) -> SimpleNamespace:
        shown.append(text)
        return SimpleNamespace(remove=lambda: shown.remove(text))

    server: Any = SimpleNamespace(scene=SimpleNamespace(add_label=add_label))
    layers = Layers(server)
    for places in ([(1.0, 2.0, 0.8), (1.5, 2.0, 0.8)], [(1.0, 2.0, 0.8), (1.5, 2.0, 0.8)]):
        layers.offered(places)
        assert shown == ["1?", "2?"]
    layers.offered([])
    assert shown == []


def test_distance_to_the_path_is_to_its_nearest_piece() -> None:
    path = [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0)]
    assert off_path(path, (0.5, -0.2, 0.0)) == pytest.approx(0.2)
    assert off_path(path, (1.3, 1.0, 0.0)) == pytest.approx(0.3)
    assert off_path(path, (1.0, 2.5, 0.0)) == pytest.approx(0.5)
    assert off_path([], (1.0, 1.0, 0.0)) == off_path(path[:1], (1.0, 1.0, 0.0)) == 0.0


def test_the_arm_is_as_far_off_as_its_worst_joint() -> None:
    command = m.ArmCommand(position=[0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.0])
    joints = {f"joint_{n}": 0.0 for n in range(1, 8)} | {"joint_3": 0.8}
    assert arm_error(command, joints) == pytest.approx(0.5)
    assert arm_error(None, joints) == 0.0
    assert arm_error(command, {}) == 0.0
