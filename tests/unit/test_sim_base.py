"""The base's driver when whoever steers it falls silent."""

import math

import pytest

from services.sim.base import BaseDriver
from services.sim.config import SimConfig

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
