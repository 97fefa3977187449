"""Without joint states nothing starts, a mission is suspended, and goes on after a look or ends in ERROR."""

from pathlib import Path
from typing import Any

import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryIo
from services.brain.mission.heartbeat import LIMIT
from tests.unit.brain_bench import JOINTS, Bench
from tests.unit.brain_world import SCENE, World
from tests.unit.test_brain_resume import PIPELINES, STATES, begun, delivered_once, finished
from tests.unit.test_brain_vla import SPEECH, asked

GOALS = (topics.NAVIGATION_GOAL, topics.MANIPULATION_GOAL)


def lost(world: World, seconds: float = LIMIT + 0.5) -> None:
    """The simulation says nothing any more, and what was under way with it does not go on."""
    world.silent = True
    world.step(LIMIT / 2)
    for peer in world.peers.values():
        peer.job = None
    world.step(seconds - LIMIT / 2)


def last(world: World, topic: Any) -> Any:
    return codec.decode(topic, world.bus.last[topic.key])


@pytest.mark.parametrize(("pipeline", "state"), [(p, s) for p in PIPELINES for s in STATES[p]])
def test_lost_in_each_state_it_stops_says_so_and_goes_on_when_they_return(
    pipeline: str, state: str, tmp_path: Path
) -> None:
    world = begun(pipeline, tmp_path / "j.db", at=state)
    mission = world.state.mission_id
    world.step(0.3)
    lost(world)
    assert (world.state.state, world.state.detail) == ("IDLE", "resuming: waiting for joint_states")
    assert world.state.mission_id == mission
    assert [last(world, topic).goal for topic in GOALS] == ["stop", "stop"]
    later = [world.bus.tap(topic) for topic in GOALS]
    world.step(20.0)
    assert later == [[], []] and not world.outcome
    world.silent = False
    finished(world)
    delivered_once(world)
    assert world.state.last is not None and world.state.last.id == mission
    assert "joint_states lost" in world.timeline()


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_what_stays_away_ends_in_a_spoken_error_and_a_resume_goes_on_later(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", heartbeat_patience=5.0, at="RETURNING")
    lost(world)
    world.until(lambda: world.state.state == "ERROR", 10.0)
    assert world.outcome == "failed" and "NO_JOINT_STATES" in world.state.detail
    assert last(world, topics.SYSTEM_STATUS).state == "ERROR"
    world.until(lambda: world.state.state == "IDLE", 20.0)
    assert any("lost contact with my motors" in words for words in world.said)
    assert world.state.detail == "waiting for joint_states"
    world.silent = False
    world.until(lambda: world.state.state in ("WAITING", "LISTENING"))
    world.step(5.0)
    assert world.outcome == "failed" and world.held
    world.bus.send(topics.ROBOT_RESUME, m.RobotResume(go_on=True))
    world.until(lambda: world.outcome == "delivered")
    delivered_once(world)


def test_what_fell_meanwhile_is_fetched_again(tmp_path: Path) -> None:
    world = begun("vla", tmp_path / "j.db", at="RETURNING")
    lost(world)
    world.silent, world.held, world.item_at = False, "", "item"
    finished(world)
    assert (world.grabs, world.releases, world.item_at) == (2, 1, "home"), world.timeline()


def test_a_pause_of_the_simulation_is_no_loss_for_good(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", heartbeat_patience=5.0, at="RETURNING")
    world.bus.send(topics.SIM_STATUS, m.SimStatus(state="paused"))
    lost(world, 30.0)
    assert world.state.state == "IDLE" and not world.outcome
    world.silent = False
    finished(world)
    delivered_once(world)


@pytest.mark.parametrize(
    ("sim", "others", "suspended"), [(False, True, True), (True, True, False), (False, False, False)]
)
def test_robot_time_that_stands_still_is_a_loss_when_the_simulation_alone_is_gone(
    sim: bool, others: bool, suspended: bool, tmp_path: Path
) -> None:
    world = begun("vla", tmp_path / "j.db", at="NAVIGATING")
    kept = MemoryIo(world.bus, "sim", (), (), household=SCENE, lockstep=False) if sim else None
    if not others:
        for peer in world.peers.values():
            world.bus.ios.pop(peer.name)
    assert world.brain is not None
    for seconds in (LIMIT + 0.1, LIMIT + 0.2):
        world.brain.stalled(seconds)
    assert (world.state.state == "IDLE") == suspended
    if suspended:
        # Robot time still stands: only the seconds that pass for people can end the patience.
        world.brain.stalled(world.config.heartbeat_patience + 1.0)
        assert world.state.state == "ERROR" and last(world, topics.SYSTEM_STATUS).state == "ERROR"
    if kept is not None:
        world.bus.detach(kept)


def test_listening_ends_with_the_joint_states_and_begins_again_with_them() -> None:
    bench = Bench(joints=False)
    bench.step(3.0)
    assert (bench.state.state, bench.state.detail) == ("IDLE", "waiting for joint_states")
    bench.joints = JOINTS
    bench.next_goal(SPEECH, 1)
    # As old as they may be at a rate that is still good enough.
    for _ in range(3):
        bench.joints = None
        bench.step(LIMIT - 0.1)
        bench.joints = JOINTS
        bench.step()
    assert bench.state.state == "LISTENING"
    bench.joints = None
    bench.until(lambda: bench.state.state == "IDLE", LIMIT + 1.0)
    assert bench.texts(SPEECH) == ["listen", "cancel"]
    bench.joints = JOINTS
    assert bench.next_goal(SPEECH, 3).goal == "listen"


def listened(bench: Bench, count: int) -> m.SpeechGoal:
    bench.until(lambda: bench.texts(SPEECH).count("listen") == count)
    return [g for g in bench.sent(SPEECH) if g.goal == "listen"][-1]


@pytest.mark.parametrize("failure", ["ERROR", ""])
def test_speech_that_fails_in_the_dialogue_costs_five_seconds(failure: str) -> None:
    bench = asked()
    listen = listened(bench, 1)
    if failure:
        bench.send(topics.SPEECH_RESULT, m.SpeechResult(text=failure, goal_id=listen.id, code="UNCERTAIN"))
    failed = bench.now
    if not failure:
        bench.until(lambda: bench.state.detail == "pause after a speech failure")
        failed += bench.brain.context.config.answer_timeout
    bench.until(lambda: bench.texts(SPEECH).count("say Did you say bring me the red mug?") == 2)
    assert 5.0 <= bench.now - failed <= 5.3
    listened(bench, 2)


def test_a_typed_answer_cuts_the_pause_short() -> None:
    bench = asked()
    bench.send(topics.SPEECH_RESULT, m.SpeechResult(text="ERROR", goal_id=listened(bench, 1).id))
    bench.step(2.0)
    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text="yes"))
    bench.step(0.2)
    assert bench.state.state == "PLANNING" and len(bench.texts(SPEECH)) == 2


def test_a_no_is_no_failure_of_speech() -> None:
    bench = asked()
    bench.send(topics.SPEECH_RESULT, m.SpeechResult(text="no", goal_id=listened(bench, 1).id))
    assert bench.until(lambda: "say Please say it again." in bench.texts(SPEECH)) < 1.5
