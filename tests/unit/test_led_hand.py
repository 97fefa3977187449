"""The hand led from the page: as long as somebody holds on, slowly, within limits, and the stop comes first."""

from typing import Any

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from services.dashboard import teleoperation as page
from services.dashboard.teleoperation import HandTeleoperation
from services.manipulation.execution.led_hand import SILENCE, SPEED
from tests.unit.led_arm import LedArm

READS = (topics.BRAIN_STATE, topics.SIM_STATUS, topics.NAVIGATION_FEEDBACK)
FORWARD = "1 0 0 0 0 0"


class Seat:
    """The page's side on a bus that keeps what is sent."""

    def __init__(self, state: Any = "WAITING") -> None:
        self.bus = MemoryBus()
        home = load_household("minimal")
        self.io = MemoryIo(self.bus, "dashboard", READS, (topics.HAND_VELOCITY,), household=home, lockstep=False)
        self.bus.send(topics.BRAIN_STATE, m.BrainState(state=state))
        self.led, self._tap = HandTeleoperation(self.io), self.bus.tap(topics.HAND_VELOCITY)

    def step(self, now: float) -> None:
        self.io.begin(None, now)
        self.led.step(now)

    def sent(self) -> list[m.HandVelocity]:
        return [codec.decode(topics.HAND_VELOCITY, payload) for payload in self._tap]


def test_the_page_sends_while_somebody_holds_on_and_one_stop_after() -> None:
    seat = Seat()
    seat.step(0.0)
    seat.led.hold("1 0 -0.5 0 0 1", 1.0)
    for now in (1.0, 1.0 + page.HOLD - 0.01, 1.0 + page.HOLD, 2.0, 9.0):
        seat.step(now)
    moving = m.HandVelocity(linear=(page.HAND_SPEED, 0.0, -page.HAND_SPEED / 2), angular=(0.0, 0.0, page.HAND_TURN))
    assert seat.sent() == [moving, moving, m.HandVelocity()]


def test_fingers_are_told_once() -> None:
    seat = Seat()
    seat.led.hold("0 0 0 0 0 0 close", 1.0)
    seat.step(1.0)
    seat.step(1.1)
    assert [s.fingers for s in seat.sent()] == ["close", ""]


@pytest.mark.parametrize(
    "text", ["", "1 0 0", "a b c d e f", "nan 0 0 0 0 0", "2 0 0 0 0 0", "0 0 0 0 0 0 grab", "away"]
)
def test_what_is_no_wish_moves_nothing_and_is_counted(text: str) -> None:
    seat = Seat()
    seat.led.hold(text, 1.0)
    seat.step(1.0)
    assert seat.sent() == [] and sum(seat.io.drops.values()) == 1


def test_not_during_a_mission_a_drive_or_with_the_brake_on() -> None:
    for topic, message in (
        (topics.BRAIN_STATE, m.BrainState(state="GRABBING", mission_id="m1", command="x")),
        (topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id="p", status="navigating")),
        (topics.SIM_STATUS, m.SimStatus(state="stopped")),
    ):
        seat = Seat()
        seat.bus.send(topic, message)  # type: ignore[arg-type]
        seat.led.hold(FORWARD, 1.0)
        seat.step(1.0)
        assert seat.sent() == []


# --- manipulation's side
class Led(LedArm):
    """Somebody holds on to `wish` while it is not None."""

    wish: m.HandVelocity | None = None

    def feed(self) -> None:
        super().feed()
        if self.wish is not None and self.tick % 4 == 0:
            self.send(topics.HAND_VELOCITY, self.wish)


def led(**wish: Any) -> Led:
    arm = Led()
    arm.step(1.5)
    arm.wish = m.HandVelocity(**wish)
    arm.step(1.0)  # the first word has the model made
    return arm


def test_the_hand_goes_where_it_is_led_and_no_faster_than_it_may() -> None:
    arm = led(linear=(0.05, 0.0, 0.05))
    before = arm.hand()
    arm.step(1.0)
    moved = arm.hand() - before
    assert moved[0] == pytest.approx(0.05, abs=0.02) and moved[2] == pytest.approx(0.05, abs=0.02)
    assert abs(moved[1]) < 0.01
    arm.wish = m.HandVelocity(linear=(0.0, 5.0, 0.0))
    arm.step(1.0)
    before = arm.hand()
    arm.step(0.5)
    assert 0.2 * SPEED < float(np.linalg.norm(arm.hand() - before)) <= 0.5 * SPEED * 1.05


def test_it_stops_when_nobody_holds_on_and_the_stream_ends() -> None:
    arm = led(linear=(0.05, 0.0, 0.05))
    arm.wish = None
    arm.step(SILENCE + 0.5)
    at, sent = arm.hand(), arm.count(topics.ARM_COMMAND)
    arm.step(1.0)
    assert np.allclose(arm.hand(), at) and arm.count(topics.ARM_COMMAND) == sent


def test_after_a_stop_it_has_to_be_let_go_of_first() -> None:
    arm = led(linear=(0.05, 0.0, 0.05))
    arm.bus.put(topics.ROBOT_STOP, b"enough")
    arm.step(0.04)
    sent = arm.count(topics.ARM_COMMAND)
    arm.step(1.0)
    assert arm.count(topics.ARM_COMMAND) == sent, "still held"
    wish, arm.wish = arm.wish, None
    arm.step(0.5)
    arm.wish = wish
    arm.step(0.5)
    assert arm.count(topics.ARM_COMMAND) > sent


def test_what_the_hand_meets_is_not_pressed_but_left() -> None:
    arm = led(linear=(0.05, 0.0, 0.0))
    arm.press = np.array([-45.0, 0.0, 0.0])
    arm.step(0.1)
    at = arm.hand()
    arm.step(1.0)
    assert float(np.linalg.norm(arm.hand() - at)) < 0.01
    arm.press, arm.wish = np.zeros(3), m.HandVelocity(linear=(-0.05, 0.0, 0.05))
    arm.step(1.0)
    assert arm.hand()[2] > at[2] + 0.02


def test_a_goal_has_the_arm_before_a_person() -> None:
    arm = led(linear=(0.05, 0.0, 0.05))
    arm.send(topics.MANIPULATION_GOAL, m.ManipulationGoal(goal="release", id="a.1"))
    arm.step(0.04)
    assert arm.status().goal_id == "a.1"
    arm.send(topics.BRAIN_STATE, m.BrainState(state="GRABBING", mission_id="m1", command="x"))
    arm.step(4.0)
    sent = arm.count(topics.ARM_COMMAND)
    arm.step(1.0)
    assert arm.count(topics.ARM_COMMAND) == sent


def test_a_mission_that_begins_has_the_arm_folded_first() -> None:
    arm = led(linear=(0.05, 0.0, 0.05))
    arm.step(2.0)
    arm.wish = None
    arm.step(0.5)
    assert np.abs(arm.q - arm.model.home).max() > 0.1
    arm.send(topics.BRAIN_STATE, m.BrainState(state="PLANNING", mission_id="m1", command="x"))
    arm.step(8.0)
    assert np.abs(arm.q - arm.model.home).max() < 0.02


def test_home_leads_back_and_fingers_close() -> None:
    arm = led(linear=(0.05, 0.0, 0.05))
    arm.step(2.0)
    assert np.abs(arm.q - arm.model.home).max() > 0.1
    arm.wish = m.HandVelocity(home=True)
    arm.step(6.0)
    assert np.abs(arm.q - arm.model.home).max() < 0.02
    arm.wish = m.HandVelocity(fingers="close")
    arm.step(0.2)
    assert arm.sent(topics.GRIPPER_COMMAND)[-1].position == 1.0
