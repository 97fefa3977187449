"""What `tidybot missions` and `tidybot explain` print of a record."""

import contextlib
from typing import Any

import pytest

from cli import main
from cli.link import Subscription
from cli.missions.explain import WIDTH, told
from cli.missions.journal import listed
from common import messages as m
from common import topics
from common.topic import Topic

RECORD: dict[str, Any] = {
    "id": "mission-1", "command": "bring me the red mug", "started": 10.0, "outcome": "failed",
    "reason": "NO_WAY: blocked", "ended": 75.5, "steps": 4, "date": 1.8e9,
    "entries": [
        {"t": 10.0, "state": "LISTENING", "cause": "heard: bring me the red mug", "evidence": "confidence 0.93",
         "kind": "heard"},
        {"t": 10.1, "state": "NAVIGATING", "cause": "find red mug", "evidence": "", "kind": "state"},
        {"t": 75.0, "state": "NAVIGATING", "cause": "navigating", "evidence": "blocked " * 40, "kind": "failed"},
        {"t": 75.5, "state": "ERROR", "cause": "ERROR", "evidence": "NO_WAY", "kind": "state"},
    ],
}  # fmt: skip


def test_a_timeline_counts_from_the_start_and_names_each_state_once() -> None:
    lines = told(RECORD).splitlines()
    assert lines[0].startswith("mission mission-1: 'bring me the red mug', begun 20")
    assert lines[2] == "     0.0 s  LISTENING    heard: bring me the red mug - confidence 0.93"
    assert lines[3] == "     0.1 s  NAVIGATING   find red mug"
    assert lines[4].startswith("    65.0 s               FAILED: navigating - blocked")
    assert all(len(line) <= WIDTH for line in lines)
    assert lines[-1] == "failed after 65.5 s, 4 goals: NO_WAY: blocked"
    assert [line.count("NAVIGATING") for line in lines[2:]].count(1) == 1
    # A cause that only names the state is not said again.
    assert any(line.endswith("ERROR        NO_WAY") for line in lines)


def test_a_mission_under_way_has_no_end_yet() -> None:
    record = {**RECORD, "outcome": None, "reason": "", "ended": 0.0, "entries": []}
    assert told(record).splitlines()[-1] == "under way"
    assert "under way" in listed([record]) and " s " not in listed([record]).partition("under way")[2].strip()[:3]


def test_missions_are_one_line_each() -> None:
    done = {**RECORD, "id": "mission-22", "outcome": "delivered", "reason": ""}
    first, second = listed([RECORD, done]).splitlines()
    assert first.index("failed") == second.index("delivered")
    assert "65.5 s" in first and first.endswith("bring me the red mug  (NO_WAY: blocked)")
    assert listed([]) == ""


class AtWork:
    """A link to a robot that is bringing the mug; what it sends after a command is `then`, by topic."""

    def __init__(self, then: dict[str, list[m.Message]]) -> None:
        self.then, self.now = then, {topics.BRAIN_STATE.key: [AT_WORK]}

    def send(self, topic: Topic[Any], message: m.Message) -> None:
        self.now = {key: list(messages) for key, messages in self.then.items()}

    def next(self, topic: Topic[Any]) -> m.Message | None:
        waiting = self.now.get(topic.key) or [None]
        return waiting.pop(0)


AT_WORK = m.BrainState(state="NAVIGATING", mission_id="m1", command="bring me the mug")
OFF = m.MissionOutcome(id="m1", command="bring me the mug", outcome="cancelled")
NEW = m.BrainState(state="PLANNING", mission_id="m2", command="the blue one", last=OFF)
SAID = m.SpeechGoal(goal="say You asked me to bring you the mug.")


@pytest.mark.parametrize(
    ("then", "printed"),
    [
        ({"brain/speech_goal": [SAID]}, "robot: You asked me to bring you the mug."),
        ({"brain/state": [m.BrainState(state="WAITING", last=OFF)]}, "cancelled: bring me the mug"),
        ({"brain/speech_goal": [SAID], "brain/state": [NEW]}, "mission m2"),
    ],
)
def test_what_is_said_to_a_robot_at_work_is_answered(
    then: dict[str, list[m.Message]],
    printed: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    robot = AtWork(then)
    monkeypatch.setattr("cli.missions.say.linked", lambda args: contextlib.nullcontext(robot))
    monkeypatch.setattr(Subscription, "__init__", lambda self, link, topic: setattr(self, "topic", topic))
    monkeypatch.setattr(Subscription, "next", lambda self, timeout: robot.next(self.topic))
    assert main.main(["say", "what", "are", "you", "doing"]) == 0
    assert printed in capsys.readouterr().out.splitlines()
