"""`tidybot places` and `rules` against a link that answers as the brain does."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from cli.errors import CliError
from cli.home import places
from cli.link import Link, Subscription
from cli.main import parser
from common import messages as m
from common import topics

PARTS = m.HomeParts(
    parts=[
        m.HomePart(name="room 1", kind="room"),
        m.HomePart(name="desk", kind="surface", room="room 1", given=True),
        m.HomePart(name="home", kind="place", room="room 1"),
    ]
)
EDITS = m.HouseholdEdits(rules=[m.TidyRule(things="mugs", to=["shelf"], kinds=["mug"])])


class FakeLink:
    """Keeps what was sent; everything is done but for names that mean something else."""

    ask, present = Link.ask, Link.present

    def __init__(self) -> None:
        self.sent: list[m.HouseholdEdit] = []

    def latest(self, topic: Any) -> Any:
        return {topics.HOUSEHOLD_PARTS.key: PARTS, topics.HOUSEHOLD_EDITS.key: EDITS}[topic.key]

    def send(self, topic: Any, edit: m.HouseholdEdit) -> None:
        self.sent.append(edit)


@pytest.fixture
def link(monkeypatch: pytest.MonkeyPatch) -> FakeLink:
    parser()  # imports every command, while `Subscription` is what it is
    fake = FakeLink()

    @contextmanager
    def linked(args: argparse.Namespace) -> Iterator[FakeLink]:
        yield fake

    class Answers:
        until = Subscription.until

        def __init__(self, link: FakeLink, topic: Any) -> None:
            self._others = [m.EditResult(goal_id="somebody else's", ok=True)]

        def next(self, timeout: float) -> m.EditResult:
            if self._others:
                return self._others.pop()
            edit = fake.sent[-1]
            if edit.name == "mug":
                return m.EditResult(goal_id=edit.id, ok=False, name="mug", code="NAME_TAKEN", detail="mug means a kind")
            return m.EditResult(goal_id=edit.id, ok=True, name=edit.name, part=edit.part or "shelf", kind="surface")

    monkeypatch.setattr(places, "linked", linked)
    monkeypatch.setattr("cli.link.Subscription", Answers)
    return fake


def run(*words: str) -> int:
    args = parser().parse_args(words)
    return int(args.run(args))


def test_places_are_listed(link: FakeLink, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("places") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split("  ")[0] for line in lines] == ["room 1", "desk", "home"]
    assert lines[1].endswith("named by you")


def test_what_the_robot_stands_before_is_named(link: FakeLink, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("places", "name", "writing", "desk", "--kind", "surface") == 0
    edit = link.sent[-1]
    assert (edit.do, edit.name, edit.part, edit.kind) == ("name", "writing desk", "", "surface")


def test_a_refusal_is_told_and_is_a_failure(link: FakeLink, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("places", "name", "mug") == 1
    assert "mug means a kind" in capsys.readouterr().out


def test_a_part_is_renamed_and_an_unknown_one_is_not(link: FakeLink, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("places", "rename", "room 1", "kitchen") == 0
    assert (link.sent[-1].part, link.sent[-1].name) == ("room 1", "kitchen")
    with pytest.raises(CliError, match="desk"):
        run("places", "rename", "dek", "table")


def test_names_and_rules_are_forgotten(link: FakeLink, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("places", "forget", "desk") == 0
    assert run("rules", "forget", "mugs") == 0
    assert [e.do for e in link.sent] == ["forget", "forget rule"]
    assert run("rules") == 0
    assert "mugs" in capsys.readouterr().out
