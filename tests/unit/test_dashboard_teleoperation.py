"""Driving from the page: as long as somebody holds on, slowly, and not into what the lidar sees."""

from math import hypot, pi
from typing import Any

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from services.dashboard.teleoperation import HOLD, ROOM, SPEED, STALE, TURN, Teleoperation, limit
from tests.simulation import Simulation

READS = (topics.BRAIN_STATE, topics.SIM_STATUS, topics.SCAN, topics.NAVIGATION_FEEDBACK)


def scan(distances: dict[int, float], x: float = 0.0) -> m.LaserScan:
    """All around 9 m, but for some angles [degrees]."""
    ranges = np.full(360, 9.0, "<f4")
    for angle, distance in distances.items():
        ranges[(angle + 180) % 360] = distance
    return m.LaserScan(t=0.0, ranges=ranges.tobytes(), x=x)


class Seat:
    """The teleoperation on a bus that keeps every velocity."""

    def __init__(self, state: Any = "WAITING", seen: m.LaserScan | None = None) -> None:
        self.bus = MemoryBus()
        home = load_household("minimal")
        self.io = MemoryIo(self.bus, "dashboard", READS, (topics.CMD_VEL,), household=home, lockstep=False)
        self._scan = seen or scan({})
        self.bus.send(topics.BRAIN_STATE, m.BrainState(state=state))
        self.driven = Teleoperation(self.io)
        self._tap = self.bus.tap(topics.CMD_VEL)

    def step(self, now: float, lidar: bool = True) -> None:
        if lidar:
            self.bus.send(topics.SCAN, self._scan)
        self.io.begin(None, now)
        self.driven.step(now)

    def speeds(self) -> list[m.CmdVel]:
        return [codec.decode(topics.CMD_VEL, payload) for payload in self._tap]


def test_it_drives_while_somebody_holds_on_and_stops_by_itself() -> None:
    seat = Seat()
    seat.step(0.0)
    assert seat.speeds() == []
    seat.driven.hold("1 0 0.5", 1.0)
    for now in (1.0, 1.2, 1.0 + HOLD - 0.01):
        seat.step(now)
    assert [(s.vx, s.vy, s.omega) for s in seat.speeds()] == [(SPEED, 0.0, TURN / 2)] * 3
    for now in (1.0 + HOLD, 1.0 + HOLD + 0.1, 9.0):
        seat.step(now)
    assert [(s.vx, s.vy, s.omega) for s in seat.speeds()[3:]] == [(0.0, 0.0, 0.0)], "one stop, then silence"


def test_letting_go_stops_at_once() -> None:
    seat = Seat()
    seat.driven.hold("0 1 0", 1.0)
    seat.step(1.0)
    seat.driven.hold("0 0 0", 1.05)
    seat.step(1.05)
    assert (seat.speeds()[-1].vx, seat.speeds()[-1].vy) == (0.0, 0.0)


def test_a_diagonal_is_no_faster() -> None:
    seat = Seat()
    seat.driven.hold("1 -1 0", 1.0)
    seat.step(1.0)
    (speed,) = seat.speeds()
    assert hypot(speed.vx, speed.vy) == pytest.approx(SPEED) and speed.vy < 0


@pytest.mark.parametrize("text", ["", "1 0", "1 0 0 0", "a b c", "nan 0 0", "inf 0 0", "2 0 0", "1,0,0"])
def test_what_is_no_wish_moves_nothing_and_is_counted(text: str) -> None:
    seat = Seat()
    seat.driven.hold(text, 1.0)
    seat.step(1.0)
    assert seat.speeds() == []
    assert sum(seat.io.drops.values()) == 1


@pytest.mark.parametrize("state", ["PLANNING", "NAVIGATING", "GRABBING", "CONFIRMING"])
def test_during_a_mission_it_does_nothing(state: str) -> None:
    seat = Seat(state)
    seat.driven.hold("1 0 0", 1.0)
    seat.step(1.0)
    assert seat.speeds() == []


def test_while_navigation_drives_to_where_somebody_clicked_it_does_nothing() -> None:
    seat = Seat()
    seat.bus.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id="page.1", status="navigating"))
    seat.driven.hold("1 0 0", 1.0)
    seat.step(1.0)
    assert seat.speeds() == []
    seat.bus.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id="page.1", status="arrived"))
    seat.step(1.1)
    assert [s.vx for s in seat.speeds()] == [SPEED]


def test_a_mission_that_begins_takes_over_and_the_brake_counts() -> None:
    seat = Seat()
    seat.driven.hold("1 0 0", 1.0)
    seat.step(1.0)
    seat.bus.send(topics.SIM_STATUS, m.SimStatus(state="stopped"))
    seat.step(1.1)
    seat.step(1.2)
    assert [s.vx for s in seat.speeds()] == [SPEED, 0.0]


def test_it_slows_before_an_obstacle_and_never_drives_into_it() -> None:
    distances = (3.0, ROOM + 0.1, ROOM + 0.02, ROOM - 0.05)
    speeds = [limit(scan({0: d}), 1.0, 0.0) for d in distances]
    assert speeds[0] >= SPEED and speeds == sorted(speeds, reverse=True) and speeds[-1] == 0.0
    seat = Seat(seen=scan({0: ROOM - 0.05}))
    seat.driven.hold("1 0 1", 1.0)
    seat.step(1.0)
    (speed,) = seat.speeds()
    assert (speed.vx, speed.omega) == (0.0, TURN), "turning away is possible"


def test_only_what_is_in_the_way_counts() -> None:
    behind, beside = scan({180: 0.42}), scan({90: 0.42, -90: 0.42})
    assert limit(behind, 1.0, 0.0) >= SPEED and limit(behind, -1.0, 0.0) < SPEED
    assert limit(beside, 1.0, 0.0) >= SPEED and limit(beside, 0.0, 1.0) < SPEED
    assert limit(scan({0: 0.5}, x=0.2), 1.0, 0.0) > limit(scan({0: 0.5}), 1.0, 0.0), "the lidar sits before the centre"


def test_the_robot_s_own_mast_and_corners_are_no_obstacles() -> None:
    assert limit(scan(dict.fromkeys(range(-180, 180, 3), 0.22)), 1.0, 0.0) >= SPEED
    assert limit(scan({45: 0.3}), 1.0, 0.0) >= SPEED


def test_a_lidar_that_has_fallen_silent_stops_it() -> None:
    seat = Seat()
    seat.driven.hold("1 0 0", 1.0)
    seat.step(1.0)
    seat.driven.hold("1 0 0", 1.0 + STALE + 0.1)
    seat.step(1.0 + STALE + 0.1, lidar=False)
    assert [s.vx for s in seat.speeds()] == [SPEED, 0.0]


def test_without_a_lidar_it_turns_only() -> None:
    assert limit(None, 1.0, 0.0) == 0.0
    assert limit(m.LaserScan(t=0.0, ranges=b"", angle_min=-pi), 1.0, 0.0) == 0.0, "what is no scan shows no free way"


def test_beside_the_simulation_it_drives_up_to_the_table_and_stands() -> None:
    """The lidar there has noise, gaps, and the robot's own mast in view."""
    robot = Simulation("minimal")
    io = MemoryIo(robot.bus, "dashboard", READS, (topics.CMD_VEL,), household=load_household("minimal"), lockstep=False)
    driven, moved = Teleoperation(io), []
    for tick in range(250):
        now = tick * 0.04
        io.begin(None, now)
        driven.hold("1 0 0", now)
        driven.step(now)
        robot.step(0.04)
        moved.append(robot.truth()["base"][0])
    near = limit(io.latest(topics.SCAN), 1.0, 0.0)
    assert moved[50] > 0.03 and abs(moved[-1] - moved[-50]) < 0.02, moved[::25]
    assert near < 0.1 and limit(io.latest(topics.SCAN), -1.0, 0.0) >= SPEED
