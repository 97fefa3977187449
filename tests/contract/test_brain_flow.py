"""The real brain process against a scripted peer that knows nothing but zenoh and JSON."""

import json
import os
import random
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
import zenoh

from evaluation.site import Site, eventually
from tests.contract.brain_peer import BrainPeer, brain

pytestmark = pytest.mark.long

SPEECH, NAVIGATION, MANIPULATION = "brain/speech_goal", "brain/navigation_goal", "brain/manipulation_goal"
READ_BY_BRAIN = (
    "brain/speech_result", "brain/navigation_status", "brain/manipulation_status", "voice_command", "action_plan",
    "object_pose", "navigation_feedback", "joint_states", "world/objects", "speech/status", "sim/status",
)  # fmt: skip
Seen = tuple[float, str, dict[str, Any]]


class Peer(BrainPeer):
    """Remembers what arrived, with its arrival time [s]."""

    def __init__(self, session: zenoh.Session) -> None:
        super().__init__(session)
        self.seen: list[Seen] = []

    def receive(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        self.seen.append((time.monotonic(), key, json.loads(sample.payload.to_bytes())))

    def goals(self) -> list[Seen]:
        return [s for s in list(self.seen) if s[1] in (SPEECH, NAVIGATION, MANIPULATION)]

    def texts(self) -> list[str]:
        return [goal["goal"] for _, _, goal in self.goals()]

    def goal(self, count: int, text: str) -> tuple[float, dict[str, Any]]:
        """The goal number `count` (from 1) of all three keys together: (arrival, fields)."""
        eventually(lambda: len(self.goals()) >= count, f"goal {count}: {text}; so far {self.texts()}")
        at, _, fields = self.goals()[count - 1]
        assert fields["goal"] == text
        return at, fields

    def states(self) -> list[str]:
        names = [fields["state"] for _, key, fields in list(self.seen) if key == "brain/state"]
        return [n for i, n in enumerate(names) if i == 0 or n != names[i - 1]]

    def state_is(self, name: str) -> dict[str, Any]:
        def found() -> dict[str, Any] | None:
            last = next((f for _, k, f in reversed(self.seen) if k == "brain/state"), None)
            return last if last and last["state"] == name else None

        return eventually(found, f"state {name}; so far {self.states()}")


def shown_state(session: zenoh.Session) -> dict[str, Any]:
    """What a late `get` of the state is answered."""
    answers = eventually(lambda: list(session.get("brain/state", timeout=2.0)), "the state answers a get")
    fields: dict[str, Any] = json.loads(answers[0].ok.payload.to_bytes())
    return fields


@contextmanager
def scripted(here: Site, joints: bool = True, **parameters: str) -> Iterator[Peer]:
    """A brain process and the scripted peer that plays everybody else."""
    keys = (SPEECH, NAVIGATION, MANIPULATION, "brain/state", "system_status")
    with brain(here, Peer, "fetch", keys, joints, **parameters) as peer:
        yield peer


def test_a_whole_mission(here: Site) -> None:
    with scripted(here) as peer:
        _, listen = peer.goal(1, "listen")
        peer.heard(listen, "bring me the red mug")
        _, find = peer.goal(2, "find red mug")
        peer.drove(find, "navigating")
        arrived = peer.drove(find)
        grab_at, grab = peer.goal(3, "grab")
        peer.did(grab, "executing", phase="reach")
        grabbed = peer.did(grab)
        back_at, back = peer.goal(4, "return_to_start")
        returned = peer.drove(back)
        release_at, release = peer.goal(5, "release")
        released = peer.did(release)
        listen_at, _ = peer.goal(6, "listen")
        peer.state_is("LISTENING")
        assert peer.states()[-9:] == [
            "WAITING", "LISTENING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING", "COMPLETED",
            "WAITING", "LISTENING",
        ]  # fmt: skip
        for done, following in ((arrived, grab_at), (grabbed, back_at), (returned, release_at), (released, listen_at)):
            assert following - done >= 1.0
        assert peer.texts() == ["listen", "find red mug", "grab", "return_to_start", "release", "listen"]
        ids = [goal["id"] for _, _, goal in peer.goals()]
        mission = ids[0].rpartition(".")[0]
        assert ids[:5] == [f"{mission}.{n}" for n in range(1, 6)]
        assert {goal["attempt"] for _, _, goal in peer.goals()} == {1}
        last = peer.state_is("LISTENING")["last"]
        assert (last["id"], last["outcome"]) == (mission, "delivered")


def test_waits_for_joint_states_and_answers_a_late_get(here: Site) -> None:
    with scripted(here, joints=False) as peer:
        assert shown_state(peer.session)["state"] == "IDLE"
        time.sleep(1.0)
        assert peer.goals() == []
        peer.joints.start()
        peer.goal(1, "listen")


def test_lost_joint_states_stop_base_and_arm_and_the_mission_goes_on_with_them(here: Site) -> None:
    with scripted(here) as peer:
        _, listen = peer.goal(1, "listen")
        peer.heard(listen, "red mug")
        _, find = peer.goal(2, "find red mug")
        peer.joints.silent = True
        eventually(lambda: len(peer.goals()) >= 4, f"base and arm are told to stop; so far {peer.texts()}")
        assert {(key, fields["goal"]) for _, key, fields in peer.goals()[2:4]} == {
            (NAVIGATION, "stop"), (MANIPULATION, "stop"),
        }  # fmt: skip
        held = peer.state_is("IDLE")
        assert held["mission_id"] == find["id"].rpartition(".")[0] and "waiting for joint_states" in held["detail"]
        peer.drove(find)
        peer.joints.silent = False
        _, again = peer.goal(5, "find red mug")
        assert again["id"] != find["id"]
        peer.drove(again)
        peer.goal(6, "grab")


def test_waits_for_somebody_who_hears_speech_goals(here: Site) -> None:
    with here.session() as session:
        here.start("services.brain", TIDYBOT_CLOCK="wall", TIDYBOT__BRAIN__PIPELINE="fetch")
        here.wait_alive(session, "brain")
        peer = Peer(session)
        peer.joints.start()
        eventually(lambda: shown_state(session)["detail"] == "waiting for speech", "the brain waits for speech")
        subscriber = session.declare_subscriber(SPEECH, peer.receive)
        peer.goal(1, "listen")
        peer.joints.stop()
        subscriber.undeclare()


SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    "failure", [b"ERROR", pytest.param(b'"ERROR"', marks=SLOW), pytest.param(b'{"text": "ERROR"}', marks=SLOW)]
)
def test_five_seconds_before_listening_again(here: Site, failure: bytes) -> None:
    with scripted(here) as peer:
        peer.goal(1, "listen")
        failed = peer.raw("brain/speech_result", failure)
        again_at, again = peer.goal(2, "listen")
        assert again_at - failed >= 5.0
        assert "ERROR" not in peer.states()
        peer.heard(again, "apple")
        peer.goal(3, "find apple")


def test_bare_texts_old_texts_and_foreign_ids(here: Site) -> None:
    with scripted(here) as peer:
        _, listen = peer.goal(1, "listen")
        peer.raw("brain/navigation_status", b"arrived")
        peer.raw("brain/manipulation_status", b"done")
        peer.put("brain/speech_result", text="blue mug", goal_id="somebody.1", attempt=1)
        peer.raw("brain/speech_result", b"fetch the apple please")
        _, find = peer.goal(2, "find apple")
        peer.put("brain/navigation_status", status="arrived", goal_id="somebody.2", attempt=1)
        peer.put("brain/navigation_status", status="arrived", goal_id=find["id"], attempt=7)
        peer.put("brain/navigation_status", status="idle", goal_id="", attempt=0)
        peer.put("brain/manipulation_status", status="done", goal_id=find["id"], attempt=1)
        time.sleep(1.5)
        assert peer.texts() == ["listen", "find apple"]
        peer.raw("brain/navigation_status", b"arrived")
        _, grab = peer.goal(3, "grab")
        peer.drove(find)
        peer.heard(listen, "blue mug")
        peer.did(grab)
        peer.did(grab)
        _, back = peer.goal(4, "return_to_start")
        peer.raw("brain/navigation_status", b'"arrived"')
        peer.goal(5, "release")
        peer.did(grab)
        peer.drove(back)
        peer.raw("brain/manipulation_status", b"done")
        peer.state_is("COMPLETED")
        peer.goal(6, "listen")
        assert len(peer.goals()) == 6


def test_failures_end_in_a_spoken_error_never_in_completed(here: Site) -> None:
    with scripted(here, settle="0.1", grab_retries="1") as peer:
        _, listen = peer.goal(1, "listen")
        peer.heard(listen, "red mug")
        first = 2
        for attempt in (1, 2):
            _, find = peer.goal(first, "find red mug")
            peer.drove(find)
            _, grab = peer.goal(first + 1, "grab")
            assert (grab["attempt"], find["attempt"]) == (1, 1)
            peer.did(grab, "failed", code="EMPTY_GRASP", detail=f"try {attempt}")
            first += 2
        peer.goal(6, "say I could not pick up the red mug.")
        _, again = peer.goal(7, "listen")
        # Goals and states come on two keys, in no order.
        eventually(lambda: "LISTENING" in peer.states()[peer.states().index("ERROR") :], "it listens again")
        states = peer.states()
        assert "COMPLETED" not in states
        assert states[states.index("ERROR") :][:3] == ["ERROR", "WAITING", "LISTENING"]
        error = next(f for _, k, f in peer.seen if k == "brain/state" and f["state"] == "ERROR")
        assert "EMPTY_GRASP" in error["detail"]
        assert error["last"]["outcome"] == "failed"
        peer.heard(again, "apple")
        _, find = peer.goal(8, "find apple")
        for attempt in (1, 2, 3):
            _, find = peer.goal(7 + attempt, "find apple")
            assert find["attempt"] == attempt
            peer.drove(find, "failed", code="BLOCKED")
        peer.goal(11, "say I could not reach the apple.")
        _, listen = peer.goal(12, "listen")
        peer.heard(listen, "apple")
        _, find = peer.goal(13, "find apple")
        # A navigator that has tried two other paths itself is not asked for a third.
        peer.put("navigation_feedback", goal_id=find["id"], status="navigating", recoveries=2)
        peer.drove(find, "failed", code="BLOCKED")
        peer.goal(14, "say I could not reach the apple.")


def test_noise_on_every_key_harms_nothing(here: Site) -> None:
    noise = random.Random(7)
    with scripted(here) as peer:
        _, listen = peer.goal(1, "listen")
        for key in READ_BY_BRAIN:
            for size in (1, 3, 40, 900):
                peer.session.put(key, b"\xff" + noise.randbytes(size))
            for bad in (b"", b"{", b'{"status": 3}', b'{"text": ""}', b'"', b"\x00", b"{" * 900, b"{}", b'{"text": 3}'):
                peer.session.put(key, bad)
        peer.raw("robot/stop", os.urandom(4) + b"\xff")
        peer.heard(listen, "red mug")
        _, find = peer.goal(2, "find red mug")
        peer.drove(find)
        peer.goal(3, "grab")
        health = list(peer.session.get("service/brain/health", timeout=2.0))
        assert json.loads(health[0].ok.payload.to_bytes())["drops"] > 50


def test_typed_command_cancels_the_listening(here: Site) -> None:
    with scripted(here) as peer:
        _, listen = peer.goal(1, "listen")
        peer.raw("voice_command", b"bring me the red mug")
        eventually(lambda: "find red mug" in peer.texts(), "the mission starts")
        assert sorted(peer.texts()) == ["cancel", "find red mug", "listen"]
        peer.heard(listen, "apple")
        peer.raw("voice_command", b"cancel")
        eventually(lambda: peer.texts().count("stop") == 2, "both are told to stop")
        peer.state_is("LISTENING")
        assert "find apple" not in peer.texts()


def test_a_peer_process_that_is_replaced_gets_the_goal_again(here: Site) -> None:
    with scripted(here) as peer:
        _, listen = peer.goal(1, "listen")
        for count, epoch in enumerate(("old", "new")):
            token = peer.session.liveliness().declare_token("service/navigation/alive")
            time.sleep(0.3)
            numbers = dict.fromkeys(("t", "uptime", "hz", "drops", "rss_mb", "pid"), 0)
            peer.put("service/navigation/health", name="navigation", epoch=epoch, **numbers)
            if count == 0:
                time.sleep(0.3)
                peer.heard(listen, "red mug")
                _, first = peer.goal(2, "find red mug")
                token.undeclare()
                time.sleep(0.3)
        _, again = peer.goal(3, "find red mug")
        assert (again["id"], again["attempt"]) == (first["id"], 2)
        peer.drove(first)
        peer.drove(again)
        peer.goal(4, "grab")
