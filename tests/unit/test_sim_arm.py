"""The arm's driver alone: set-points in time, and late ones."""

import numpy as np
import pytest

from services.sim.arm import SPEED, ArmDriver

DT, PERIOD = 0.01, 0.02
WIDE = np.full(7, -3.0), np.full(7, 3.0)


def ways(every: float, timeout: float = 0.25) -> np.ndarray:
    """Ways [rad] of the first joint in each tick while set-points .02 rad apart, made for .02 s, come `every` s."""
    driver = ArmDriver(np.zeros(7), timeout, WIDE)
    seen, period = [0.0], round(every / DT)
    for tick in range(10 * period):
        if tick % period == 0:
            assert not driver.follow([0.02 * (tick // period + 1)] * 7, PERIOD, tick * DT)
        seen.append(float(driver.advance(tick * DT, DT)[0]))
    return np.diff(seen)


def test_in_time_it_moves_at_the_speed_of_its_stream() -> None:
    assert ways(0.02) == pytest.approx(0.01)


@pytest.mark.parametrize("every", [0.04, 0.1, 0.2])
def test_late_set_points_make_it_slow_and_not_stop_and_go(every: float) -> None:
    steady = ways(every)[round(every / DT) :]
    assert steady == pytest.approx(0.02 * DT / every)


def test_the_first_set_point_after_a_silence_is_followed_within_its_period() -> None:
    assert ways(0.3)[-30:-28] == pytest.approx(0.01)


def test_set_points_that_come_at_once_are_caught_up_with_at_the_speed_of_the_joints() -> None:
    driver = ArmDriver(np.zeros(7), 0.5, WIDE)
    for n in range(1, 21):
        assert driver.follow([0.02 * n] * 7, 0.02, 1.0) == ""
    way = np.array([np.zeros(7)] + [driver.advance(1.0 + n * 0.01, 0.01) for n in range(40)])
    assert np.allclose(way[-1], 0.4)
    assert (np.abs(np.diff(way, axis=0)) <= SPEED * 0.01 + 1e-9).all()
