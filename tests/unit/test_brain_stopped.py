"""A stop ends the mission; a resume that asks for it goes on with it after a look at the world, any other does not."""

from pathlib import Path

import pytest

from common import messages as m
from common import topics
from tests.unit.brain_world import World
from tests.unit.test_brain_resume import PIPELINES, STATES, begun, delivered_once, finished, stopped_while_down


def stop(world: World) -> None:
    """As the simulation and the peers take it: all that was under way is dropped."""
    world.bus.send(topics.ROBOT_STOP, m.RobotStop(reason="button"))
    world.bus.send(topics.SIM_STATUS, m.SimStatus(state="stopped", detail="button"))
    for peer in world.peers.values():
        peer.job = None
    world.step(3.0)
    assert world.state.state == "IDLE" and world.outcome == "cancelled"


def resume(world: World, go_on: bool) -> None:
    world.bus.send(topics.SIM_STATUS, m.SimStatus(state="running"))
    world.bus.send(topics.ROBOT_RESUME, m.RobotResume(go_on=go_on))


def go_on(world: World) -> None:
    """Resume, and come to the mission's end."""
    resume(world, go_on=True)
    world.until(lambda: world.outcome == "delivered")


@pytest.mark.parametrize(("pipeline", "state"), [(p, s) for p in PIPELINES for s in STATES[p]])
def test_stopped_in_each_state_it_goes_on(pipeline: str, state: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at=state)
    mission = world.state.mission_id
    world.step(0.3)
    stop(world)
    resume(world, go_on=True)
    world.until(lambda: world.state.mission_id == mission)
    world.until(lambda: world.outcome == "delivered")
    finished(world)
    delivered_once(world)
    assert world.state.last is not None and world.state.last.id == mission and not world.state.last.resumable


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_plain_resume_only_releases(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at="RETURNING")
    stop(world)
    drives = list(world.drives)
    resume(world, go_on=False)
    world.step(10.0)
    assert world.outcome == "cancelled" and world.drives == drives and world.held
    assert world.state.last is not None and world.state.last.resumable
    # Who thinks better of it later may still go on.
    go_on(world)
    delivered_once(world)


def test_a_hand_that_closed_just_before_the_stop_is_noticed_by_the_grab_itself(tmp_path: Path) -> None:
    world = begun("vla", tmp_path / "j.db", at="GRABBING")
    stop(world)
    world.held, world.item_at = "red mug", "hand"
    go_on(world)
    assert (world.grabs, world.releases, world.drives) == (0, 1, ["item", "home"]), world.timeline()


def test_what_fell_while_stopped_is_fetched_again(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="RELEASING")
    stop(world)
    world.held, world.item_at = "", "item"
    go_on(world)
    assert (world.grabs, world.releases, world.item_at) == (2, 1, "home"), world.timeline()


def test_a_mission_that_was_called_off_is_not_gone_on_with(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="RETURNING")
    world.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="cancel"))
    world.step(1.0)
    drives = list(world.drives)
    resume(world, go_on=True)
    world.step(8.0)
    assert world.outcome == "cancelled" and world.drives == drives


def test_stopped_while_the_brain_was_down_it_goes_on_when_asked(tmp_path: Path) -> None:
    world = begun("vla", tmp_path / "j.db")
    stopped_while_down(world, "button", 5.0)
    assert world.state.state == "IDLE" and world.outcome == "cancelled"
    go_on(world)
    delivered_once(world)


def test_the_journal_tells_of_both(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="NAVIGATING")
    stop(world)
    go_on(world)
    story = world.timeline()
    assert "stopped: button" in story and "resumed" in story
    finished(world)
    world.restart_brain()
    world.step(1.0)
    assert world.state.last is not None and world.state.last.outcome == "delivered"


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_brain_that_dies_while_stopped_still_knows(pipeline: str, tmp_path: Path) -> None:
    world = begun(pipeline, tmp_path / "j.db", at="RETURNING")
    mission = world.state.mission_id
    stop(world)
    world.restart_brain()
    world.step(3.0)
    assert world.outcome == "cancelled" and not world.state.mission_id
    go_on(world)
    delivered_once(world)
    assert world.state.last is not None and world.state.last.id == mission


def test_a_new_command_takes_the_place_of_what_was_put_off(tmp_path: Path) -> None:
    world = begun("fetch", tmp_path / "j.db", at="NAVIGATING")
    stop(world)
    resume(world, go_on=False)
    world.until(lambda: world.state.state in ("WAITING", "LISTENING"))
    world.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="come back", confirmed=True))
    world.until(lambda: world.outcome == "delivered")
    grabs = world.grabs
    resume(world, go_on=True)
    world.step(10.0)
    assert world.grabs == grabs and world.state.state in ("WAITING", "LISTENING")
