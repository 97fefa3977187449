"""The lidar in its slot: what the robot's own body hides, what glass does, and what navigation makes of both."""

import math

import msgspec
import mujoco
import numpy as np
import pytest

from common import topics
from common.approach import HALF_WIDTH
from common.floor_plan import Wall
from common.household import told
from common.scene import Scene, load_scene
from services.navigation.localisation.distance_field import DistanceField
from services.navigation.planning.costmap import Costmap
from services.sim.lidar import Lidar
from services.sim.physics import Physics
from tests.simulation import Simulation

MINIMAL = load_scene("minimal")
ANGLES = -math.pi + np.arange(360) * math.tau / 360


def glazed() -> Scene:
    """The small room with a wall of glass in front of the robot's right side."""
    return msgspec.structs.replace(MINIMAL, walls=(*MINIMAL.walls, Wall((-0.5, -0.7), (0.5, -0.7), glass=True)))


def ranges(scene: Scene = MINIMAL, seconds: float = 0.1) -> np.ndarray:
    sim = Simulation(scene, lidar_noise=0.0, lidar_missing=0.0)
    for _ in range(round(seconds * 100)):
        sim.later()
        sim.run()
    return np.frombuffer(sim.last(topics.SCAN).ranges, "<f4").astype(float)


def ray(degrees: float) -> int:
    return round(degrees + 180) % 360


def test_four_posts_stand_in_the_way_and_are_the_robots_own() -> None:
    seen = ranges()
    own = np.abs(np.stack([np.cos(ANGLES), np.sin(ANGLES)]) * seen).max(axis=0) < HALF_WIDTH
    assert own[[ray(45), ray(135), ray(-45), ray(-135)]].all()
    assert not own[[ray(0), ray(90), ray(180), ray(-90)]].any()
    assert 24 <= own.sum() <= 44, "each post is 4 cm wide at 25 cm"
    assert seen[ray(45)] == pytest.approx(math.hypot(0.175, 0.175) - 0.02, abs=1e-3)


def test_the_arm_hides_what_is_behind_it_when_it_reaches_down() -> None:
    physics = Physics(MINIMAL, 0)
    model, data = physics.model, physics.data
    lidar = Lidar(model, physics.lidar_site, 0.0, 0.0, np.random.default_rng(0))
    data.qpos[physics.qpos_at[2]] = math.pi / 2
    mujoco.mj_kinematics(model, data)
    free = lidar.scan(model, data)
    data.qpos[physics.qpos_at[3:]] = (0.0, 2.0, 0.0, 0.6, 0.0, 0.0, 0.0)
    mujoco.mj_kinematics(model, data)
    hidden = lidar.scan(model, data)
    assert hidden[ray(0)] < 0.8 < free[ray(0)]
    assert hidden[ray(180)] == free[ray(180)]


def test_glass_returns_nothing_and_what_stands_behind_it_does() -> None:
    assert ranges()[ray(-90)] == pytest.approx(1.44, abs=0.01)
    assert ranges(glazed())[ray(-90)] == pytest.approx(1.44, abs=0.01)
    opaque = msgspec.structs.replace(glazed(), walls=(*MINIMAL.walls, Wall((-0.5, -0.7), (0.5, -0.7))))
    assert ranges(opaque)[ray(-90)] == pytest.approx(0.64, abs=0.01)


def test_a_map_knows_that_glass_is_there_and_that_no_ray_ends_at_it() -> None:
    plan = told(glazed())
    field, costmap = DistanceField(plan, 0.2), Costmap(plan, 0.05, 30.0)
    assert field.nearest(np.array([[0.0, -0.7]]))[0] > 0.3
    assert (costmap.static_distance <= 0)[costmap.cell(0.0, -0.7)]


def test_a_ray_held_up_by_the_robot_itself_marks_and_clears_nothing() -> None:
    made = Costmap(told(MINIMAL), 0.05, 30.0)
    seen = np.full(360, 11.0)
    seen[ray(-90)] = 0.8
    made.obstacles.see((0.0, 0.0, 0.0), ANGLES, seen, 10.0, 1.0)
    spot = made.cell(0.0, -0.8)
    assert made.distance[spot] == 0.0
    made.obstacles.see((0.0, 0.0, 0.0), ANGLES, np.zeros(360), 10.0, 1.5)
    assert made.distance[spot] == 0.0 and made.distance[made.cell(0.0, 0.0)] > 0.4
    made.obstacles.see((0.0, 0.0, 0.0), ANGLES, np.full(360, 11.0), 10.0, 2.0)
    assert made.distance[spot] > 0.5
