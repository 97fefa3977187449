"""A brain killed at any moment of a mission: the mission goes on, nothing is done twice, nothing old is begun."""

import json
import random
import sqlite3
from pathlib import Path
from typing import Any

import msgspec
import pytest

from common import messages as m
from common import topics
from tests.unit.brain_world import World

PIPELINES = ["fetch", "vla"]
STATES = {
    "fetch": ["NAVIGATING", "GRABBING", "RETURNING", "RELEASING"],
    "vla": ["CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING"],
}


def begun(pipeline: str, path: Path, at: str = "", **parameters: Any) -> World:
    """A world in which the mug is asked for, `at` a state of that mission."""
    world = World(pipeline, path, **parameters)
    if pipeline == "vla":
        world.until(lambda: world.state.state == "WAITING")
        world.asked = True
        world.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="bring me the red mug"))
    if at:
        world.until(lambda: world.state.state == at)
    return world


def finished(world: World) -> None:
    world.until(lambda: world.state.last is not None and world.state.state in ("WAITING", "LISTENING"))


def delivered_once(world: World) -> None:
    assert world.outcome == "delivered", world.timeline()
    assert (world.grabs, world.releases, world.held, world.item_at) == (1, 1, "", "home"), world.timeline()


def stopped_while_down(world: World, why: str, seconds: float) -> None:
    """The brain dies on the way home, the robot is stopped, the brain comes back for so many seconds."""
    world.until(lambda: world.state.state == "RETURNING")
    world.kill_brain()
    world.bus.send(topics.SIM_STATUS, m.SimStatus(state="stopped", detail=why))
    world.step(1.0)
    world.start_brain()
    world.step(seconds)


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_without_a_kill_it_is_delivered(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db")
    finished(world)
    delivered_once(world)
    assert world.drives == ["item", "home"]


@pytest.mark.parametrize(("into", "down"), [(0.0, 0.3), (1.0, 8.0), (2.5, 0.3)])
@pytest.mark.parametrize(("pipeline", "state"), [(p, s) for p in PIPELINES for s in STATES[p]])
def test_killed_in_each_state(pipeline: str, state: str, down: float, into: float, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at=state)
    mission = world.state.mission_id
    world.step(into)
    world.restart_brain(down=down)
    finished(world)
    delivered_once(world)
    assert world.state.last is not None and world.state.last.id == mission
    # No completed drive was made again.
    assert world.drives == ["item", "home"], world.timeline()


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_nodes_may_be_shown_under_other_names_after_the_restart(
    pipeline: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = begun(pipeline, tmp_path / "j.db", at="RETURNING")
    world.kill_brain()
    monkeypatch.setattr("services.brain.tree.composites.shown", lambda node_id, name="": f"<{node_id}>")
    world.start_brain()
    assert world.brain is not None and world.brain.tree.name.startswith("<")
    finished(world)
    delivered_once(world)
    assert world.drives == ["item", "home"], world.timeline()


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_journal_of_a_version_with_other_nodes_is_refused_in_words(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at="RETURNING")
    world.kill_brain()
    with sqlite3.connect(tmp_path / "j.db") as file:
        body = json.loads(file.execute("select body from checkpoint").fetchone()[0])
        body["path"] = [{"index": 3, "name": "mission", "used": 0}, {"index": 0, "name": "do", "used": 0}]
        file.execute("update checkpoint set format = 1, body = ?", (json.dumps(body).encode(),))
    world.start_brain()
    world.until(lambda: world.outcome == "failed")
    assert world.state.last is not None and world.state.last.code == "OLD_JOURNAL"
    assert world.state.last.reason.endswith(
        "another version of the brain wrote the journal); still holding the red mug"
    )


@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("seed", range(4))
def test_killed_again_and_again(pipeline: str, seed: int, tmp_path: Path) -> None:
    dice = random.Random(seed)
    world = begun(pipeline, tmp_path / "j.db")
    kills = 0
    while world.state.last is None:
        world.step(dice.uniform(0.05, 4.0))
        if kills < 9 and world.state.last is None and world.state.state not in ("LISTENING", "WAITING"):
            world.restart_brain(down=dice.choice((0.05, 0.5, 5.0)))
            kills += 1
    delivered_once(world)
    assert kills > 0


@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("state", ["NAVIGATING", "GRABBING", "RETURNING", "RELEASING"])
def test_killed_with_the_peers(pipeline: str, state: str, tmp_path: Path) -> None:
    """As after a power cut: nobody remembers anything but the journal."""
    world = begun(pipeline, tmp_path / "j.db", at=state)
    world.step(1.0)
    world.kill_brain()
    for name in list(world.peers):
        world.restart(name)
    world.step(1.0)
    world.start_brain()
    finished(world)
    delivered_once(world)


# --- the world has changed meanwhile
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_an_object_lost_while_the_brain_was_down_is_fetched_again(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at="RETURNING")
    world.step(1.0)
    world.kill_brain()
    world.held, world.item_at = "", "item"
    world.step(1.0)
    world.start_brain()
    finished(world)
    assert world.outcome == "delivered" and world.item_at == "home", world.timeline()
    assert (world.grabs, world.releases) == (2, 1) and "not in the hand any more" in world.timeline()


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_an_object_that_is_in_the_hand_already_is_not_fetched_again(pipeline: str, tmp_path: Path) -> None:
    """As when the last checkpoints did not reach the disk."""
    world = begun(pipeline, tmp_path / "j.db", at="NAVIGATING")
    world.kill_brain()
    world.step(5.0)
    world.held, world.item_at = "red mug", "hand"
    world.start_brain()
    finished(world)
    assert world.outcome == "delivered" and world.item_at == "home", world.timeline()
    assert (world.grabs, world.releases) == (0, 1) and "in the hand already" in world.timeline()


@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("state", ["GRABBING", "RELEASING"])
def test_a_base_that_was_moved_drives_there_again(pipeline: str, state: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at=state)
    world.kill_brain()
    world.restart("manipulation")
    world.place = "elsewhere"
    world.step(1.0)
    world.start_brain()
    finished(world)
    delivered_once(world)
    assert world.drives == (["item", "item", "home"] if state == "GRABBING" else ["item", "home", "home"])


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_simulation_begun_anew_is_looked_at_anew(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at="GRABBING")
    world.kill_brain()
    for name in list(world.peers):
        world.restart(name)
    world.now, world.place = 1.0, "home"
    world.start_brain()
    finished(world)
    delivered_once(world)
    assert "began anew" in world.timeline()


# --- what is not taken up
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_an_ended_mission_is_over(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at="COMPLETED")
    world.restart_brain(down=0.5)
    world.step(20.0)
    delivered_once(world)
    assert world.state.state in ("WAITING", "LISTENING") and world.drives == ["item", "home"]


def test_a_failed_mission_is_over_and_the_hand_stays_known(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", navigation_timeout=2.0, navigation_retries=0)
    world.until(lambda: world.state.state == "ERROR", limit=60)
    world.restart_brain()
    world.step(5.0)
    assert world.outcome == "failed" and world.state.state == "LISTENING"


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_robot_stopped_while_the_brain_was_down_stays_stopped(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db")
    stopped_while_down(world, "a hand on the button", 20.0)
    assert world.state.state == "IDLE" and "stopped" in world.state.detail
    assert world.outcome == "cancelled" and "holding the red mug" in (
        world.state.last.reason if world.state.last else ""
    )
    drives = list(world.drives)
    world.bus.send(topics.SIM_STATUS, m.SimStatus(state="running"))
    world.bus.send(topics.ROBOT_RESUME, m.RobotResume())
    world.step(10.0)
    assert world.drives == drives and world.held and world.state.state in ("WAITING", "LISTENING")


def test_what_is_in_the_hand_outlives_a_mission_that_was_called_off(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="RETURNING")
    world.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="cancel"))
    world.step(1.0)
    world.restart_brain()
    world.until(lambda: world.state.state == "LISTENING")
    world.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="bring me the red mug"))
    world.until(lambda: world.outcome == "delivered")
    assert (world.grabs, world.releases, world.item_at) == (1, 1, "home"), world.timeline()


def test_an_orderly_end_ends_the_mission(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="RETURNING")
    world.end_brain()
    world.start_brain()
    world.step(10.0)
    assert world.outcome == "cancelled" and "shut down); still holding the red mug" in world.state.last.reason  # type: ignore[union-attr]
    assert world.held and world.state.state == "LISTENING"


def test_within_a_run_an_orderly_restart_goes_on(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", run="run-1", at="RETURNING")
    world.end_brain()
    world.start_brain()
    finished(world)
    delivered_once(world)


def test_a_mission_of_long_ago_is_not_taken_up(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", resume_within=-1.0, at="RETURNING")
    world.restart_brain()
    world.step(10.0)
    assert world.outcome == "failed" and "TOO_LATE" in world.state.last.reason and world.held  # type: ignore[union-attr]


def test_a_mission_that_kills_its_brain_is_given_up(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="GRABBING")
    for _ in range(15):
        world.peers["manipulation"].job = None
        world.restart_brain()
        world.step(1.0)
        if world.state.last is not None:
            break
    assert world.outcome == "failed" and "CRASH_LOOP" in world.state.last.reason  # type: ignore[union-attr]


def test_a_mission_of_another_pipeline_is_given_up_honestly(tmp_path: Path) -> None:
    world = begun("vla", tmp_path / "j.db", at="NAVIGATING")
    world.kill_brain()
    world.config = type(world.config)(pipeline="fetch", journal=world.config.journal)
    world.start_brain()
    world.step(0.7)
    assert world.outcome == "failed" and "CANNOT_RESUME" in world.state.last.reason  # type: ignore[union-attr]


def test_cancel_is_heard_while_looking(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="RETURNING")
    world.restart_brain()
    world.step(0.2)
    world.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="cancel"))
    world.step(10.0)
    assert world.outcome == "cancelled" and world.held and world.drives == ["item"]


# --- ids
def test_ids_never_come_again(tmp_path: Path) -> None:
    path = tmp_path / "j.db"
    meant: dict[str, str] = {}
    for _ in range(4):
        world = World("fetch", path)
        taps = [world.bus.tap(t) for t in (topics.SPEECH_GOAL, topics.NAVIGATION_GOAL, topics.MANIPULATION_GOAL)]
        world.kill_brain()
        world.start_brain(lockstep=True)
        world.step(4.0)
        world.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="cancel"))
        world.step(2.0)
        for goal in [msgspec.json.decode(payload) for tap in taps for payload in tap]:
            assert meant.setdefault(goal["id"], goal["goal"]) == goal["goal"]
        world.kill_brain()
    assert sum(text == "listen" for text in meant.values()) >= 4 and len(meant) >= 12
