from collections import deque

import pytest

from common import messages as m
from common import topics
from common.bus.memory import MemoryBus, MemoryIo
from common.floor_plan import Place
from common.household import Household
from common.time.clock import ManualClock
from common.time.lockstep import Barrier, InProcess, period_of

SCENE = Household(name="empty", low=(-1, -1), high=(1, 1), home=Place(name="home", x=0, y=0))


class Relay:
    """Answers each navigation goal one status; notes at which tick it saw what."""

    HZ = 100

    def __init__(self, io: MemoryIo) -> None:
        self.io = io
        self.seen: list[tuple[int, str]] = []

    def step(self, now: float) -> None:
        for goal in self.io.take_all(topics.NAVIGATION_GOAL):
            self.seen.append((round(now * 100), goal.goal))


class Talker:
    HZ = 50

    def __init__(self, io: MemoryIo) -> None:
        self.io = io

    def step(self, now: float) -> None:
        self.io.publish(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=f"find {round(now * 100)}"))


class World:
    HZ = 100

    def __init__(self, io: MemoryIo) -> None:
        self.io = io
        self.seen: list[tuple[int, str]] = []

    def step(self, now: float) -> None:
        self.seen += [(round(now * 100), goal.goal) for goal in self.io.take_all(topics.NAVIGATION_GOAL)]
        self.io.publish(topics.GOAL_REACHED, m.GoalReached(reached=True, target_id=str(round(now * 100) + 1)))


def run(talker_first: bool) -> list[tuple[int, str]]:
    bus, clock = MemoryBus(), ManualClock()

    def io(name: str, reads: tuple, writes: tuple) -> MemoryIo:
        return MemoryIo(bus, name, reads, writes, household=SCENE, clock=clock)

    sim_io = io("sim", (topics.NAVIGATION_GOAL,), (topics.GOAL_REACHED,))
    sim = World(sim_io)
    world = InProcess(sim, sim_io, clock)
    relay_io = io("relay", (topics.NAVIGATION_GOAL, topics.GOAL_REACHED), ())
    talker_io = io("talker", (), (topics.NAVIGATION_GOAL,))
    relay, talker = Relay(relay_io), Talker(talker_io)
    for service, service_io in [(talker, talker_io), (relay, relay_io)][:: 1 if talker_first else -1]:
        world.add(service, service_io)
    for _ in range(6):
        world.advance()
    latest = relay_io.latest(topics.GOAL_REACHED)
    assert latest is not None
    assert latest.target_id == "6", "the state of a tick is visible to the steps of that tick"
    assert sim.seen == relay.seen, "the world is worked out while the others step: it hears no sooner than they"
    return relay.seen


def test_what_a_step_sees_does_not_depend_on_the_order_of_steps() -> None:
    assert run(True) == run(False) == [(3, "find 2"), (5, "find 4")]


def barrier(acks: list[tuple[str, int, int] | None], wait_for: tuple[str, ...] = ()) -> tuple[Barrier, list[str]]:
    waiting, reports = deque(acks), []
    return Barrier(lambda _: waiting.popleft() if waiting else None, wait_for, 0.05, reports.append), reports


def test_the_barrier_waits_only_for_those_due() -> None:
    gate, reports = barrier([("a", -1, 1), ("b", -1, 5), ("a", 1, 1), ("a", 2, 1)], ("a", "b"))
    gate.assemble()
    gate.wait(1, lambda _: False, lambda: None)
    gate.wait(2, lambda _: False, lambda: None)
    assert not reports
    assert gate.periods == {"a": 1, "b": 5}


def test_a_dead_participant_leaves_at_once_and_a_hung_one_after_the_limit() -> None:
    gate, reports = barrier([("a", -1, 1), ("b", -1, 1)], ("a", "b"))
    gate.assemble()
    gate.wait(1, lambda name: name == "a", lambda: None)
    assert gate.periods == {}
    assert reports == [
        "a left the lockstep at tick 1: its process is gone",
        "b left the lockstep: no answer to tick 1 in 0 s",
    ]


def test_a_world_that_goes_on_does_so_without_those_that_never_join() -> None:
    gate, reports = barrier([("a", -1, 1)], ("a", "ghost"))
    gate.assemble(going_on=True)
    assert reports == ["lockstep goes on without ghost"]


def test_a_new_world_waits_for_a_participant_that_takes_longer_than_the_limit() -> None:
    reports: list[str] = []

    def next_ack(timeout: float) -> tuple[str, int, int] | None:
        return ("slow", -1, 5) if len(reports) == 2 else None

    gate = Barrier(next_ack, ("slow",), 0.0, reports.append)
    gate.assemble()
    assert gate.periods == {"slow": 5}
    assert reports == ["lockstep waits for slow"] * 2


def test_a_process_that_was_started_again_takes_part_again() -> None:
    gate, reports = barrier([("a", -1, 1), ("a", 1, 1)], ("a",))
    gate.assemble()
    gate.wait(1, lambda _: False, lambda: None)
    gate.wait(2, lambda _: True, lambda: None)
    assert gate.periods == {} and len(reports) == 1
    gate, _ = barrier([("a", 7, 5)])
    gate.wait(7, lambda _: False, lambda: None)
    gate.drain()
    assert gate.periods == {"a": 5}


def test_ticks_of_an_earlier_simulation_do_not_count_as_done() -> None:
    gate, reports = barrier([("a", 9000, 1), ("a", 9000, 1)], ("a",))
    gate.assemble()
    assert gate.periods == {"a": 1} and not reports
    gate.drain()
    gate.wait(1, lambda _: False, lambda: None)
    assert reports == ["a left the lockstep: no answer to tick 1 in 0 s"]


@pytest.mark.parametrize("hz", [0.3, 30, 1000])
def test_a_rate_must_divide_the_tick_rate(hz: float) -> None:
    with pytest.raises(ValueError, match="does not divide"):
        period_of(hz)
