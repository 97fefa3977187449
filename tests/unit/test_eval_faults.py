"""Messages mistreated at a service's door, by rule and by seed."""

from typing import Any

import pytest

from common import messages as m
from common import topics
from common.bus.port import Io
from common.floor_plan import Place
from common.household import Household
from evaluation.faults.messages import Kind, Rule, faulty
from evaluation.faults.reports import FaultReport, ignore
from tests.node import Node

SCENE = Household(name="empty", low=(-1, -1), high=(1, 1), home=Place(name="home", x=0, y=0))
STATUS = topics.NAVIGATION_STATUS


class Counter:
    """Says its step number, and an even or odd code, each step."""

    NAME, HZ = "navigation", 10
    READS, WRITES = (), (STATUS,)

    def __init__(self, config: None, io: Io) -> None:
        self._io, self._n = io, 0

    def step(self, now: float) -> None:
        self._n += 1
        code = "odd" if self._n % 2 else "even"
        self._io.publish(STATUS, m.NavigationStatus(status="navigating", detail=str(self._n), code=code))


def said(steps: int, *rules: Rule, seed: int = 0, told: list[FaultReport] | None = None) -> list[str]:
    """The details that got through, step numbers at 10 Hz."""
    node = Node(faulty(Counter, rules, ignore if told is None else told.append), None, SCENE, seed=seed)
    for _ in range(steps):
        node.step()
    return [status.detail for status in node.sent(STATUS)]


def rule(kind: Kind, **more: Any) -> Rule:
    return Rule(service="navigation", key=STATUS.key, kind=kind, **more)


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("drop", ["1", "3", "4", "5"]),
        ("duplicate", ["1", "2", "2", "3", "4", "5"]),
        ("reorder", ["1", "3", "2", "4", "5"]),
        ("delay", ["1", "3", "4", "2", "5"]),
    ],
)
def test_the_second_message_is_hit(kind: Kind, expected: list[str]) -> None:
    assert said(5, rule(kind, skip=1, seconds=0.25)) == expected


def test_an_edit_replaces_fields_and_leaves_the_rest() -> None:
    assert said(3, rule("edit", skip=1, fields={"detail": "nonsense"})) == ["1", "nonsense", "3"]


def test_only_what_takes_effect_is_reported() -> None:
    """An edit that says what was said anyway waits for a message that it changes."""
    told: list[FaultReport] = []
    assert said(3, rule("edit", fields={"code": "even"}), told=told) == ["1", "2", "3"]
    assert [(s.t, s.fault) for s in told] == [(0.1, "edit")]
    said(3, rule("edit", fields={"code": "odd"}), told=told)
    assert [s.t for s in told] == [0.1, 0.2]


def test_an_edit_that_makes_no_message_is_an_error_of_the_rule() -> None:
    with pytest.raises(ValueError, match="status"):
        said(1, rule("edit", fields={"status": "flying"}))


def test_matching_counting_and_times() -> None:
    assert said(6, rule("drop", match={"code": "even"}, count=2)) == ["1", "3", "5", "6"]
    assert said(6, rule("drop", count=99, start=0.25, until=0.45)) == ["1", "2", "5", "6"]


def test_chance_is_decided_by_the_seed() -> None:
    half = rule("drop", count=99, chance=0.5)
    assert said(40, half, seed=1) == said(40, half, seed=1) != said(40, half, seed=2)
    assert 5 < len(said(40, half, seed=1)) < 35


def test_rules_for_others_leave_the_class_alone() -> None:
    assert faulty(Counter, (Rule(service="brain", key=STATUS.key, kind="drop"),)) is Counter
