"""The simulated battery: driving costs more than standing, and it is told once a second."""

import pytest

from common import topics
from services.sim.battery import ARM, CAPACITY, IDLE, Battery
from tests.simulation import Simulation


def test_it_empties_by_what_is_drawn_and_not_below_nothing() -> None:
    standing, driving = Battery(), Battery()
    standing.draw(0.0, 0.0, 0.0, 3600.0)
    driving.draw(0.3, 0.4, 0.0, 3600.0)
    assert standing.charge == pytest.approx(1.0 - (IDLE + ARM) / CAPACITY) and driving.charge < standing.charge
    driving.draw(0.5, 0.0, 1.0, 36_000.0)
    assert driving.charge == 0.0


def test_the_robot_tells_it_once_a_second() -> None:
    robot = Simulation("minimal", battery=0.5)
    robot.step(2.0)
    told = robot.sent(topics.BATTERY)
    assert len(told) == 2 and 0.499 < told[-1].charge < told[0].charge < 0.5 and told[-1].power >= IDLE + ARM
