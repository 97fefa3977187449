import math
from pathlib import Path

import msgspec
import numpy as np
import pytest

from common import config, topics
from common import messages as m
from common.approach import FOOTPRINT
from common.geometry import Rectangle
from common.plan_tables import SCENES
from common.runtime import StartError
from common.scene import Obstacle, load_scene
from services.sim.base import BaseDriver
from services.sim.config import SimConfig
from services.sim.obstacles import DISTANCE, Walker, chosen
from services.sim.pedestrians import Pedestrian
from services.sim.sensors import WheelOdometry
from tests.simulation import Simulation

APARTMENT = load_scene("apartment")
EXACT = {"odometry_slip": 0.0, "odometry_veer": 0.0, "odometry_noise": 0.0}


class World(Simulation):
    """With obstacles, and sensors without error."""

    def __init__(self, *obstacles: Obstacle) -> None:
        super().__init__(APARTMENT, lidar_noise=0.0, obstacles=obstacles, **EXACT)

    def seen(self, bearing: float) -> float:
        """What the lidar measures at `bearing` from the robot's nose."""
        scan = self.last(topics.SCAN)
        ray = round((bearing - scan.angle_min) / scan.angle_increment)
        return float(np.frombuffer(scan.ranges, "<f4")[ray])


def walker(**fields: object) -> Walker:
    return Walker(msgspec.convert({"name": "w", "position": (0.0, 0.0), **fields}, Obstacle), 0)


def test_the_lidar_sees_a_box_and_truth_tells_where_it_is() -> None:
    world = World(Obstacle(name="crate", kind="box", position=(0.0, -1.0), size=(0.4, 0.4, 0.5)))
    world.step(0.2)
    assert world.seen(-math.pi / 2) == pytest.approx(0.8, abs=0.01)
    assert world.truth()["obstacles"] == {
        "crate": {"kind": "box", "position": [0.0, -1.0, 0.25], "size": [0.4, 0.4, 0.5]}
    }


def test_a_box_too_low_for_the_lidar_is_not_seen() -> None:
    world = World(Obstacle(name="mat", kind="box", position=(0.0, -1.0), size=(0.4, 0.4, 0.1)))
    world.step(0.2)
    assert world.seen(-math.pi / 2) > 1.5


def test_it_walks_at_its_speed_along_its_path_and_stays_at_the_end() -> None:
    w = walker(path=[(1.0, 0.0), (1.0, 1.0)], speed=0.5, start=1.0)
    places = []
    for _ in range(700):
        w.advance((9.0, 9.0), 0.01)
        places.append(w.place)
    assert places[95] == (0.0, 0.0), "not before its time"
    assert places[199] == pytest.approx((0.5, 0.0), abs=0.02)
    assert places[399] == pytest.approx((1.0, 0.5), abs=0.02)
    assert places[-1] == pytest.approx((1.0, 1.0))


def test_one_that_repeats_comes_back_the_way_it_went() -> None:
    w = walker(path=[(1.0, 0.0)], speed=0.5, repeat=True)
    xs = []
    for _ in range(800):
        w.advance((9.0, 9.0), 0.01)
        xs.append(w.place[0])
    assert max(xs) == pytest.approx(1.0, abs=0.01) and xs[399] == pytest.approx(0.0, abs=0.02)
    assert max(abs(np.diff(xs))) < 0.006


def test_near_waits_for_the_robot_and_then_goes_on_without_it() -> None:
    w = walker(path=[(1.0, 0.0)], near=1.5)
    assert not any(w.advance((5.0, 0.0), 0.01) for _ in range(50))
    assert w.advance((2.2, 0.0), 0.01), "near its path counts"
    assert w.advance((5.0, 0.0), 0.01)


def test_a_polite_one_waits_before_the_robot_and_may_always_step_back() -> None:
    def closest(polite: bool) -> float:
        w = walker(path=[(3.0, 0.0)], polite=polite)
        gaps = []
        for _ in range(400):
            w.advance((1.5, 0.0), 0.01)
            gaps.append(math.dist(w.place, (1.5, 0.0)))
        return min(gaps)

    assert closest(True) == pytest.approx(0.2 + DISTANCE, abs=0.02)
    assert closest(False) < 0.05
    away = walker(path=[(-1.0, 0.0)])
    assert away.advance((0.2, 0.0), 0.01)


def test_contacts_are_kept_until_the_next_reset() -> None:
    world = World(Obstacle(name="crate", kind="box", position=(0.0, -0.75), size=(0.6, 0.4, 0.5)))
    world.step(0.3)
    assert world.truth()["contacts"] == []
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=0.0, y=-0.5, theta=0.0, id="a"))
    world.step(1.5)
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=0.0, y=0.2, theta=0.0, id="b"))
    world.step(1.5)
    contacts = world.truth()["contacts"]
    assert [(c["part"], c["thing"], c["kind"]) for c in contacts] == [("base", "crate", "obstacle")]  # type: ignore
    assert 0.3 < contacts[0]["first"] < contacts[0]["last"] < 2.5  # type: ignore[index]
    world.bus.get("sim/reset", b"{}")
    assert world.truth()["contacts"] == []


def test_furniture_and_walls_count_as_contacts_and_standing_on_the_floor_does_not() -> None:
    world = World()
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=-0.4, y=0.4, theta=0.0, id="a"))
    world.step(3.0)
    assert world.truth()["contacts"] == []
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=-2.4, y=0.4, theta=0.0, id="b"))
    world.step(5.0)
    assert {(c["thing"], c["kind"]) for c in world.truth()["contacts"]} == {("sofa_seat", "furniture")}  # type: ignore


def test_scene_obstacles_are_there_when_named_and_a_typo_lists_them() -> None:
    assert chosen(APARTMENT, ()) == ()
    assert [o.name for o in chosen(APARTMENT, "visitor")] == ["visitor"]
    assert [o.name for o in chosen(APARTMENT, ("commuter", "visitor"))] == ["commuter", "visitor"]
    with pytest.raises(StartError, match=r"it has: .*visitor"):
        chosen(APARTMENT, "vistor")
    placed = msgspec.structs.replace(APARTMENT, obstacles=(Obstacle(name="crate", position=(0.0, 0.0)),))
    assert [o.name for o in chosen(placed, ())] == ["crate"]
    assert chosen(placed, "none") == ()
    with pytest.raises(StartError, match="positive size"):
        chosen(placed, (Obstacle(name="flat", position=(0.0, 0.0), size=(0.0, 1.0, 1.0)),))


def test_obstacles_can_be_set_from_the_command_line(tmp_path: Path) -> None:
    text = 'sim.obstacles=["visitor", {name = "crate", kind = "box", position = [1, 1], size = [0.3, 0.3, 0.5]}]'
    settings = config.load("sim", SimConfig, tmp_path, config.overrides({}, [text]))
    found = chosen(APARTMENT, settings.obstacles)
    assert [(o.name, o.kind) for o in found] == [("visitor", "cylinder"), ("crate", "box")]
    with pytest.raises(config.ConfigError, match="positon"):
        bad = 'sim.obstacles=[{name = "c", positon = [1, 1]}]'
        config.load("sim", SimConfig, tmp_path, config.overrides({}, [bad]))


def test_every_preset_of_the_scene_stands_free_of_the_robot_s_start() -> None:
    assert len(APARTMENT.obstacles) >= 6 and (SCENES / "apartment.toml").exists()
    for o in APARTMENT.obstacles:
        assert not o.placed
        assert math.hypot(*o.position) > 0.9, o.name


def test_wheels_drift_the_same_for_a_seed_and_not_at_all_when_asked() -> None:
    def after(seed: int, **fields: float) -> tuple[float, float, float]:
        wheels = WheelOdometry((0.0, 0.0, 0.0), msgspec.convert(fields, SimConfig), seed)
        for k in range(2000):
            believed = wheels.update((2.0 * math.sin(k / 100), 2.0 - 2.0 * math.cos(k / 100), k / 100))
        return believed

    assert after(1) == after(1) != after(2)
    assert math.dist(after(1)[:2], (2.0 * math.sin(19.99), 2.0 - 2.0 * math.cos(19.99))) > 0.05
    exact = after(1, **{k: float(str(v)) for k, v in EXACT.items()})
    assert exact[:2] == pytest.approx((2.0 * math.sin(19.99), 2.0 - 2.0 * math.cos(19.99)))


def test_standing_still_nothing_drifts() -> None:
    wheels = WheelOdometry((1.0, 2.0, 0.5), SimConfig(), 0)
    believed = {wheels.update((1.0, 2.0, 0.5)) for _ in range(1000)}
    assert believed == {(1.0, 2.0, 0.5)}


def test_the_base_goes_by_its_wheels_and_not_by_where_it_is() -> None:
    """With odometry that is off by a constant, the way travelled is what counts."""
    config, dt = SimConfig(), 0.01
    driver = BaseDriver(config, (3.0, 1.0, math.pi / 2))
    wrong = (0.0, 0.0, 0.0)
    driver.go_to(1.0, 0.0, 0.0, "a", 0.0)
    actual = (3.0, 1.0, math.pi / 2)
    for k in range(600):
        actual = driver.advance(actual, wrong, k * dt, dt)
        wrong = (actual[1] - 1.0, 3.0 - actual[0], actual[2] - math.pi / 2)
    assert actual[:2] == pytest.approx((3.0, 2.0), abs=0.01)
    assert driver.reached(wrong)


def crowd(*rows: dict[str, object]) -> list[Pedestrian]:
    """People on a floor with one wall along y = 1."""
    people = [
        Pedestrian(msgspec.convert({"name": f"p{n}", "social": True, **row}, Obstacle), n, [WALL])
        for n, row in enumerate(rows)
    ]
    for person in people:
        person.others = people
    return people


WALL = Rectangle(0.0, 1.06, 20.0, 0.12)
AWAY = (9.0, -9.0)


def test_a_person_walks_to_and_fro_at_their_speed() -> None:
    (one,) = crowd({"position": (0.0, -1.0), "path": [(3.0, -1.0)], "speed": 0.6})
    xs = []
    for _ in range(1200):
        one.advance(AWAY, 0.01)
        xs.append(one.place[0])
    assert max(xs) == pytest.approx(3.0, abs=0.5) and min(xs[xs.index(max(xs)) :]) < 0.5
    assert xs[300] - xs[200] == pytest.approx(0.6, abs=0.05)


def test_people_go_round_a_robot_that_stands_in_their_way_and_do_not_touch_it() -> None:
    (one,) = crowd({"position": (0.0, 0.0), "path": [(4.0, 0.02)], "speed": 0.8})
    robot, gaps = (2.0, -0.05), []
    for _ in range(900):
        one.advance(robot, 0.01)
        gaps.append(math.dist(one.place, robot))
        if one.place[0] > 3.4:
            break
    assert one.place[0] > 3.4, "past it"
    assert min(gaps) > FOOTPRINT + 0.2, "their own radius beside the robot's"


def test_people_keep_apart_from_each_other_and_from_the_wall() -> None:
    people = crowd(
        {"position": (0.0, 0.5), "path": [(4.0, 0.5)], "speed": 0.8},
        {"position": (4.0, 0.55), "path": [(0.0, 0.55)], "speed": 0.8},
    )
    gaps, walls = [], []
    for _ in range(500):
        for person in people:
            person.advance(AWAY, 0.01)
        gaps.append(math.dist(people[0].place, people[1].place))
        walls.append(min(1.0 - p.place[1] for p in people))
    assert min(gaps) > 0.4 and min(walls) > 0.2
    assert people[0].place[0] > 2.5 and people[1].place[0] < 1.5, "they have passed"


def test_people_walk_through_doors() -> None:
    left, right = Rectangle(-2.4, 1.0, 4.0, 0.12), Rectangle(2.4, 1.0, 4.0, 0.12)
    row = {"name": "p", "social": True, "position": (0.1, -1.0), "path": [(0.0, 0.9), (0.2, 3.0)], "speed": 0.6}
    one, ys, walls = Pedestrian(msgspec.convert(row, Obstacle), 0, [left, right]), [], []
    for _ in range(900):
        one.advance(AWAY, 0.01)
        ys.append(one.place[1])
        walls.append(min(left.distance(*one.place), right.distance(*one.place)))
    assert max(ys) > 2.5, "a door of 0.8 m"
    assert min(walls) > 0.2, "without touching its frame"


def test_who_cannot_get_on_turns_round() -> None:
    (one,) = crowd({"position": (0.0, -1.0), "path": [(2.0, 2.0)], "speed": 0.6})
    for _ in range(2000):
        one.advance(AWAY, 0.01)
    assert one.place[1] < 0.8, "the wall is between"
    assert any(one.advance(AWAY, 0.01) for _ in range(5)), "and still walks"
