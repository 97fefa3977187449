"""Robots that share a flat: who goes first, what the other one does, and what they tell each other."""

import msgspec
import numpy as np
import pytest

from bench.encounters.meetings import KINDS, Meeting, corridor
from bench.encounters.pair import Pair
from common import messages as m
from common import topics
from common.bus import codec
from common.household import load_household
from common.messages import DriveState
from services.navigation.others.motion import Other, Way, closes_in, escapes, passes
from services.navigation.others.right_of_way import goes_first
from tests.unit.navigation_flat import Flat

RADIUS = 0.29


def straight(start: tuple[float, float], end: tuple[float, float]) -> Way:
    return Way(np.linspace(start, end, 60))


# --- who goes first
@pytest.mark.parametrize(
    ("me", "state", "stuck", "other", "theirs", "they_stuck", "first"),
    [
        ("bert", "driving", False, "anna", "driving", False, True),
        ("anna", "driving", False, "bert", "driving", False, False),
        ("anna", "driving", False, "bert", "driving", True, True),
        ("bert", "driving", True, "anna", "driving", False, False),
        ("bert", "driving", True, "anna", "driving", True, True),
        ("anna", "free", False, "bert", "driving", False, True),
        ("anna", "fixed", False, "bert", "driving", True, False),
        ("bert", "driving", False, "anna", "free", False, False),
        ("bert", "driving", False, "anna", "fixed", False, False),
    ],
)
def test_who_goes_first(
    me: str, state: DriveState, stuck: bool, other: str, theirs: DriveState, they_stuck: bool, first: bool
) -> None:
    assert goes_first(me, state, stuck, other, theirs, they_stuck) is first


@pytest.mark.parametrize("stuck", [False, True])
@pytest.mark.parametrize("they_stuck", [False, True])
def test_of_two_that_drive_exactly_one_goes_first(stuck: bool, they_stuck: bool) -> None:
    one = goes_first("anna", "driving", stuck, "bert", "driving", they_stuck)
    assert one is not goes_first("bert", "driving", they_stuck, "anna", "driving", stuck)


# --- prediction
def test_two_ways_that_cross_at_different_times_pass() -> None:
    mine = straight((0.0, 0.0), (3.0, 0.0))
    assert not passes(mine, RADIUS, Other("o", straight((1.5, -1.5), (1.5, 1.5)), RADIUS))
    assert passes(mine, RADIUS, Other("o", straight((1.5, -9.0), (1.5, 1.5)), RADIUS))
    assert passes(mine, RADIUS, Other("o", straight((1.5, -1.5), (1.5, 1.5)), RADIUS, stalled=True))


def test_a_robot_that_is_near_already_may_move_away_and_not_nearer() -> None:
    other = Other("o", straight((0.62, 0.0), (0.62, 0.0)), RADIUS)
    assert passes(straight((0.0, 0.0), (-2.0, 0.0)), RADIUS, other)
    assert not passes(straight((0.0, 0.0), (0.3, 0.0)), RADIUS, other)


def test_there_is_no_way_aside_through_the_other_robot() -> None:
    coming = Other("o", straight((1.2, 0.0), (-3.0, 0.0)), RADIUS)
    assert escapes(straight((0.0, 0.0), (-2.0, 0.0)), RADIUS, coming)
    assert not escapes(straight((0.0, 0.0), (2.5, 0.0)), RADIUS, coming)


def test_who_goes_first_waits_for_one_that_is_not_out_of_its_way_yet() -> None:
    mine = straight((0.0, 0.0), (3.0, 0.0))
    assert closes_in(mine, RADIUS, Other("o", straight((1.0, 0.0), (1.0, 0.4)), RADIUS))
    assert not closes_in(mine, RADIUS, Other("o", straight((1.9, 0.6), (1.9, 2.0)), RADIUS))


# --- two robots in one flat
def run(pair: Pair, listen_to: int) -> tuple[float, list[m.DriveIntent]]:
    """Drive both to their goals: the least distance [m] between them, and what one has told of its way."""
    payloads = pair.robots[listen_to].bus.tap(topics.DRIVE_INTENT)
    outcome = pair.run()
    assert outcome.arrived, outcome
    return outcome.nearest, [codec.decode(topics.DRIVE_INTENT, payload) for payload in payloads]


def test_two_that_meet_in_a_corridor_both_arrive() -> None:
    home = corridor()
    starts, goals = ((3.5, 2.0, 0.0), (9.5, 2.0, 3.1)), ((11.0, 2.0, 0.0), (2.0, 2.0, 3.1))
    nearest, said = run(Pair(Meeting(home, starts, goals)), listen_to=1)
    assert nearest > 0.03
    assert any(told.gives_way_to == ["anna"] for told in said)


def test_one_with_nothing_to_do_makes_way_and_one_at_work_does_not() -> None:
    flat = load_household("apartment")
    meeting = Meeting(flat, ((2.5, -0.75, 0.0), (1.2, -0.75, 0.0)), (None, (3.8, -0.9, 0.0)))
    nearest, _ = run(Pair(meeting), listen_to=1)
    assert nearest > 0.03
    working = Pair(meeting)
    state = m.BrainState(state="GRABBING", mission_id="m1", command="grab")
    working.robots[0].bus.send(topics.BRAIN_STATE, state)
    before = working.robots[0].true
    working.advance(6.0)
    assert working.robots[0].true == pytest.approx(before, abs=0.002)
    assert working.gap > 0.03


def test_robots_of_other_flats_and_what_is_no_place_are_passed_over() -> None:
    for told in (
        m.DriveIntent(t=0.0, flat="another", x=1.0, y=0.0, theta=0.0, radius=0.3),
        m.DriveIntent(t=0.0, flat="home", x=float("nan"), y=0.0, theta=0.0, radius=0.3),
    ):
        flat = Flat(flat="home")
        flat.io.robot = "bert"
        flat.bus.neighbours = {"anna": Flat().bus}
        flat.bus.neighbours["anna"].last[topics.DRIVE_INTENT.key] = msgspec.json.encode(told)
        flat.step(0.5)
        assert not flat.service.neighbours.circles


def test_a_robot_that_has_fallen_silent_stays_what_stands_there() -> None:
    flat, gone = Flat(flat="home"), m.DriveIntent(t=0.0, flat="home", x=3.0, y=3.0, theta=0.0, radius=0.3)
    flat.io.robot = "bert"
    flat.bus.neighbours = {"anna": Flat().bus}
    flat.bus.neighbours["anna"].last[topics.DRIVE_INTENT.key] = msgspec.json.encode(gone)
    flat.step(0.5)
    assert flat.service.neighbours.circles
    for _ in range(8):
        flat.step(0.5)
    heard = []
    for _ in range(30):
        flat.step(0.1)
        heard += flat.service.neighbours.circles
    assert not heard, "its last message is still there to be read"


def test_a_robot_without_a_name_tells_nobody() -> None:
    flat = Flat()
    flat.step(1.0)
    assert not flat.sent(topics.DRIVE_INTENT)


def test_every_kind_of_meeting_can_be_drawn() -> None:
    for draw in KINDS.values():
        meeting = draw(np.random.default_rng(3))
        assert meeting.goals[1] is not None


def test_one_that_is_braked_while_it_should_make_way_is_planned_round() -> None:
    """Somebody has pressed its stop: it says that it stays, instead of having the other one wait for it."""
    meeting = Meeting(load_household("apartment"), ((1.3, -0.75, 0.0), (0.2, -0.75, 0.0)), (None, (2.0, -1.5, 0.0)))
    pair = Pair(meeting)
    pair.robots[0].bus.send(topics.ROBOT_STOP, m.RobotStop(reason="test", source="test"))
    _, intents = run(pair, listen_to=0)
    said = [told.state for told in intents]
    assert said.index("free") < said.index("fixed")
