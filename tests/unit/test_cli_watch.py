"""What `tidybot watch` draws, and what its keys do."""

from typing import Any

import msgspec
import pytest
from rich.console import Console

from cli import watch
from cli.missions.say import status_record
from common import messages as m
from common import topics
from common.topic import Topic


class Silent:
    """A link on which nothing is sent; keeps what the command line puts."""

    def __init__(self) -> None:
        self.sent: list[tuple[str, m.Message]] = []

    def send(self, topic: Topic[Any], message: m.Message) -> None:
        self.sent.append((topic.key, message))


@pytest.fixture
def picture(monkeypatch: pytest.MonkeyPatch) -> watch.Picture:
    monkeypatch.setattr(watch, "Subscription", lambda link, topic: None)
    return watch.Picture(Silent())  # type: ignore[arg-type]


def text(picture: watch.Picture, width: int = 100, tree_alone: bool = False) -> str:
    console = Console(width=width, record=True, file=None, force_terminal=False)
    with console.capture() as taken:
        console.print(watch.drawn(picture, tree_alone), height=None if tree_alone else 44)
    return taken.get()


def node(name: str, status: str, *children: m.TreeNode, detail: str = "") -> m.TreeNode:
    return m.TreeNode(name=name, type="Sequence", status=status, detail=detail, children=list(children))


def test_an_empty_picture_says_what_is_missing(picture: watch.Picture) -> None:
    shown = text(picture)
    assert "the brain has not been heard" in shown
    assert "no tree yet" in shown


def test_a_mission_on_one_screen(picture: watch.Picture) -> None:
    last = m.MissionOutcome(id="m-0", command="fetch the apple", outcome="failed", reason="it is not there")
    picture.now = {
        topics.BRAIN_STATE.key: m.BrainState(
            state="NAVIGATING", t=21.0, started=10.0, mission_id="m-1", command="bring me the mug", step="find",
            pipeline="vla", last=last,
        ),
        topics.SIM_STATUS.key: m.SimStatus(state="stopped"),
        topics.ACTION_PLAN.key: m.ActionPlan(request_id="r", steps=[m.PlanStep(action="grasp", object="red mug")]),
        topics.NAVIGATION_FEEDBACK.key: m.NavigationFeedback(
            goal_id="m.1", status="failed", code="BLOCKED", detail="a chair"
        ),
        topics.BRAIN_TREE.key: m.TreeSnapshot(
            t=1.0,
            root=node(
                "root", "RUNNING",
                node("wait", "SUCCESS", node("inner", "SUCCESS", node("folded", "SUCCESS"))),
                node("do", "RUNNING", node("drive", "RUNNING", node("leaf", "RUNNING", detail="2 m left"))),
            ),
        ),
    }  # fmt: skip
    health = {"t": 0.0, "uptime": 5.0, "hz": 20.0, "rss_mb": 61.0, "pid": 1}
    picture.health.take(m.Health(name="sim", epoch="a", drops=7, last_error="too slow", **health))  # type: ignore[arg-type]
    picture.alive = {"brain"}
    for message in (
        m.SpeechGoal(goal="say On my way"),
        m.SpeechGoal(goal="listen"),
        m.SpeechResult(text="bring me the mug"),
        m.VoiceCommand(text="bring me the mug"),
        m.SpeechResult(text="ERROR", code="TIMEOUT"),
    ):
        picture.hear(message)
    shown = text(picture)
    for words in (
        "STOPPED", "NAVIGATING", "bring me the mug", "for 11 s", "1. grasp red mug", "failed: BLOCKED a chair",
        "fetch the apple: failed", "robot: On my way", "leaf  2 m left", "too slow", "● brain", "✗ sim",
    ):  # fmt: skip
        assert words in shown, words
    assert "folded" not in shown
    assert [line.strip("│├└─ ") for line in text(picture, tree_alone=True).splitlines()] == [
        "root", "wait", "inner", "folded", "do", "drive", "leaf  2 m left",
    ]  # fmt: skip
    assert shown.count("heard: bring me the mug") == 1


def test_a_mission_that_goes_on_under_its_old_name_is_under_way(picture: watch.Picture) -> None:
    stopped = m.MissionOutcome(id="m-1", command="bring me the mug", outcome="cancelled", reason="stopped")
    state = m.BrainState(
        state="NAVIGATING", mission_id="m-1", command="bring me the mug", t=21.0, started=10.0, last=stopped
    )
    picture.now = {topics.BRAIN_STATE.key: state}
    assert "for 11 s" in text(picture)
    assert status_record(state, None)["mission"] is not None
    ended = msgspec.structs.replace(state, state="COMPLETED")
    picture.now = {topics.BRAIN_STATE.key: ended}
    assert "for 11 s" not in text(picture) and status_record(ended, None)["mission"] is None


def test_it_fits_a_narrow_terminal(picture: watch.Picture) -> None:
    picture.alive = {"manipulation"}
    busy = m.Health(name="manipulation", epoch="a", t=9.0, uptime=99999.0, hz=100.0, drops=12345, rss_mb=999.0, pid=1)
    picture.health.take(busy)
    shown = text(picture, 80)
    assert max(len(line) for line in shown.splitlines()) <= 80
    for words in ("manipulation", "died", "drops", "up s", " 100 999 12345 99999"):
        assert words in shown, words


def test_keys() -> None:
    link = Silent()
    for key in " ryn?":
        assert watch.press(link, key)  # type: ignore[arg-type]
    assert [key for key, _ in link.sent] == ["robot/stop", "robot/resume", "voice_command", "voice_command"]
    assert [getattr(message, "text", "") for _, message in link.sent[2:]] == ["yes", "no"]
    assert not watch.press(link, "q")  # type: ignore[arg-type]
    assert len(link.sent) == 4
