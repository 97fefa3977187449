"""The account of a long day, and its clock."""

import contextlib
from types import SimpleNamespace
from typing import Any

import pytest

from bench.day.__main__ import Day
from bench.day.account import DISK, Account
from common import messages as m


def heard(*times: float | None) -> Any:
    """A link on which `joint_states` answer with these robot times one after the other, None: nobody answers."""
    left = list(times)

    def latest(topic: object) -> m.JointStates | None:
        t = left.pop(0)
        return None if t is None else m.JointStates(t=t, name=[], position=[], velocity=[], effort=[])

    return SimpleNamespace(latest=latest)


@pytest.fixture
def day(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A day whose `link` the test sets."""
    monkeypatch.setattr("bench.day.__main__.open_session", lambda *_: contextlib.nullcontext())
    return Day(SimpleNamespace(connect="", namespace=""), None, 0)  # type: ignore[arg-type]


def test_robot_time_stays_where_it_was_while_the_simulation_does_not_answer(day: Any) -> None:
    day.link = heard(None, 61.0, None, 62.5)
    assert [day.now for _ in range(4)] == [0.0, 61.0, 61.0, 62.5]


def test_memory_is_compared_with_a_fifth_into_the_day() -> None:
    samples = [{"brain": 400.0}, *({"brain": 100.0 + n} for n in range(9))]
    account = Account(memory=samples, disk=[1.0, 2.0])
    assert account.grown() == {"brain": (101.0, 108.0)} and account.excess() == []
    account.memory[-1] = {"brain": 170.0}
    assert account.excess() == ["brain: 101 -> 170 MB"]
    account.disk.append(DISK + 1.0)
    assert len(account.excess()) == 2


def test_a_process_that_is_being_restarted_at_the_end_counts_as_it_was_last_seen() -> None:
    samples = [{"sim": 80.0, "brain": 100.0}] * 6 + [{"sim": 80.0, "brain": 300.0}, {"sim": 80.0}]
    assert Account(memory=samples).excess() == ["brain: 100 -> 300 MB"]
    samples = [{"sim": 80.0}] * 3 + [{"sim": 80.0, "brain": 90.0}] * 3
    assert Account(memory=samples).grown()["brain"] == (90.0, 90.0)
    assert "brain" in Account(memory=samples, outcomes={"delivered": 3}).lines(3600.0)[-1]


def test_a_day_that_was_too_short_for_its_missions_says_so() -> None:
    account = Account(planned=5, outcomes={"delivered": 2, "failed": 1})
    assert account.left_out() == ["2 of 5 missions had no time"]
    account.outcomes["timeout"] = 2
    assert account.left_out() == []


def test_a_question_is_answered_once_and_by_what_is_shown(day: Any) -> None:
    sent: list[str] = []
    speech = m.SpeechStatus(state="speaking", goal_id="q.1")
    objects = {"red box": {"position": [1.0, 2.0, 0.8]}, "red can": {"position": [3.0, 2.0, 0.8]}}
    day.link = SimpleNamespace(
        latest=lambda topic: speech,
        query=lambda topic: {"objects": objects},
        send=lambda topic, said: sent.append(said.text),
    )
    asked = m.BrainState(state="CONFIRMING", offered=[(1.02, 2.0, 0.8)])
    day.answer("red box", asked)
    assert sent == [], "the robot is still speaking"
    for question, thing, about in (("q.2", "red box", True), ("q.3", "red can", True), ("q.4", "red can", False)):
        speech = m.SpeechStatus(state="listening", goal_id=question)
        for _ in range(3):
            day.answer(thing, asked if about else m.BrainState(state="CONFIRMING"))
    assert sent == ["yes", "no", "the red can"]
