import math

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2, Rectangle, compose, inverse, wrap
from common.household import load_household
from services.navigation.config import NavigationConfig
from services.navigation.localisation.distance_field import REACH, DistanceField, distance_field, rectangles
from services.navigation.localisation.hypotheses import hypotheses
from services.navigation.localisation.localise import Localiser
from services.navigation.localisation.state_estimation import StateEstimator
from services.navigation.planning.costmap import Costmap
from services.navigation.service import NavigationService
from tests.node import Node
from tests.unit.navigation_flat import cast, ends

SCENE = load_household("apartment")
HEIGHT = 0.2
FIELD = distance_field(SCENE, HEIGHT)


def off(a: Pose2, b: Pose2) -> tuple[float, float]:
    return math.dist(a[:2], b[:2]), abs(wrap(a[2] - b[2]))


def test_the_field_is_the_exact_distance_near_a_wall_and_negative_inside() -> None:
    points = np.array([[0.0, -3.5 + 0.06 + 0.2], [0.0, -3.5], [0.0, -3.5 + 0.06], [0.5, 0.9]])
    distance, gx, gy = FIELD.at(points)
    assert distance[:3] == pytest.approx([0.2, -0.06, 0.0], abs=0.002)
    assert distance[3] == pytest.approx(REACH)
    assert (gx[0], gy[0]) == pytest.approx((0.0, 1.0), abs=0.02)


def test_points_beyond_the_map_do_no_harm() -> None:
    distance, _, _ = FIELD.at(np.array([[1e6, -1e6], [-50.0, 0.0]]))
    assert np.isfinite(distance).all()


def test_a_table_is_its_legs_a_bin_its_walls_a_cabinet_its_body() -> None:
    def at(x: float, y: float) -> float:
        return float(FIELD.at(np.array([[x, y]]))[0][0])

    assert at(5.30, -0.75) > 0.2, "between the legs of the kitchen table"
    assert at(5.30 - 0.56, -0.75 - 0.36) < 0.0, "a leg of it"
    assert at(6.60, -2.30) > 0.1, "inside the bin"
    assert at(0.70, 0.0) < -0.1, "the tray's cabinet"
    assert len(rectangles(SCENE, 2.2)) == len(SCENE.walls), "high up there are walls alone"


@pytest.mark.parametrize("true", [(0.0, 0.0, 0.3), (3.6, -1.2, -0.8), (4.2, 2.2, 2.0), (-1.4, 2.9, 3.1)])
def test_a_scan_corrects_a_pose_that_is_off(true: Pose2) -> None:
    points = ends(cast(true, rectangles(SCENE, HEIGHT)))
    localiser = Localiser(FIELD)
    localiser.place(compose(true, (0.08, -0.06, 0.06)), (0.1, 0.1, 0.05))
    for _ in range(3):
        fit = localiser.correct(points)
    distance, angle = off(localiser.pose, true)
    assert distance < 0.005 and angle < 0.003 and fit > 0.95
    assert np.linalg.eigvalsh(localiser.covariance).min() > 0


def test_what_the_map_does_not_have_pulls_at_nothing() -> None:
    true: Pose2 = (0.4, -0.9, 1.0)
    crowd: list[Rectangle] = [(1.1, -0.6, 0.4, 0.4, 0.2), (-0.2, -1.6, 0.5, 0.3, 0.0), (0.5, 0.2, 0.4, 0.4, 0.0)]
    ranges = cast(true, rectangles(SCENE, HEIGHT) + crowd)
    assert (ranges < cast(true, rectangles(SCENE, HEIGHT)) - 0.1).mean() > 0.2, "many rays end early"
    localiser = Localiser(FIELD)
    localiser.place(compose(true, (0.04, 0.03, -0.03)), (0.05, 0.05, 0.03))
    for _ in range(3):
        localiser.correct(ends(ranges))
    distance, angle = off(localiser.pose, true)
    assert distance < 0.01 and angle < 0.005 and localiser.fit < 0.8


def test_uncertainty_grows_with_the_way_and_shrinks_with_a_scan() -> None:
    localiser = Localiser(FIELD)
    localiser.predict((0.0, 0.0, 0.0))
    before = np.trace(localiser.covariance)
    for k in range(1, 30):
        localiser.predict((0.03 * k, 0.0, 0.0))
    grown = np.trace(localiser.covariance)
    assert grown > 1.4 * before
    localiser.correct(ends(cast((0.87, 0.0, 0.0), rectangles(SCENE, HEIGHT))))
    assert np.trace(localiser.covariance) < before
    assert off(localiser.pose, (0.87, 0.0, 0.0))[0] < 0.005


def test_standing_still_it_grows_not_at_all_and_never_becomes_certain() -> None:
    localiser = Localiser(FIELD)
    points = ends(cast((0.0, 0.0, 0.0), rectangles(SCENE, HEIGHT)))
    for _ in range(200):
        localiser.predict((0.0, 0.0, 0.0))
        localiser.correct(points)
    assert np.linalg.eigvalsh(localiser.covariance).min() > 1e-7
    assert off(localiser.pose, (0.0, 0.0, 0.0))[0] < 0.002


def test_targets_go_out_in_the_frame_of_the_wheels() -> None:
    localiser = Localiser(FIELD)
    localiser.predict((1.0, 2.0, 0.5))
    localiser.place((0.9, 2.1, 0.4), (0.1, 0.1, 0.1))
    target = (1.5, 2.4, -0.2)
    sent = localiser.to_odometry(target)
    assert compose((0.9, 2.1, 0.4), compose(inverse((1.0, 2.0, 0.5)), sent)) == pytest.approx(target)


class Hearing:
    """The senses as a service of their own."""

    NAME, HZ = NavigationService.NAME, NavigationService.HZ
    READS, WRITES = (topics.ODOMETRY, topics.JOINT_STATES, topics.SCAN), (topics.POSE,)

    def __init__(self, config: NavigationConfig, io: Io) -> None:
        self.senses = StateEstimator(config, io, Costmap(io.household, config.resolution, 4.0))
        self.step = self.senses.step


class Ear(Node):
    """StateEstimator with a robot whose wheels lie."""

    def __init__(self) -> None:
        super().__init__(Hearing, NavigationConfig(), SCENE)
        self.senses: StateEstimator = self.service.senses

    def feel(self, wheels: Pose2, ranges: np.ndarray | None, scan_age: float = 0.0, **velocity: float) -> None:
        self.later()
        x, y, theta = wheels
        self.send(topics.ODOMETRY, m.Odometry(t=self.now, x=x, y=y, theta=theta, **velocity))
        if ranges is not None:
            self.send(topics.SCAN, m.LaserScan(t=self.now - scan_age, ranges=ranges.astype("<f4").tobytes()))
        self.run()

    def pose(self) -> m.PoseEstimate:
        return self.last(topics.POSE)


def test_the_pose_on_the_bus_follows_the_truth_while_the_wheels_drift() -> None:
    ear, boxes = Ear(), rectangles(SCENE, HEIGHT)
    true: Pose2 = (0.0, 0.0, 0.0)
    wheels: Pose2 = (0.0, 0.0, 0.0)
    for k in range(200):
        step = (0.01, -0.008, 0.01)
        true = compose(true, step)
        wheels = compose(wheels, (step[0] * 1.05, step[1] * 0.95, step[2] + 0.002))
        ear.feel(wheels, cast(true, boxes) if k % 2 == 0 else None)
    pose = ear.pose()
    assert off(wheels, true)[1] > 0.3
    distance, angle = off((pose.x, pose.y, pose.theta), true)
    assert distance < 0.02 and angle < 0.01
    assert len(pose.covariance) == 9 and 0 < pose.covariance[0] < 1e-3


def test_an_old_scan_is_moved_to_where_the_robot_is_now() -> None:
    ear, boxes = Ear(), rectangles(SCENE, HEIGHT)
    for k in range(60):
        angle = 0.06 * k
        old = (0.0, 0.0, angle - 1.2 * 0.04)
        ear.feel((0.0, 0.0, angle), cast(old, boxes), scan_age=0.04, omega=1.2)
    assert ear.pose().theta == pytest.approx(wrap(0.06 * 59), abs=0.01)


def test_a_base_without_odometry_is_placed_by_its_joints() -> None:
    ear = Ear()
    joints = m.JointStates(
        t=0.0, name=["base_x", "base_y", "base_yaw"], position=[0.3, -0.2, 0.1], velocity=[], effort=[]
    )
    ear.bus.send(topics.JOINT_STATES, joints)
    ear.step()
    assert (ear.pose().x, ear.pose().y, ear.pose().theta) == pytest.approx((0.3, -0.2, 0.1))


def test_odometry_that_starts_again_is_a_new_guess() -> None:
    ear = Ear()
    ear.feel((2.0, 1.0, 0.4), None)
    ear.feel((0.0, 0.0, 0.0), None)
    assert (ear.pose().x, ear.pose().y) == (0.0, 0.0)
    assert ear.pose().covariance[0] > 0.05


@pytest.mark.parametrize("true", [(3.6, -1.2, -0.8), (4.2, 2.2, 2.0), (-1.4, 2.9, 3.0), (-1.0, -1.2, 0.5)])
def test_a_scan_alone_tells_the_place(true: Pose2) -> None:
    points = ends(cast(true, rectangles(SCENE, HEIGHT)))
    best, *others = hypotheses(FIELD, points, SCENE.low, SCENE.high)
    distance, angle = off(best.pose, true)
    assert distance < 0.03 and angle < 0.02 and best.score > 0.9
    assert all(other.score < best.score - 0.2 for other in others)


def test_after_a_start_in_the_middle_of_a_run_the_robot_finds_itself() -> None:
    ear = Ear()
    true, wheels = (3.6, -1.2, -0.8), (2.6, -2.0, 0.1)
    ranges = cast(true, rectangles(SCENE, HEIGHT))
    for _ in range(100):
        ear.feel(wheels, ranges)
    pose = ear.pose()
    assert off((pose.x, pose.y, pose.theta), true)[0] < 0.03
    assert ear.senses.localiser.fit > 0.9 and not ear.senses.lost


def test_a_scan_that_fits_nowhere_moves_nothing() -> None:
    ear = Ear()
    rng = np.random.default_rng(0)
    for _ in range(100):
        ear.feel((0.0, 0.0, 0.0), rng.uniform(0.3, 4.0, 360))
    pose = ear.pose()
    assert off((pose.x, pose.y, pose.theta), (0.0, 0.0, 0.0))[0] < 0.3


def test_any_scene_has_a_field() -> None:
    small = load_household("minimal")
    assert DistanceField(small, HEIGHT).at(np.array([[2.3, 0.0]]))[0][0] > 0.1, "under the table"
