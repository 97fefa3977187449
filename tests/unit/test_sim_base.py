"""The base's driver: streams that fall silent, the grip of the tyres, and pushes."""

import math

import numpy as np
import pytest

from common import messages as m
from common import topics
from services.sim.base import BaseDriver
from services.sim.config import SimConfig
from tests.simulation import Simulation

DT, PERIOD = 0.01, 0.05


def drive(driver: BaseDriver, seconds: float, now: float, carrot: float | None) -> float:
    """Ideal servos; every `PERIOD` a target `carrot` metres ahead. The time afterwards."""
    for tick in range(round(seconds / DT)):
        if carrot is not None and tick % round(PERIOD / DT) == 0:
            driver.go_to(driver.pose[0] + carrot, 0.0, 0.0, f"n#{tick}", now)
        driver.advance(driver.pose, driver.pose, now, DT)
        now += DT
    return now


def speed(driver: BaseDriver) -> float:
    return math.hypot(*driver.velocity[:2])


def test_a_stream_of_targets_that_falls_silent_brakes_the_base() -> None:
    config = SimConfig()
    driver = BaseDriver(config)
    now = drive(driver, 2.0, 0.0, 0.5)
    assert speed(driver) == pytest.approx(config.max_speed, rel=0.05)
    now = drive(driver, config.target_timeout - 0.02, now, None)
    assert speed(driver) > 0.8 * config.max_speed, "one late target is no reason to brake"
    stopped = drive(driver, 0.5 - config.target_timeout, now, None)
    assert speed(driver) == pytest.approx(0.0, abs=1e-6)
    at = driver.pose[0]
    now = drive(driver, 5.0, stopped, None)
    assert driver.pose[0] == pytest.approx(at), "and it stays"
    drive(driver, 2.0, now, 0.5)
    assert speed(driver) == pytest.approx(config.max_speed, rel=0.05), "the stream goes on, and so does the base"


def test_one_target_is_run_to_its_end() -> None:
    driver = BaseDriver(SimConfig())
    driver.go_to(2.0, 0.0, 0.0, "kitchen", 0.0)
    drive(driver, 10.0, 0.0, None)
    assert driver.pose[0] == pytest.approx(2.0, abs=0.02)
    assert driver.reached(driver.pose)


def test_a_correction_right_behind_a_target_is_no_stream() -> None:
    driver = BaseDriver(SimConfig())
    driver.go_to(2.0, 0.0, 0.0, "a", 0.0)
    driver.go_to(1.0, 0.0, 0.0, "b", 0.1)
    drive(driver, 10.0, 0.1, None)
    assert driver.pose[0] == pytest.approx(1.0, abs=0.02)


EXACT = {"odometry_slip": 0.0, "odometry_veer": 0.0, "odometry_noise": 0.0}


def driving(seconds: float) -> Simulation:
    """Sideways from home at full speed."""
    sim = Simulation(**EXACT)
    for _ in range(round(seconds * 20)):
        sim.bus.send(topics.CMD_VEL, m.CmdVel(vx=0.0, vy=0.5, omega=0.0))
        sim.step(0.05)
    return sim


def rate(sim: Simulation) -> float:
    return float(np.hypot(*sim.sim.physics.rates[:2]))


def test_a_stop_brakes_as_hard_as_the_tyres_grip_and_no_harder() -> None:
    sim = driving(1.2)
    assert rate(sim) == pytest.approx(0.5, abs=0.02)
    sim.bus.send(topics.ROBOT_STOP, m.RobotStop(reason="test", source="test"))
    speeds = []
    for _ in range(30):
        sim.step(0.01)
        speeds.append(rate(sim))
    assert speeds[11] <= 0.25, "half speed within 120 ms"
    assert speeds[-1] < 0.01, "rest within 300 ms"
    assert max(-np.diff([0.5, *speeds])) / DT < 5.0, "69 kg on tyres that hold 345 N"
    at = sim.sim.physics.joints[:2].copy()
    sim.step(1.0)
    assert sim.sim.physics.joints[:2] == pytest.approx(at, abs=0.002), "and it stays there"


def push(sim: Simulation, force: float, seconds: float) -> None:
    data, body = sim.sim.physics.data, sim.sim.physics.model.body("base").id
    data.xfrc_applied[body, 1] = force
    sim.step(seconds)
    data.xfrc_applied[body, 1] = 0.0


@pytest.mark.parametrize(("force", "moves"), [(60.0, False), (150.0, True), (-150.0, True)])
def test_a_base_that_is_pushed_moves_and_notices(force: float, moves: bool) -> None:
    sim = Simulation(**EXACT)
    home = sim.sim.physics.joints[1]
    push(sim, force, 1.0)
    moved = float(sim.sim.physics.joints[1] - home)
    assert bool(moved * np.sign(force) > 0.02) is moves and abs(moved) < 0.1
    assert sim.last(topics.ODOMETRY).y == pytest.approx(home + moved, abs=0.005)
    sim.step(1.0)
    assert sim.sim.physics.joints[1] == pytest.approx(home + (moved if moves else 0.0), abs=0.005)


def test_who_was_pushed_off_his_target_is_not_there_any_more_and_drives_back() -> None:
    sim = Simulation(**EXACT)
    x, y, theta = sim.sim.physics.joints[:3].tolist()
    sim.bus.send(topics.BASE_TARGET, m.BaseTarget(x=x, y=y, theta=theta, id="here"))
    sim.step(0.3)
    assert sim.last(topics.GOAL_REACHED).reached
    push(sim, 200.0, 1.0)
    assert not sim.last(topics.GOAL_REACHED).reached
    sim.step(2.0)
    assert sim.last(topics.GOAL_REACHED).reached
    assert sim.sim.physics.joints[1] == pytest.approx(y, abs=0.02)
