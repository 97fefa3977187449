"""What the bar at the top of the page tells, and when a mission can be gone on with."""

import json
from typing import Literal

import msgspec
import pytest

from common import messages as m
from common.language.offers import which
from common.mission_log.states import under_way
from services.dashboard.panels import markup
from services.dashboard.panels.markup import resumable, status_bar

CANCELLED = m.MissionOutcome(id="m-1", command="bring me the mug", outcome="cancelled", reason="stopped: stop button")
DELIVERED = m.MissionOutcome(id="m-1", command="bring me the mug", outcome="delivered")


def state(name: m.BrainStateName, mission: str = "", last: m.MissionOutcome | None = None, **more: str) -> m.BrainState:
    command = "fetch the can" if mission else ""
    return m.BrainState(state=name, mission_id=mission, command=command, started=10.0, last=last, **more)


def test_a_mission_under_way_hides_how_the_last_one_ended() -> None:
    shown = status_bar(state("NAVIGATING", "m-2", CANCELLED, step="find can"), None, 27.9)
    assert shown["mission"] == {"command": "fetch the can", "step": "find can", "seconds": 17}
    assert shown["last"] is None
    assert shown["left"] == ""


def test_a_mission_that_was_gone_on_with_is_under_way_again() -> None:
    again = state("GROUNDING", CANCELLED.id, CANCELLED, step="look for can")
    shown = status_bar(again, None, 40.0)
    assert shown["mission"] == {"command": "fetch the can", "step": "look for can", "seconds": 30}
    assert (shown["last"], shown["left"]) == (None, "")
    assert "cancelled" not in markup.mission(again, 40.0, [], None, None)


@pytest.mark.parametrize("last", [CANCELLED, DELIVERED])
def test_between_missions_the_last_one_is_told(last: m.MissionOutcome) -> None:
    for now in (state("LISTENING", last=last), state("COMPLETED", "m-1", last)):
        shown = status_bar(now, None, 30.0)
        assert (shown["mission"], shown["last"]) == (None, last)


def test_the_question_is_told_once() -> None:
    shown = status_bar(state("CONFIRMING", "m-2", step="Did you say fetch the can?"), None, 12.0)
    assert (shown["asking"], shown["question"]) == (True, "Did you say fetch the can?")
    assert shown["mission"] == {"command": "fetch the can", "step": "", "seconds": 2} and shown["offered"] == []


@pytest.mark.parametrize("names", [["red mug", "blue mug"], ["red mug", "blue mug", "mug on the desk"]])
def test_a_question_between_things_offers_them(names: list[str]) -> None:
    shown = status_bar(state("CONFIRMING", "m-2", step=which(names)), None, 12.0)
    assert shown["offered"] == [f"the {name}" for name in names]


def test_what_is_not_known_is_empty() -> None:
    shown = status_bar(None, None, 0.0)
    assert shown["state"] == shown["detail"] == ""
    assert not shown["stopped"] and not under_way(None)
    assert status_bar(None, m.SimStatus(state="stopped"), 0.0)["stopped"]
    # A robot whose clock began anew has not been at it for minus some seconds.
    assert status_bar(state("NAVIGATING", "m-2"), None, 1.0)["mission"]["seconds"] == 0
    assert json.loads(msgspec.json.encode(shown))["last"] is None


@pytest.mark.parametrize("outcome", ["cancelled", "failed"])
def test_only_what_can_be_resumed_is_gone_on_with(outcome: Literal["cancelled", "failed"]) -> None:
    for can in (True, False):
        last = m.MissionOutcome(id="m-1", command="go", outcome=outcome, reason="stopped", resumable=can)
        assert bool(resumable(state("IDLE", last=last))) is can
        assert resumable(state("NAVIGATING", "m-2", last)) == ""
    assert resumable(state("IDLE")) == ""
