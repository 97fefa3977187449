"""The brain is killed in the middle of missions of the real services in lockstep; physics says what came of it."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest

from common import messages as m
from common import topics
from evaluation.stack import Stack

pytestmark = pytest.mark.long

ITEM = "red mug"
STATES = ("NAVIGATING", "GRABBING", "RETURNING", "RELEASING")
OPEN = ("WAITING", "LISTENING")


class Watched(Stack):
    """A robot whose brain can be killed; keeps what was asked of the arm and whether the object was ever let fall."""

    def __init__(self, directory: Path, pipeline: str) -> None:
        super().__init__(seed=1, settings=(f"brain.pipeline={pipeline}",), state_dir=directory)
        self.arm_goals = self.bus.tap(topics.MANIPULATION_GOAL)
        self.arm_says = self.bus.tap(topics.MANIPULATION_STATUS)
        self.kills: list[str] = []
        self.dropped = ""

    def restart_brain(self, down: float) -> None:
        self.kills.append(self.state().state)
        self.kill("brain")
        self.advance(down)
        self.start("brain")

    def until(self, *states: str, limit: float = 200.0) -> None:
        end = self.now + limit
        while self.state().state not in states:
            assert self.now < end, self.state()
            self.advance(0.1)
            self._look()

    def _look(self) -> None:
        """After a `done` grab and before the first release goal the object is in the hand."""
        done = {s.goal_id for s in self.said() if s.status == "done"}
        grabs = {g.id for g in self.asked() if g.goal == "grab"}
        if done & grabs and not any(g.goal != "grab" for g in self.asked()) and self.truth()["holding"] != ITEM:
            self.dropped = self.dropped or f"at {self.now:.1f} s"

    def asked(self) -> list[m.ManipulationGoal]:
        return [msgspec.json.decode(payload, type=m.ManipulationGoal) for payload in self.arm_goals]

    def said(self) -> list[m.ManipulationStatus]:
        return [msgspec.json.decode(payload, type=m.ManipulationStatus) for payload in self.arm_says]

    def missions(self) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = msgspec.json.decode(self.bus.get(topics.BRAIN_MISSIONS) or b"")
        return found

    def explain(self) -> str:
        return str(msgspec.json.decode(self.bus.get(topics.BRAIN_MISSIONS, b'{"id": "last"}') or b""))

    def ask(self) -> None:
        self.until(*OPEN)
        self.advance(1.0)
        self.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text=f"bring me the {ITEM}", confirmed=True))

    def check(self) -> None:
        truth = self.truth()
        rows = self.missions()
        assert [row["outcome"] for row in rows] == ["delivered"], self.explain()
        assert truth["objects"][ITEM]["on"] == self.scene.delivery and truth["holding"] is None
        assert not self.dropped, self.explain()
        # Each goal was carried out once: whatever its attempts, one grab and one release ended in `done`.
        goals = {g.id: g.goal for g in self.asked()}
        assert sorted(goals.values()) == ["grab", "release"], self.explain()
        assert len({(s.goal_id, s.attempt) for s in self.said() if s.status == "done"}) == 2


@pytest.fixture
def robot(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Watched]:
    opened = Watched(tmp_path, getattr(request, "param", "fetch"))
    try:
        yield opened
    finally:
        opened.close()


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.parametrize("robot", ["fetch", "vla"], indirect=True)
def test_a_brain_killed_in_every_state_brings_the_object_all_the_same(robot: Watched) -> None:
    robot.ask()
    for state, into in zip(STATES, (1.0, 3.0, 2.0, 2.0), strict=True):
        robot.until(state)
        robot.advance(into)
        robot.restart_brain(down=1.5)
    robot.until("COMPLETED")
    robot.restart_brain(down=0.5)
    # An ended mission is over: the robot listens, and what came of the mission is still known.
    robot.until(*OPEN)
    assert robot.state().last is not None and robot.state().last.outcome == "delivered"
    robot.advance(5.0)
    assert robot.state().state in OPEN and robot.kills == [*STATES, "COMPLETED"]
    robot.check()


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("state", STATES)
def test_whatever_was_done_while_the_brain_was_down_counts(robot: Watched, state: str) -> None:
    robot.ask()
    robot.until(state)
    robot.advance(0.3)
    robot.restart_brain(down=15.0)
    robot.until("COMPLETED")
    robot.check()


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_a_brain_that_dies_every_few_seconds_still_delivers(robot: Watched) -> None:
    robot.ask()
    robot.until("NAVIGATING")
    for _ in range(40):
        robot.advance(2.3)
        if robot.state().state == "COMPLETED" or not robot.state().mission_id:
            break
        robot.restart_brain(down=0.4)
    robot.until("COMPLETED", *OPEN)
    robot.check()
    assert len(robot.kills) > 10
