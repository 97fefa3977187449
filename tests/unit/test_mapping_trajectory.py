"""Scan matching, loop closure and walls on scans of the shipped flat."""

import math

import numpy as np
import pytest

pytest.importorskip("gtsam", reason="the extra mapping is not installed")
pytest.importorskip("small_gicp", reason="the extra mapping is not installed")

from common.geometry import Pose2, compose, inverse
from services.mapping.pose_graph import Edge, PoseGraph
from services.mapping.scan_matching import Target, placed
from services.mapping.trajectory import Trajectory
from services.mapping.walls import find_walls
from tests.unit.mapping_flat import drifting, mapped, scan, way
from tests.unit.navigation_flat import SCENE


@pytest.fixture(scope="module")
def true() -> list[Pose2]:
    return way()


@pytest.fixture(scope="module")
def trajectory(true: list[Pose2]) -> Trajectory:
    return mapped(true, drifting(true))


def test_a_scan_finds_its_place_on_another() -> None:
    rng = np.random.default_rng(3)
    here, there = (0.0, 0.0, 0.0), (0.25, -0.1, 0.2)
    match = Target(scan(here, rng).points).match(scan(there, rng).points, (0.15, 0.0, 0.1))
    assert math.dist(match.pose[:2], there[:2]) < 0.01 and abs(match.pose[2] - there[2]) < 0.01
    assert match.fit > 0.8


def test_a_scan_of_another_room_does_not_fit() -> None:
    rng = np.random.default_rng(3)
    match = Target(scan((0.0, 0.0, 0.0), rng).points).match(scan((4.2, 2.6, 0.7), rng).points, (0.0, 0.0, 0.0))
    assert match.fit < 0.5


def test_too_few_points_are_no_match() -> None:
    rng = np.random.default_rng(3)
    guess = (0.3, 0.2, 0.1)
    assert Target(scan((0, 0, 0), rng).points).match(np.zeros((5, 2)), guess) == (guess, 0.0)


def test_the_pose_stays_right_while_the_wheels_drift(true: list[Pose2], trajectory: Trajectory) -> None:
    errors = [math.dist(a[:2], b[:2]) for a, b in zip(trajectory.poses, true, strict=True)]
    assert math.dist(drifting(true)[-1][:2], true[-1][:2]) > 0.2, "the wheels alone"
    assert max(errors) < 0.03
    assert trajectory.loops > 0


def test_turning_on_the_spot_adds_up_no_error_of_heading() -> None:
    """Three times round, as when it first looks about: the home would be turned on the map by what has added up."""
    true = [(0.0, 0.0, math.remainder(k * 0.35, 2 * math.pi)) for k in range(54)]
    off = []
    for seed in range(4):
        found = mapped(true, drifting(true), seed).poses[-6:]
        off += [math.remainder(a[2] - b[2], 2 * math.pi) for a, b in zip(found, true[-6:], strict=True)]
    assert float(np.sqrt(np.mean(np.square(off)))) < 0.0013


def test_the_frame_of_the_wheels_follows(true: list[Pose2], trajectory: Trajectory) -> None:
    assert math.dist(compose(trajectory.odom, drifting(true)[-1])[:2], true[-1][:2]) < 0.03


def test_a_loop_bends_the_way_back_to_where_it_began() -> None:
    graph = PoseGraph()
    square = [(0.0, 0.0, 0.0), (1.0, 0.0, math.pi / 2), (1.0, 1.0, math.pi), (0.0, 1.0, -math.pi / 2)]
    graph.add(square[0])
    for k in range(1, 4):
        step = compose(inverse(square[k - 1]), square[k])
        drifted = (step[0] * 1.05, step[1], step[2] + 0.03)
        graph.add(compose(graph.poses[-1], drifted), Edge(k - 1, k, drifted, "odometry"))
    before = math.dist(graph.poses[3][:2], square[3][:2])
    graph.edges.append(Edge(0, 3, square[3], "loop"))
    assert graph.optimise() > 0.0
    assert math.dist(graph.poses[3][:2], square[3][:2]) < 0.3 * before


def test_walls_are_where_they_were_built(trajectory: Trajectory) -> None:
    points = np.concatenate([placed(s.points, p) for s, p in zip(trajectory.scans, trajectory.poses, strict=True)])
    eyes = np.concatenate(
        [np.tile(p[:2], (len(s.points), 1)) for s, p in zip(trajectory.scans, trajectory.poses, strict=True)]
    )
    found = find_walls(points, eyes, [r.outline.grown(0.06) for r in SCENE.receptacles])
    between = [w for w in found if abs(w.start[0] - 2.5) < 0.1 and abs(w.end[0] - 2.5) < 0.1]
    assert between, "the wall between living room and kitchen"
    for wall in between:
        assert abs(wall.start[0] - 2.5) < 0.03 and abs(wall.end[0] - 2.5) < 0.03
        assert abs(wall.thickness - 0.12) < 0.03
    # No wall closes a door.
    for door in ((2.5, -0.75), (-0.45, 2.0), (2.5, 3.2), (4.25, 1.0)):
        assert all(w.footprint.distance(*door) > 0.40 for w in found), door


def test_a_turned_home_has_the_same_walls(trajectory: Trajectory) -> None:
    turn = (0.5, -0.3, 0.4)
    poses = [compose(turn, p) for p in trajectory.poses]
    points = np.concatenate([placed(s.points, p) for s, p in zip(trajectory.scans, poses, strict=True)])
    eyes = np.concatenate([np.tile(p[:2], (len(s.points), 1)) for s, p in zip(trajectory.scans, poses, strict=True)])
    found = find_walls(points, eyes, [])
    inside = compose(turn, (2.5, 1.5, 0.0))
    assert min(w.footprint.distance(*inside[:2]) for w in found) < 0.03
    assert find_walls(np.zeros((3, 2)), np.zeros((3, 2)), []) == []
