"""The real brain process in `pipeline = "vla"` against a scripted peer of plain zenoh and JSON."""

import json
import math
import re
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

import zenoh

from evaluation.site import Site, eventually
from tests.contract.brain_peer import BrainPeer, brain

GOALS = (
    "brain/speech_goal", "brain/navigation_goal", "brain/manipulation_goal", "nav_goal", "plan_request", "object_query",
)  # fmt: skip
MUG_AT = [-1.5, -2.2, 0.55]
FETCH = [
    {"action": "find", "object": "red mug"},
    {"action": "grasp", "object": "red mug"},
    {"action": "return"},
    {"action": "release"},
]


class Peer(BrainPeer):
    """Remembers goals and system states in order."""

    def __init__(self, session: zenoh.Session) -> None:
        super().__init__(session)
        self.goals: list[tuple[str, dict[str, Any]]] = []
        self.system: list[str] = []
        self.grips: list[float] = []

    def receive(self, sample: zenoh.Sample) -> None:
        key, fields = str(sample.key_expr), json.loads(sample.payload.to_bytes())
        if key == "system_status":
            self.system += [fields["state"]] if [fields["state"]] != self.system[-1:] else []
        elif key == "gripper_command":
            self.grips.append(fields["position"])
        else:
            self.goals.append((key, fields))

    def next(self, key: str, **expected: Any) -> dict[str, Any]:
        """The next goal, which must be this one."""
        eventually(lambda: self.goals, f"{key} {expected}")
        got_key, fields = self.goals.pop(0)
        assert (got_key, {k: fields[k] for k in expected}) == (key, expected)
        return fields

    def speech(self, text: str) -> dict[str, Any]:
        return self.next("brain/speech_goal", goal=text)

    def moved(self, goal: dict[str, Any], status: str = "arrived", **more: Any) -> None:
        """As a navigator that knows `nav_goal` and `navigation_feedback` alone."""
        self.put("navigation_feedback", goal_id=goal["id"], status=status, **more)

    def stance(self, **expected: Any) -> dict[str, Any]:
        """The next goal, a pose before the mug: free of the table and facing it."""
        goal = self.next("nav_goal", frame="map", **expected)
        assert (goal["object"]["label"], goal["object"]["position"]) == ("red mug", MUG_AT)
        bearing = math.atan2(MUG_AT[1] - goal["y"], MUG_AT[0] - goal["x"])
        assert abs(math.remainder(bearing - goal["theta"], math.tau)) < 0.01
        assert 0.5 < math.dist((goal["x"], goal["y"]), MUG_AT[:2]) < 0.75
        return goal

    def feel(self, width: float, force: float = 0.0) -> None:
        """What joint_states tell of the gripper from now on."""
        joints = {"t": 0.0, "name": ["gripper"], "position": [width], "velocity": [0.0], "effort": [force]}
        self.joints.payload = json.dumps(joints)

    def ask(self, command: str, *steps: dict[str, str]) -> None:
        """A command, and the plan for it."""
        self.session.put("voice_command", command)
        request = self.next("plan_request", command=command)
        self.put("action_plan", request_id=request["id"], steps=list(steps))

    def saw(self, query: dict[str, Any], found: bool = True) -> None:
        self.put("object_pose", query_id=query["id"], found=found, label="red mug", position=MUG_AT)

    def looked(self, query: dict[str, Any]) -> None:
        """A picture taken after the question shows the mug on the tray."""
        at = [0.7, 0.0, 0.51]
        self.put("object_pose", query_id=query["id"], found=True, label="red mug", position=at, seen_at=query["since"])


@contextmanager
def scripted(here: Site, deaf: str = "", **parameters: str) -> Iterator[Peer]:
    """A brain and its peer, which does not subscribe to the goal `deaf`."""
    keys = {*GOALS, "system_status", "gripper_command"} - {deaf}
    with brain(here, Peer, "vla", keys, **parameters) as peer:

        def waits() -> bool:
            replies = list(peer.session.get("brain/state", timeout=2.0))
            return bool(replies) and json.loads(replies[0].ok.payload.to_bytes())["state"] == "WAITING"

        eventually(waits, "the brain waits for a command")
        yield peer


def logged(here: Site) -> list[tuple[str, str]]:
    """The transitions in the brain's log."""
    return re.findall(r"State: (\w+) -> (\w+)", here.log("services.brain"))


def test_voice_to_action_with_a_correction_and_a_replan(here: Site) -> None:
    with scripted(here, settle="0.2") as peer:
        peer.session.put("voice_command", "bring me the blue mug")
        peer.speech("say Did you say bring me the blue mug?")
        listen = peer.speech("listen")
        peer.heard(listen, "no, the red mug")
        peer.speech("say Did you say bring me the red mug?")
        listen = peer.speech("listen")
        peer.heard(listen, "yes")
        request = peer.next("plan_request", command="bring me the red mug", rejected=None)
        peer.put("action_plan", request_id="another", steps=FETCH)
        peer.put("action_plan", request_id=request["id"], steps=[{"action": "grasp", "object": "sofa"}])
        request = peer.next("plan_request", command="bring me the red mug")
        assert "sofa" in request["rejected"]["reason"]
        peer.put("action_plan", request_id=request["id"], steps=FETCH)
        peer.saw(peer.next("object_query", query="red mug"))
        stance = peer.stance(attempt=1)
        peer.moved(stance, "navigating", distance_remaining=2.0, eta=5.0)
        peer.moved({"id": "somebody.1"})
        peer.moved(stance)
        grab = peer.next("brain/manipulation_goal", goal="grab")
        assert (grab["object"]["label"], grab["object"]["position"]) == ("red mug", MUG_AT)
        peer.did(grab)
        peer.drove(peer.next("brain/navigation_goal", goal="return_to_start"))
        peer.did(peer.next("brain/manipulation_goal", goal="release"))
        peer.looked(peer.next("object_query", query="red mug"))
        peer.speech("say Done.")
        eventually(lambda: peer.system[-1] == "IDLE", "back to waiting")
        states = [
            "LISTENING", "PLANNING", "GROUNDING", "NAVIGATING", "EXECUTING", "NAVIGATING", "EXECUTING",
            "SUCCESS", "IDLE",
        ]  # fmt: skip
        assert peer.system[peer.system.index("LISTENING") :] == states
        assert logged(here) == list(pairwise(["IDLE", *states]))


def test_search_and_alternative_path(here: Site) -> None:
    with scripted(here, settle="0.2", enable_confirmation="false") as peer:
        peer.session.put("voice_command", "bring me the red mug")
        request = peer.next("plan_request")
        peer.put("action_plan", request_id=request["id"], steps=FETCH)
        peer.saw(peer.next("object_query"), found=False)
        view = peer.next("nav_goal", frame="map")
        peer.put("navigation_feedback", goal_id=view["id"], status="arrived")
        peer.saw(peer.next("object_query"))
        first = peer.stance(attempt=1)
        peer.moved(first, "failed", code="BLOCKED", recoveries=1)
        again = peer.stance(attempt=2, id=first["id"])
        peer.moved(again, "failed", code="BLOCKED")
        peer.speech("say I could not reach the red mug.")
        eventually(lambda: "ERROR" in peer.system, "it says that it failed")
        assert "SUCCESS" not in peer.system


def test_speech_that_fails_is_asked_again_after_five_seconds(here: Site) -> None:
    with scripted(here, settle="0.2") as peer:
        peer.session.put("voice_command", "bring me the red mug")
        peer.speech("say Did you say bring me the red mug?")
        listen = peer.speech("listen")
        peer.heard(listen, "ERROR")
        failed = time.monotonic()
        peer.speech("say Did you say bring me the red mug?")
        assert time.monotonic() - failed >= 5.0
        peer.speech("listen")


def test_joint_states_that_stay_away_end_the_mission_in_a_spoken_error(here: Site) -> None:
    with scripted(here, settle="0.2", enable_confirmation="false", heartbeat_patience="1.0") as peer:
        peer.session.put("voice_command", "bring me the red mug")
        request = peer.next("plan_request")
        peer.joints.silent = True
        eventually(lambda: len(peer.goals) == 2, "base and arm are told to stop")
        stops = {(key, fields["goal"]) for key, fields in peer.goals}
        assert stops == {("brain/navigation_goal", "stop"), ("brain/manipulation_goal", "stop")}
        peer.goals.clear()
        peer.put("action_plan", request_id=request["id"], steps=FETCH)
        peer.speech("say I have lost contact with my motors.")
        eventually(lambda: peer.system[-2:] == ["ERROR", "IDLE"], "it waits for joint_states")
        assert logged(here)[-2:] == [("IDLE", "ERROR"), ("ERROR", "IDLE")]
        assert peer.goals == []


def test_the_gripper_alone_is_the_brains_own(here: Site) -> None:
    with scripted(here, settle="0.2", enable_confirmation="false") as peer:
        for command, action, position, width in (
            ("open your hand", "release", 0.0, 0.085),
            ("close your hand", "grasp", 1.0, 0.001),
        ):
            peer.feel(0.04)
            peer.grips.clear()
            peer.ask(command, {"action": action, "target": "gripper"})
            eventually(lambda: len(peer.grips) > 3, "the command, again and again")
            assert peer.goals == [] and peer.system[-1] == "EXECUTING", "no evidence yet"
            peer.feel(width)
            eventually(lambda: peer.goals, "joint_states have shown it")
            assert set(peer.grips) == {position}
            peer.speech("say Done.")
            eventually(lambda: peer.system[-1] == "IDLE", "back to waiting")
        peer.grips.clear()
        peer.ask("open your hand", {"action": "release", "target": "gripper"})
        eventually(lambda: peer.grips, "the command")
        peer.speech("say I could not open my hand.")


def test_a_full_hand_is_emptied_by_manipulation(here: Site) -> None:
    with scripted(here, settle="0.2", enable_confirmation="false") as peer:
        peer.feel(0.04, 25.0)
        peer.ask("open your hand", {"action": "release", "target": "gripper"})
        peer.did(peer.next("brain/manipulation_goal", goal="release"))
        peer.speech("say Done.")
        assert peer.grips == []


def test_a_navigator_that_knows_poses_alone_is_enough(here: Site) -> None:
    with scripted(here, "brain/navigation_goal", settle="0.2", drive_by="poses", enable_confirmation="false") as peer:
        peer.ask("bring me the red mug", *FETCH)
        peer.saw(peer.next("object_query"))
        peer.moved(peer.stance())
        peer.did(peer.next("brain/manipulation_goal", goal="grab"))
        home = peer.next("nav_goal", x=0.0, y=0.0, object=None)
        peer.moved(home)
        peer.did(peer.next("brain/manipulation_goal", goal="release"))
        peer.looked(peer.next("object_query", query="red mug"))
        peer.speech("say Done.")
