"""`tidybot up` with every process real: the brain dies by SIGKILL in mid-mission, the robot delivers all the same."""

import os
import signal
from pathlib import Path
from typing import Any

import pytest

from cli.link import Link
from cli.processes.own_robot import own_robot
from cli.processes.plan import Plan
from cli.processes.supervision import Supervision
from cli.processes.up import bring_up
from common import messages as m
from common import topics
from common.bus.session import open_session
from evaluation.site import eventually

ITEM = "red mug"
PATIENCE = 300.0


def plan_of(directory: Path, monkeypatch: pytest.MonkeyPatch) -> Plan:
    for name in [n for n in os.environ if n.startswith("TIDYBOT")]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("TIDYBOT_STATE_DIR", str(directory / "state"))
    return Plan(own_robot("journal-up", seed=1, without="dashboard"))


def brain_of(supervision: Supervision) -> int:
    """Its process id, 0 while it is not running."""
    return supervision.running().get("brain", 0)


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_kill_9_of_the_brain_under_a_whole_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan, supervision = plan_of(tmp_path, monkeypatch), Supervision(tmp_path / "run")
    try:
        bring_up(supervision, plan, lambda text: None)
        with open_session(plan.connect, plan.namespace) as session:
            link = Link(session, plan.connect)
            mission = ask(link)
            killed: list[str] = []
            for state in ("NAVIGATING", "GRABBING", "RETURNING"):
                seen = eventually(lambda state=state: in_state(link, state), state, PATIENCE)
                pid = brain_of(supervision)
                os.kill(pid, signal.SIGKILL)
                killed.append(seen.state)
                eventually(lambda pid=pid: brain_of(supervision) not in (0, pid), "the brain is started again", 60.0)
                back = eventually(lambda: taken_up(link, mission), "the same mission goes on", 60.0)
                assert back.command == f"bring me the {ITEM}"
            last = eventually(lambda: outcome(link), "the mission ends", PATIENCE)
            assert (last.id, last.outcome) == (mission, "delivered"), last.reason
            assert killed == ["NAVIGATING", "GRABBING", "RETURNING"]
            check(link, mission)
    finally:
        supervision.stop()


def ask(link: Link) -> str:
    """Give the command; the mission's id."""
    eventually(lambda: in_state(link, "WAITING"), "the robot waits", 120.0)
    link.send(topics.VOICE_COMMAND, m.VoiceCommand(text=f"bring me the {ITEM}", confirmed=True))
    state = eventually(lambda: now(link, lambda s: bool(s.mission_id)), "the mission begins", 60.0)
    return str(state.mission_id)


def now(link: Link, fits: Any) -> m.BrainState | None:
    state = link.latest(topics.BRAIN_STATE)
    return state if state is not None and fits(state) else None


def in_state(link: Link, name: str) -> m.BrainState | None:
    return now(link, lambda s: s.state == name)


def taken_up(link: Link, mission: str) -> m.BrainState | None:
    return now(link, lambda s: s.mission_id == mission and s.state != "IDLE")


def outcome(link: Link) -> m.MissionOutcome | None:
    state = now(link, lambda s: s.last is not None)
    return state.last if state is not None else None


def check(link: Link, mission: str) -> None:
    """By physics on the tray, with an empty hand; by the journal taken up three times, grabbed and put down once."""
    truth = link.query(topics.SIM_TRUTH)
    assert truth["objects"][ITEM]["on"] == "delivery tray" and truth["holding"] is None, truth["objects"][ITEM]
    record = link.query(topics.BRAIN_MISSIONS, {"id": mission})
    causes = [entry["cause"] for entry in record["entries"]]
    assert causes.count("brain restarted") == 3 and causes.count("resumed") == 3
    assert causes.count("manipulation: done") == 2, causes
