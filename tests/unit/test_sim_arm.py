"""The arm's driver alone: set-points in time, and late ones."""

import numpy as np
import pytest

from services.sim.drivers import ACCELERATION, BEGIN, LEAST, SPEED, ArmDriver

DT, PERIOD = 0.01, 0.02
WIDE = np.full(7, -3.0), np.full(7, 3.0)
AT = np.zeros(7)


def ways(every: float, timeout: float = 0.25) -> np.ndarray:
    """Ways [rad] of the first joint in each tick while set-points come `every` s, made for .02 s: farther and farther
    apart, up to .02 rad."""
    driver = ArmDriver(np.zeros(7), timeout, WIDE)
    seen, period, goal = [0.0], round(every / DT), 0.0
    for tick in range(60 * period):
        if tick % period == 0:
            goal += min(0.02, 0.001 * (tick // period + 1))
            assert not driver.follow([goal] * 7, PERIOD, tick * DT, AT)
        seen.append(float(driver.advance(tick * DT, DT)[0]))
    return np.diff(seen)


def test_in_time_it_moves_at_the_speed_of_its_stream() -> None:
    assert ways(0.02)[40:] == pytest.approx(0.01)


@pytest.mark.parametrize("every", [0.04, 0.1, 0.2])
def test_late_set_points_make_it_slow_and_not_stop_and_go(every: float) -> None:
    assert ways(every)[-20:] == pytest.approx(0.02 * DT / every)


def test_set_points_that_come_at_once_are_caught_up_with_as_the_joints_can() -> None:
    driver = ArmDriver(np.zeros(7), 1.0, WIDE)
    for n in range(1, 21):
        assert driver.follow([0.02 * n] * 7, 0.02, 1.0, AT) == ""
    way = np.array([np.zeros(7)] * 2 + [driver.advance(1.0 + n * DT, DT) for n in range(90)])
    speed = np.diff(way, axis=0) / DT
    assert np.allclose(way[-1], 0.4, atol=1e-3) and way.max() < 0.41
    assert (np.abs(speed) <= SPEED + 1e-9).all()
    assert (np.abs(np.diff(speed, axis=0)) <= ACCELERATION * DT + 1e-9).all()


def test_it_brakes_where_the_stream_ends() -> None:
    driver = ArmDriver(np.zeros(7), 0.1, WIDE)
    for tick in range(100):
        if tick % 2 == 0 and tick < 60:
            driver.follow([0.02 * (tick // 2 + 1)] * 7, PERIOD, tick * DT, AT)
        last = driver.advance(tick * DT, DT).copy()
    assert np.allclose(driver.advance(1.0, DT), last) and (np.abs(last - 0.6) < 0.2).all()


def test_a_stream_begins_where_the_arm_is_or_was_told_to_be() -> None:
    """What another process of the driver was told meanwhile is no place to hurry to."""
    driver, pressed = ArmDriver(np.zeros(7), 0.25, WIDE), np.full(7, -0.5)
    assert "does not begin" in driver.follow([2 * BEGIN] * 7, PERIOD, 1.0, AT)
    assert np.allclose(driver.advance(1.0, DT), 0.0)
    assert driver.follow([-0.5] * 7, PERIOD, 1.0, pressed) == ""
    for n in range(10):
        driver.advance(1.0 + n * DT, DT)
    assert driver.follow([-0.3] * 7, PERIOD, 1.2, pressed) == "", "the stream is under way"
    assert "does not begin" in driver.follow([-0.1] * 7, PERIOD, 1.6, pressed)


@pytest.mark.parametrize("behind", [0.05, 0.25, 0.4])
@pytest.mark.parametrize("speed", [0.0, 0.4, 1.0])
def test_behind_its_stream_it_catches_up_without_passing_it(behind: float, speed: float) -> None:
    """Set-points were lost or come all at once: the arm is where the stream was a while ago, and the stream goes on and
    comes to rest."""
    driver, dt, goal, ahead = ArmDriver(np.zeros(7), 0.25, WIDE), 0.002, behind, 0.0
    assert driver.follow([0.0] * 7, PERIOD, -PERIOD, AT) == ""
    for n in range(100):
        goal += speed * PERIOD
        speed = max(0.0, speed - 2.5 * PERIOD) if n > 10 else speed
        assert driver.follow([goal] * 7, PERIOD, n * PERIOD, AT) == ""
        for k in range(10):
            at = driver.advance(n * PERIOD + k * dt, dt)
            ahead = max(ahead, float((at - goal).max()))
    assert ahead < 0.01 and at == pytest.approx(goal, abs=1e-3)


def test_a_slow_stream_is_caught_up_with_slowly() -> None:
    """What is set down comes to its surface no faster than twice as fast as it was told, however late it is."""
    slow = 0.12
    driver, seen = ArmDriver(np.zeros(7), 0.25, WIDE), [0.0]
    for tick in range(200):
        now = tick * DT
        if tick % 2 == 0 and not 50 <= tick < 70:  # for 0.2 s nothing comes, then all at once
            first = 50 if tick == 70 else tick
            for n in range(first, tick + 1, 2):
                assert not driver.follow([slow * (n + 2) * DT] * 7, PERIOD, now, AT)
        seen.append(float(driver.advance(now, DT)[0]))
    speed = np.diff(seen) / DT
    assert speed.max() <= 2 * slow + LEAST + 1e-9 and seen[-1] == pytest.approx(slow * 2.0, abs=0.01)
