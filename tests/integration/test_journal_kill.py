"""The brain as a real process, killed with SIGKILL while each of its goals is under way, among plain zenoh peers."""

import json
import queue
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import zenoh

from evaluation.site import Site, eventually, site
from tests.support import ROOT

GOALS = ("brain/speech_goal", "brain/navigation_goal", "brain/manipulation_goal")
QUICK = {"TIDYBOT_CLOCK": "wall", "TIDYBOT__BRAIN__SETTLE": "0.2", "TIDYBOT__BRAIN__PIPELINE": "fetch"}


class Peers:
    """Everything but the brain, by hand: the test sees each goal and says what becomes of it."""

    def __init__(self, opened: zenoh.Session) -> None:
        self.session = opened
        self.goals: queue.Queue[tuple[str, dict[str, Any]]] = queue.Queue()
        self.states: list[dict[str, Any]] = []
        self.kept: list[Any] = [
            opened.declare_subscriber(
                key, lambda s: self.goals.put((str(s.key_expr), json.loads(s.payload.to_bytes())))
            )
            for key in GOALS
        ]
        self.kept.append(
            opened.declare_subscriber("brain/state", lambda s: self.states.append(json.loads(s.payload.to_bytes())))
        )

    def put(self, key: str, **fields: Any) -> None:
        self.session.put(key, json.dumps(fields))

    def joints(self, width: float, force: float) -> None:
        self.put("joint_states", t=0.0, name=["gripper"], position=[width], velocity=[0.0], effort=[force])

    def goal(self, key: str, width: float, force: float) -> dict[str, Any]:
        """The next goal on the key; the fingers are felt all the time."""

        def look() -> dict[str, Any] | None:
            self.joints(width, force)
            try:
                found, goal = self.goals.get(timeout=0.05)
            except queue.Empty:
                return None
            assert found == key or goal["goal"].startswith("say "), (found, goal)
            return goal if found == key else None

        return eventually(look, f"a goal on {key}") or {}

    def answer(self, key: str, goal: dict[str, Any], **fields: Any) -> None:
        self.put(key, goal_id=goal["id"], attempt=goal["attempt"], **fields)


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[tuple[Site, Peers]]:
    with site(tmp_path) as place, place.session() as opened:
        yield place, Peers(opened)


def start(place: Site, opened: zenoh.Session) -> "subprocess.Popen[bytes]":
    process = place.start("services.brain", **QUICK)
    place.wait_alive(opened, "brain")
    return process


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_kill_9_while_each_goal_is_under_way(robot: tuple[Site, Peers]) -> None:
    place, peers = robot
    brain = start(place, peers.session)
    listen = peers.goal(GOALS[0], 0.085, 0.0)
    peers.put("brain/speech_result", text="bring me the red mug", goal_id=listen["id"])
    steps = (
        (GOALS[1], "find red mug", "brain/navigation_status", {"status": "arrived"}, (0.085, 0.0)),
        (GOALS[2], "grab", "brain/manipulation_status", {"status": "done"}, (0.085, 0.0)),
        (GOALS[1], "return_to_start", "brain/navigation_status", {"status": "arrived"}, (0.04, 25.0)),
        (GOALS[2], "release", "brain/manipulation_status", {"status": "done"}, (0.04, 25.0)),
    )
    seen = []
    for key, text, status_key, status, fingers in steps:
        goal = peers.goal(key, *fingers)
        assert goal["goal"] == text
        brain.kill()
        brain.wait()
        brain = start(place, peers.session)
        again = peers.goal(key, *fingers)
        # The same goal, so that whoever carries it out does not begin anew.
        assert (again["id"], again["attempt"], again["goal"]) == (goal["id"], goal["attempt"], text)
        peers.answer(status_key, again, **status)
        seen.append(goal["id"])
    assert len(set(seen)) == 4 and len({one.partition(".")[0] for one in seen}) == 1
    last = eventually(lambda: next((s["last"] for s in peers.states[-5:] if s.get("last")), None), "the outcome")
    assert last["outcome"] == "delivered" and last["id"] == seen[0].partition(".")[0]
    # The next process knows how it ended, and begins nothing old.
    brain.kill()
    brain.wait()
    brain = start(place, peers.session)
    listen = peers.goal(GOALS[0], 0.085, 0.0)
    assert listen["goal"] == "listen" and not listen["id"].startswith(last["id"] + ".")
    record = json.loads(told(place, "explain", "--json"))
    causes = [entry["cause"] for entry in record["entries"]]
    assert record["outcome"] == "delivered" and causes.count("brain restarted") == 4
    assert causes.count("grab") == 2 and [e["kind"] for e in record["entries"]].count("did") == 5
    story = told(place, "explain", last["id"])
    for word in ("heard: bring me the red mug", "RETURNING", "did: manipulation: done", "resumed", "delivered after"):
        assert word in story, story
    rows = json.loads(told(place, "missions", "--json"))
    assert [(row["id"], row["outcome"]) for row in rows] == [(last["id"], "delivered")]
    assert last["id"] in told(place, "missions")
    wrong = cli(place, "explain", "mission-1")
    assert wrong.returncode == 1 and last["id"] in wrong.stderr


def cli(place: Site, *words: str) -> "subprocess.CompletedProcess[str]":
    line = [sys.executable, "-m", "cli.main", *words]
    return subprocess.run(line, env=place.environment(), cwd=ROOT, capture_output=True, text=True, timeout=60)


def told(place: Site, *words: str) -> str:
    done = cli(place, *words)
    assert done.returncode == 0, done.stderr
    return done.stdout
