"""Services as objects of one process: killed, hung, started again, and a clock that jumps."""

import weakref
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from common import messages as m
from common import topics
from evaluation.case import TimedFault
from evaluation.faults.messages import Rule, faulty
from evaluation.runner import FaultScheduler
from evaluation.stack import Stack, paced_services

OTHERS = tuple(n for n in paced_services() if n != "navigation")


@pytest.fixture
def stack() -> Iterator[Stack]:
    """The small flat with navigation alone."""
    opened = Stack("minimal", without=OTHERS)
    opened.advance(0.3)
    yield opened
    opened.close()


def status(stack: Stack) -> m.NavigationStatus:
    return msgspec.json.decode(stack.bus.last[topics.NAVIGATION_STATUS.key], type=m.NavigationStatus)


def go(stack: Stack, goal_id: str) -> None:
    stack.bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal="goto corner", id=goal_id))


def test_a_killed_service_forgets_and_its_successor_starts_afresh(stack: Stack) -> None:
    before = stack.members["navigation"][1].epoch
    go(stack, "a.1")
    stack.advance(0.2)
    assert status(stack).status == "navigating"
    stack.kill("navigation")
    go(stack, "a.2")
    stack.advance(0.2)
    assert stack.bus.ios["sim"].peer("navigation") is None
    assert status(stack).goal_id == "a.1"
    stack.start("navigation")
    stack.advance(0.2)
    assert stack.members["navigation"][1].epoch != before
    assert status(stack).status == "idle", "a goal from before its start is not acted on"
    ids = {stack.members["navigation"][1].new_id("n") for _ in range(3)}
    assert not ids & {f"n-0-{k}" for k in range(1, 1000)}


def test_nothing_of_a_killed_brain_stays_open(tmp_path: Path) -> None:
    opened = Stack("minimal", without=tuple(n for n in paced_services() if n != "brain"), state_dir=tmp_path)
    try:
        opened.advance(0.1)
        journal = weakref.ref(opened.members["brain"][0].__dict__["_journal"])
        assert journal() is not None and opened.bus.get(topics.BRAIN_MISSIONS) is not None
        opened.kill("brain")
        assert journal() is None, "its file would stay locked"
        assert opened.bus.get(topics.BRAIN_MISSIONS) is None
    finally:
        opened.close()


def test_a_hung_service_catches_up(stack: Stack) -> None:
    stack.hang("navigation", 1.0)
    go(stack, "b.1")
    stack.advance(0.9)
    assert status(stack).status == "idle"
    stack.advance(0.3)
    assert (status(stack).goal_id, status(stack).status) == ("b.1", "navigating")


def test_a_jump_of_the_clock_moves_time_and_not_the_world(stack: Stack) -> None:
    stack.advance(0.2)
    now, base = stack.now, stack.truth()["base"]
    stack.jump(5.0)
    stack.tick()
    assert stack.now == pytest.approx(now + 5.01)
    assert stack.truth()["base"] == pytest.approx(base, abs=1e-3)


def test_strikes_come_in_their_state_and_the_service_comes_back(stack: Stack) -> None:
    scheduler = FaultScheduler(stack, (TimedFault("navigation", "GRABBING", back_after=0.5),))
    for state in ("NAVIGATING", "GRABBING", "GRABBING"):
        stack.bus.send(topics.BRAIN_STATE, m.BrainState(state=state))  # type: ignore[arg-type]
        scheduler.step()
        assert ("navigation" in stack.members) == (state == "NAVIGATING")
        stack.advance(0.1)
    stack.advance(0.5)
    scheduler.step()
    assert "navigation" in stack.members and stack.starts["navigation"] == 2


def test_a_class_can_be_swapped() -> None:
    rule = Rule(service="navigation", key=topics.NAVIGATION_STATUS.key, kind="edit", fields={"detail": "altered"})
    opened = Stack("minimal", without=OTHERS, swaps={"navigation": lambda kind: faulty(kind, (rule,))})
    assert status(opened).detail == "altered"
    opened.close()
