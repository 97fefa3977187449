"""Whole missions: every service, in lockstep in one process, judged by physics."""

import hashlib
from pathlib import Path

import pytest

from common import topics
from common.sound import read_wav
from tests.mission import Outcome, Robot, fetch

pytestmark = pytest.mark.long

VOICE = Path(__file__).parents[3] / "docs" / "audio" / "bring_me_the_red_mug.wav"
FLOW = ["LISTENING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING", "COMPLETED", "LISTENING"]


def seen(outcome: Outcome) -> list[str]:
    """The states without WAITING, which lasts a single step."""
    return [s for s in outcome.states if s != "WAITING"]


@pytest.mark.timeout(420)  # by ray casting, five times as slow as with GL, on a machine that does other work
def test_a_recorded_voice_brings_the_mug_home() -> None:
    robot = Robot(seed=7)  # in the next room: half the way of most
    outcome = fetch(robot, "red mug", speech=read_wav(VOICE))
    assert outcome.claimed == "delivered", outcome.reason
    assert outcome.objections == []
    assert seen(outcome) == FLOW


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "item"), [(3, "apple"), (2, "blue bottle"), (10, "yellow block")])
def test_other_things_are_brought_as_well(seed: int, item: str) -> None:
    robot = Robot(seed=seed)
    outcome = fetch(robot, item)
    assert outcome.claimed == "delivered", outcome.reason
    assert outcome.objections == []


def trajectory(seed: int) -> str:
    robot = Robot(seed=seed)
    digest = hashlib.sha256()
    robot.advance(0.5)
    robot.bus.put(topics.SPEECH_TEXT, b"bring me the red mug")
    for _ in range(40):
        robot.advance(0.2)
        digest.update(robot.sim.physics.data.qpos.tobytes())
    return digest.hexdigest()


@pytest.mark.slow
def test_a_seed_repeats_to_the_last_bit_and_another_differs() -> None:
    assert trajectory(5) == trajectory(5)
    assert trajectory(5) != trajectory(6)


def test_an_item_nobody_has_seen_is_an_error_and_not_a_delivery() -> None:
    robot = Robot("minimal", seed=0)
    robot.advance(0.5)
    robot.bus.put(topics.SPEECH_TEXT, b"bring me the banana")
    states = []
    for _ in range(200):
        robot.advance(0.1)
        states.append(robot.state().state)
    assert "GRABBING" not in states and "COMPLETED" not in states
    assert states[-1] in ("WAITING", "LISTENING", "ERROR")
