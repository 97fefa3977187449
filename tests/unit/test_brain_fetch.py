"""The fetch tree with hand-driven peers: the flow, its timing, every failure edge."""

import pytest

from common import messages as m
from common import topics
from common.bus.memory import MemoryIo
from services.brain.config import BrainConfig
from tests.unit.brain_bench import HOME, Bench

NAV, MANIP, SPEECH = topics.NAVIGATION_GOAL, topics.MANIPULATION_GOAL, topics.SPEECH_GOAL


def start(text: str = "bring me the red mug") -> Bench:
    bench = Bench()
    bench.hear(text)
    return bench


def holding(bench: Bench | None = None) -> Bench:
    """The mug is in the hand and the robot about to return."""
    bench = bench or start()
    bench.drove(bench.nav(1))
    bench.did(bench.manip(1))
    return bench


def test_the_whole_flow_in_order() -> None:
    bench = holding()
    bench.drove(bench.nav(2))
    bench.did(bench.manip(2))
    bench.until(lambda: len(bench.sent(SPEECH)) == 2)
    assert bench.states() == [
        "IDLE", "WAITING", "LISTENING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING", "COMPLETED",
        "WAITING", "LISTENING",
    ]  # fmt: skip
    assert bench.texts(NAV) == ["find red mug", "return_to_start"]
    assert bench.texts(MANIP) == ["grab", "release"]
    assert bench.texts(SPEECH) == ["listen", "listen"]
    last = bench.state.last
    assert last is not None
    assert (last.outcome, last.command) == ("delivered", "bring me the red mug")
    ids = [g.id for t in (SPEECH, NAV, MANIP) for g in bench.sent(t)]
    assert len(set(ids)) == len(ids)
    mission = last.id
    assert [g.id for g in bench.sent(NAV)] == [f"{mission}.2", f"{mission}.4"]
    assert {g.attempt for t in (SPEECH, NAV, MANIP) for g in bench.sent(t)} == {1}


def test_system_status_is_the_fold() -> None:
    bench = holding()
    bench.drove(bench.nav(2))
    bench.did(bench.manip(2))
    folded = dict.fromkeys(s.state for s in bench.sent(topics.SYSTEM_STATUS))
    assert list(folded) == ["IDLE", "LISTENING", "NAVIGATING", "EXECUTING", "SUCCESS"]


def test_nothing_starts_before_joint_states() -> None:
    bench = Bench(joints=False)
    bench.step(30.0)
    assert (bench.states(), bench.sent(SPEECH)) == (["IDLE"], [])
    bench.send(topics.JOINT_STATES, m.JointStates(t=0.0, name=[], position=[], velocity=[], effort=[]))
    bench.step(1.0)
    assert bench.texts(SPEECH) == ["listen"]


def test_settles_one_second_after_every_arrival_and_grasp() -> None:
    bench = start()
    for count, done, topic in ((1, bench.drove, MANIP), (1, bench.did, NAV), (2, bench.drove, MANIP)):
        goal = bench.nav(count) if done == bench.drove else bench.manip(count)
        before = len(bench.sent(topic))
        done(goal)  # type: ignore[arg-type]
        took = bench.until(lambda topic=topic, n=before: len(bench.sent(topic)) > n)
        assert 1.0 <= took + 1e-6 < 1.2


@pytest.mark.parametrize("text", ["ERROR", " ERROR "])
def test_five_seconds_after_a_speech_failure(text: str) -> None:
    bench = start(text)
    took = bench.until(lambda: len(bench.sent(SPEECH)) == 2)
    assert 4.95 <= took < 5.2
    assert bench.texts(SPEECH) == ["listen", "listen"]
    assert "ERROR" not in bench.states()


def test_listening_times_out() -> None:
    bench = Bench()
    bench.next_goal(SPEECH, 1)
    took = bench.until(lambda: bench.states()[-1] == "WAITING")
    assert 60.0 <= took < 62.0
    assert bench.until(lambda: len(bench.sent(SPEECH)) == 2) >= 4.9


def test_foreign_late_and_idle_statuses_do_not_count() -> None:
    bench = start()
    goal = bench.nav(1)
    for status in (
        m.NavigationStatus(status="arrived", goal_id="someone.1", attempt=1),
        m.NavigationStatus(status="arrived", goal_id=goal.id, attempt=2),
        m.NavigationStatus(status="idle"),
        m.NavigationStatus(status="idle", goal_id=goal.id, attempt=1),
        m.NavigationStatus(status="navigating", goal_id=goal.id, attempt=1),
    ):
        bench.send(topics.NAVIGATION_STATUS, status)
    bench.step(5.0)
    assert bench.state.state == "NAVIGATING"
    assert sum(bench.io.drops.values()) == 1
    bench.drove(goal)
    bench.drove(goal)
    bench.manip(1)
    assert bench.texts(MANIP) == ["grab"]


def test_the_first_final_word_stands() -> None:
    bench = start()
    goal = bench.nav(1)
    for word in ("arrived", "failed", "navigating"):
        bench.bus.put(topics.NAVIGATION_STATUS, f'{{"status":"{word}","goal_id":"{goal.id}","attempt":1}}'.encode())
    bench.manip(1)
    assert bench.texts(NAV) == ["find red mug"]


def test_a_status_from_before_the_goal_does_not_count() -> None:
    bench = Bench()
    bench.send(topics.NAVIGATION_STATUS, m.NavigationStatus(status="arrived"))
    bench.send(topics.MANIPULATION_STATUS, m.ManipulationStatus(status="done"))
    bench.hear("red mug")
    bench.step(10.0)
    assert bench.state.state == "NAVIGATING"


def test_a_peer_of_bare_texts_is_understood() -> None:
    bench = Bench()
    bench.next_goal(SPEECH, 1)
    bench.bus.put(topics.SPEECH_RESULT, b"apple")
    for topic, count, key, text in (
        (NAV, 1, topics.NAVIGATION_STATUS, b"arrived"),
        (MANIP, 1, topics.MANIPULATION_STATUS, b'"done"'),
        (NAV, 2, topics.NAVIGATION_STATUS, b"arrived"),
        (MANIP, 2, topics.MANIPULATION_STATUS, b"done"),
    ):
        bench.next_goal(topic, count)
        bench.bus.put(key, text)
    bench.until(lambda: bench.state.state == "COMPLETED")
    assert bench.texts(NAV) == ["find apple", "return_to_start"]


def test_navigation_is_tried_three_times_then_reported() -> None:
    bench = start()
    for count in (1, 2, 3):
        goal = bench.nav(count)
        assert goal.attempt == count
        bench.drove(goal, "failed", "BLOCKED")
    bench.until(lambda: bench.state.state == "ERROR")
    assert {g.id for g in bench.sent(NAV)} == {bench.nav(1).id}
    last = bench.state.last
    assert last is not None
    assert last.outcome == "failed"
    assert "BLOCKED" in last.reason and last.reason == bench.state.detail
    assert bench.texts(SPEECH)[-1] == "say I could not reach the red mug."
    bench.until(lambda: bench.texts(SPEECH)[-1] == "listen", limit=10.0)
    assert "COMPLETED" not in bench.states()


def test_what_cannot_work_is_not_tried_again() -> None:
    bench = start()
    bench.drove(bench.nav(1), "failed", "UNKNOWN_PLACE")
    assert bench.state.state == "ERROR"


def test_a_failed_grab_drives_up_again() -> None:
    bench = start()
    bench.drove(bench.nav(1))
    bench.did(bench.manip(1), "failed", "EMPTY_GRASP")
    bench.drove(bench.nav(2))
    bench.did(bench.manip(2))
    bench.drove(bench.nav(3))
    bench.did(bench.manip(3))
    assert bench.state.state == "COMPLETED"
    assert bench.texts(NAV) == ["find red mug", "find red mug", "return_to_start"]
    assert bench.texts(MANIP) == ["grab", "grab", "release"]
    assert len({g.id for g in bench.sent(NAV)}) == 3


def test_three_failed_grabs_end_in_error_without_release() -> None:
    bench = start()
    for count in (1, 2, 3):
        bench.drove(bench.nav(count))
        bench.did(bench.manip(count), "failed", "SLIPPED")
    assert bench.state.state == "ERROR"
    assert bench.texts(MANIP) == ["grab"] * 3


@pytest.mark.parametrize(
    ("code", "why", "told"), [("TOO_HEAVY", "too heavy for me", 1), ("TOO_WIDE", "too wide for my hand", 2)]
)
def test_what_no_grasp_can_hold_is_said_and_not_tried_again(code: str, why: str, told: int) -> None:
    """What looks too wide is looked at once more."""
    bench = start()
    for count in range(1, told + 1):
        bench.drove(bench.nav(count))
        bench.did(bench.manip(count), "failed", code)
    assert bench.state.state == "ERROR" and code in bench.state.detail
    assert bench.texts(MANIP) == ["grab"] * told
    assert bench.texts(SPEECH)[-1] == f"say The red mug is {why}."


def test_a_failed_return_never_drops_the_object_and_the_next_mission_knows() -> None:
    bench = holding()
    for count in (2, 3, 4):
        bench.drove(bench.nav(count), "failed", "NO_PATH")
    assert bench.state.state == "ERROR"
    assert "still holding the red mug" in bench.state.detail
    assert bench.texts(MANIP) == ["grab"]
    bench.hear("bring me the apple", count=3)
    bench.drove(bench.nav(5))
    bench.did(bench.manip(2))
    bench.drove(bench.nav(6))
    assert bench.texts(NAV)[4:] == ["return_to_start", "find apple"]
    bench.manip(3)
    assert bench.texts(MANIP) == ["grab", "release", "grab"]


def test_the_wanted_object_already_in_the_hand_is_only_brought() -> None:
    bench = holding()
    for count in (2, 3, 4):
        bench.drove(bench.nav(count), "failed", "NO_PATH")
    bench.hear("red mug", count=3)
    bench.drove(bench.nav(5))
    bench.did(bench.manip(2))
    assert bench.state.state == "COMPLETED"
    assert bench.texts(MANIP) == ["grab", "release"]


def test_a_failed_release_is_tried_again_then_reported_as_held() -> None:
    bench = holding()
    bench.drove(bench.nav(2))
    for count in (2, 3, 4):
        goal = bench.manip(count)
        assert (goal.goal, goal.attempt) == ("release", count - 1)
        bench.did(goal, "failed", "UNREACHABLE")
    assert bench.state.state == "ERROR"
    assert "holding the red mug" in bench.state.detail
    assert "COMPLETED" not in bench.states()


def test_silence_of_a_peer_ends_in_error() -> None:
    bench = Bench(BrainConfig(pipeline="fetch", navigation_timeout=10.0))
    bench.hear("bring me the red mug")
    bench.until(lambda: bench.state.state == "ERROR", limit=60.0)
    assert "TIMEOUT" in bench.state.detail
    assert bench.texts(NAV) == ["find red mug"] * 3 + ["stop"]


def test_unknown_things_are_refused_aloud() -> None:
    bench = start("bring me the stapler")
    assert bench.state.state == "ERROR"
    assert bench.texts(SPEECH)[-1] == "say I do not know what 'stapler' is."
    assert bench.sent(NAV) == []


def test_speech_status_ends_the_error_as_soon_as_it_is_said() -> None:
    bench = start("bring me the stapler")
    say = bench.sent(SPEECH)[-1]
    bench.send(topics.SPEECH_STATUS, m.SpeechStatus(state="speaking", goal_id=say.id))
    bench.step(4.0)
    assert bench.state.state == "ERROR"
    bench.send(topics.SPEECH_STATUS, m.SpeechStatus(state="idle", goal_id=say.id))
    bench.step(0.1)
    assert bench.states()[-2:] == ["WAITING", "LISTENING"]


def peer(bench: Bench, name: str) -> MemoryIo:
    return MemoryIo(bench.bus, name, (), (), household=HOME)


def test_a_restarted_peer_gets_the_goal_again_with_the_next_attempt() -> None:
    bench = Bench()
    old = peer(bench, "navigation")
    bench.hear("red mug")
    first = bench.nav(1)
    bench.bus.detach(old)
    bench.step(2.0)
    peer(bench, "navigation")
    bench.step(1.0)
    again = bench.sent(NAV)
    assert [(g.id, g.attempt) for g in again] == [(first.id, 1), (first.id, 2)]
    bench.drove(first)
    assert bench.state.state == "NAVIGATING"
    bench.drove(again[1])
    bench.manip(1)


def test_a_peer_that_stays_away_is_reported() -> None:
    bench = Bench()
    old = peer(bench, "navigation")
    bench.hear("red mug")
    bench.nav(1)
    bench.bus.detach(old)
    took = bench.until(lambda: bench.state.state == "ERROR")
    assert took < 40.0
    assert "NO_PEER" in bench.state.detail


def test_a_first_sign_of_life_is_no_restart() -> None:
    bench = start()
    bench.nav(1)
    peer(bench, "navigation")
    bench.step(5.0)
    assert len(bench.sent(NAV)) == 1


def test_typed_command_starts_a_mission_and_cancels_the_listening() -> None:
    bench = Bench()
    listen = bench.next_goal(SPEECH, 1)
    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text="bring me the apple"))
    bench.nav(1)
    assert bench.texts(SPEECH) == ["listen", "cancel"]
    bench.send(topics.SPEECH_RESULT, m.SpeechResult(text="blue mug", goal_id=listen.id))
    bench.step(1.0)
    assert bench.texts(NAV) == ["find apple"]


@pytest.mark.parametrize("word", ["cancel", "Stop!"])
def test_cancel_ends_the_mission_and_stops_the_robot(word: str) -> None:
    bench = start()
    bench.nav(1)
    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text=word))
    bench.until(lambda: len(bench.sent(SPEECH)) == 2)
    assert bench.texts(NAV) == ["find red mug", "stop"]
    assert bench.texts(MANIP) == ["stop"]
    assert bench.outcome == "cancelled"


def test_come_back_in_mid_mission() -> None:
    bench = start()
    bench.nav(1)
    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text="come back"))
    bench.drove(bench.nav(3))
    bench.until(lambda: bench.state.state == "COMPLETED")
    assert bench.texts(NAV) == ["find red mug", "stop", "return_to_start"]


def test_other_words_in_mid_mission_change_nothing() -> None:
    bench = start()
    bench.nav(1)
    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text="bring me the apple"))
    bench.drove(bench.nav(1))
    bench.manip(1)
    assert bench.texts(NAV) == ["find red mug"]


def test_robot_stop_cancels_and_waits_for_resume() -> None:
    bench = holding()
    bench.send(topics.ROBOT_STOP, m.RobotStop(reason="button"))
    bench.step(20.0)
    assert bench.state.state == "IDLE"
    last = bench.state.last
    assert last is not None
    assert (last.outcome, last.reason) == ("cancelled", "stopped: button; still holding the red mug")
    bench.send(topics.ROBOT_RESUME, m.RobotResume())
    bench.until(lambda: bench.state.state == "LISTENING", limit=5.0)


def test_an_interrupted_grab_is_settled_by_the_fingers() -> None:
    bench = start()
    bench.drove(bench.nav(1))
    bench.manip(1)
    bench.command("cancel")
    held = m.JointStates(t=1.0, name=["gripper"], position=[0.04], velocity=[0.0], effort=[20.0])
    bench.send(topics.JOINT_STATES, held)
    bench.hear("apple", count=2)
    bench.nav(3)
    assert bench.texts(NAV) == ["find red mug", "stop", "return_to_start"]


def fingers(bench: Bench, width: float, force: float) -> None:
    joints = m.JointStates(t=1.0, name=["gripper"], position=[width], velocity=[0.0], effort=[force])
    bench.send(topics.JOINT_STATES, joints)
    bench.step(1.0)


def test_an_object_lost_on_the_way_is_never_delivered() -> None:
    bench = holding()
    fingers(bench, 0.07, 30.0)
    back = bench.nav(2)
    fingers(bench, 0.0, 30.0)
    bench.drove(back)
    bench.until(lambda: bench.state.state == "ERROR")
    assert "LOST_OBJECT" in bench.state.detail
    assert bench.texts(MANIP) == ["grab"]
    assert "COMPLETED" not in bench.states()


def test_fingers_that_never_told_of_an_object_cannot_tell_of_its_loss() -> None:
    bench = holding()
    fingers(bench, 0.0, 0.0)
    bench.drove(bench.nav(2))
    bench.did(bench.manip(2))
    assert bench.state.state == "COMPLETED"


def test_the_survey_is_not_quoted_for_what_the_robot_moved() -> None:
    bench = Bench()
    mug = m.WorldObject(label="red mug", kind="mug", colour="red", position=(1.0, 2.0, 0.8))
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[mug]))
    bench.hear("red mug")
    bench = holding(bench)
    bench.drove(bench.nav(2))
    bench.did(bench.manip(2))
    bench.hear("red mug", count=2)
    bench.drove(bench.nav(3))
    assert bench.manip(3).object is None


def test_grab_names_the_surveyed_object() -> None:
    bench = Bench()
    mug = m.WorldObject(label="red mug", kind="mug", colour="red", position=(1.0, 2.0, 0.8))
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[mug]))
    bench.hear("red mug")
    bench.drove(bench.nav(1))
    ref = bench.manip(1).object
    assert ref is not None and (ref.label, ref.position) == ("red mug", (1.0, 2.0, 0.8))


def test_tree_is_published_on_change_only() -> None:
    bench = start()
    bench.nav(1)
    bench.step()
    count = len(bench.sent(topics.BRAIN_TREE))
    bench.step(5.0)
    assert len(bench.sent(topics.BRAIN_TREE)) == count
    tree = bench.sent(topics.BRAIN_TREE)[-1].root
    assert (tree.name, tree.status) == ("fetch pipeline", "RUNNING")


def test_missions_are_listed_with_their_timeline() -> None:
    bench = start()
    for count in (1, 2, 3):
        bench.drove(bench.nav(count), "failed", "BLOCKED")
    listed = bench.bus.get(topics.BRAIN_MISSIONS)
    assert listed is not None and b'"outcome":"failed"' in listed and b'"steps":2' in listed
    last = bench.state.last
    assert last is not None
    timeline = bench.bus.get(topics.BRAIN_MISSIONS, last.id.encode())
    assert timeline is not None and b"heard: bring me the red mug" in timeline and b"BLOCKED" in timeline
