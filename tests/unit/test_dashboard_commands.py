"""What visitors do, as it arrives on the bus."""

from math import pi
from typing import Any

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from common.mission_log.transcript import Transcript
from common.topic import Topic
from services.dashboard.commands import CHUNK, LONGEST, TRAILING, Commands
from services.dashboard.scene.picking import Picked

WRITES = (
    topics.VOICE_COMMAND,
    topics.ROBOT_STOP,
    topics.ROBOT_RESUME,
    topics.NAV_GOAL,
    topics.AUDIO_PCM,
    topics.TEACH,
    topics.HOUSEHOLD_EDIT,
)
READY = m.BrainState(state="LISTENING")


class Desk:
    """Commands on a bus whose every message is kept."""

    def __init__(self) -> None:
        self.bus = MemoryBus()
        self.io = MemoryIo(self.bus, "dashboard", (), WRITES, household=load_household("minimal"), lockstep=False)
        self.transcript = Transcript()
        self.commands = Commands(self.io, self.transcript)
        self._taps = {topic.key: self.bus.tap(topic) for topic in WRITES}

    def sent(self, topic: Topic[Any]) -> list[Any]:
        return [codec.decode(topic, payload) for payload in self._taps[topic.key]]

    def everything(self) -> int:
        return sum(len(tap) for tap in self._taps.values())


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_stop_and_resume(desk: Desk) -> None:
    desk.commands.words("stop", "", 1.0)
    assert [s.source for s in desk.sent(topics.ROBOT_STOP)] == ["page"]
    assert desk.sent(topics.ROBOT_RESUME) == []
    desk.commands.words("resume", "", 2.0)
    desk.commands.words("go on", "", 3.0)
    assert [(r.source, r.go_on) for r in desk.sent(topics.ROBOT_RESUME)] == [("page", False), ("page", True)]


def test_typed_words_are_a_command_that_needs_no_question(desk: Desk) -> None:
    desk.commands.words("say", "  bring me the red mug ", 1.0)
    (command,) = desk.sent(topics.VOICE_COMMAND)
    assert (command.text, command.confirmed) == ("bring me the red mug", True)
    assert command.id
    assert desk.transcript.lines[-1].text == "bring me the red mug"


@pytest.mark.parametrize("word", ["yes", "no"])
def test_answers(desk: Desk, word: str) -> None:
    desk.commands.words(word, "", 1.0)
    assert [c.text for c in desk.sent(topics.VOICE_COMMAND)] == [word]


@pytest.mark.parametrize(("do", "text"), [("say", "  "), ("dance", "x"), ("", ""), ("robot/stop", "")])
def test_anything_else_is_counted_and_does_nothing(desk: Desk, do: str, text: str) -> None:
    desk.commands.words(do, text, 1.0)
    assert desk.everything() == 0
    assert desk.io.drops["page"] == 1


def test_a_name_goes_to_what_is_clicked_on_next_also_during_a_mission(desk: Desk) -> None:
    busy = m.BrainState(state="NAVIGATING")
    desk.commands.words("name", " vitamin box ", 1.0)
    desk.commands.picked(Picked("white box"), (0.0, 0.0, 0.0), busy, 2.0)
    desk.commands.picked(Picked("red mug"), (0.0, 0.0, 0.0), busy, 3.0)
    (request,) = desk.sent(topics.TEACH)
    assert (request.name, request.label, request.forget) == ("vitamin box", "white box", False) and request.id
    assert desk.sent(topics.VOICE_COMMAND) == []


def test_a_name_and_a_click_on_the_floor_do_nothing(desk: Desk) -> None:
    desk.commands.words("name", "vitamin box", 1.0)
    desk.commands.picked(Picked(point=(1.0, 3.0)), (0.0, 0.0, 0.0), READY, 2.0)
    assert desk.everything() == 0 and "vitamin box" in desk.transcript.lines[-1].text


def test_a_name_for_a_part_of_the_home_goes_to_what_was_clicked_on(desk: Desk) -> None:
    desk.commands.words("name", "writing desk", 1.0)
    desk.commands.picked(Picked("red mug", hit=(1.0, 2.0, 0.7)), (0.0, 0.0, 0.0), m.BrainState(state="NAVIGATING"), 2.0)
    (edit,) = desk.sent(topics.HOUSEHOLD_EDIT)
    assert (edit.do, edit.name, edit.position) == ("name", "writing desk", (1.0, 2.0, 0.7)) and edit.id
    assert desk.sent(topics.TEACH) == [] and desk.commands.naming == ""
    desk.commands.edited(m.EditResult(goal_id=edit.id, ok=True, name="writing desk", kind="surface"), 3.0)
    desk.commands.edited(m.EditResult(goal_id="b", ok=False, name="mug", detail="mug means a kind"), 3.0)
    assert [line.text for line in desk.transcript.lines][-2:] == [
        "the name writing desk is kept", "mug was not kept: mug means a kind",
    ]  # fmt: skip


def test_what_came_of_a_name_is_told(desk: Desk) -> None:
    desk.commands.taught(m.TeachResult(goal_id="a", ok=True, name="vitamin box", label="white box"), 1.0)
    desk.commands.taught(m.TeachResult(goal_id="b", ok=False, name="mug", detail="mug means every mug already"), 2.0)
    assert [line.text for line in desk.transcript.lines] == [
        "the white box is the vitamin box from now on",
        "mug was not learnt: mug means every mug already",
    ]


def test_a_click_on_the_floor_drives_there_facing_away(desk: Desk) -> None:
    desk.commands.picked(Picked(point=(1.0, 3.0)), (1.0, 1.0, 0.0), READY, 1.0)
    (goal,) = desk.sent(topics.NAV_GOAL)
    assert (goal.x, goal.y, goal.frame) == (1.0, 3.0, "map")
    assert goal.theta == pytest.approx(pi / 2)


def test_a_click_on_an_object_fetches_it(desk: Desk) -> None:
    desk.commands.picked(Picked("green can"), (0.0, 0.0, 0.0), READY, 1.0)
    assert [c.text for c in desk.sent(topics.VOICE_COMMAND)] == ["bring me the green can"]
    assert desk.sent(topics.NAV_GOAL) == []


@pytest.mark.parametrize("state", [None, m.BrainState(state="GRABBING"), m.BrainState(state="IDLE")])
def test_clicks_do_nothing_during_a_mission(desk: Desk, state: m.BrainState | None) -> None:
    for picked in (Picked("green can"), Picked(point=(1.0, 1.0)), Picked()):
        desk.commands.picked(picked, (0.0, 0.0, 0.0), state, 1.0)
    assert desk.everything() == 0


def test_sound_goes_out_in_even_chunks_and_ends_in_silence(desk: Desk) -> None:
    rng = np.random.default_rng(0)
    said = rng.integers(-9000, 9000, 16000 * 2 + 777, dtype=np.int16).astype("<i2").tobytes()
    for start in range(0, len(said), 1998):
        desk.commands.sound(said[start : start + 1998], 5.0)
    desk.commands.sound(b"", 7.0)
    chunks = desk.sent(topics.AUDIO_PCM)
    assert b"".join(c.data for c in chunks)[: len(said)] == said
    assert {len(c.data) for c in chunks} == {CHUNK}
    assert [c.end for c in chunks].count(True) == 1
    assert chunks[-1].end
    assert [c.seq for c in chunks] == list(range(len(chunks)))
    assert all(not any(c.data) for c in chunks[-TRAILING:])
    assert all(c.addressed for c in chunks)


def test_silence_ends_only_what_has_begun(desk: Desk) -> None:
    desk.commands.sound(b"", 1.0)
    assert desk.everything() == 0


def test_a_second_utterance_starts_anew(desk: Desk) -> None:
    for _ in range(2):
        desk.commands.sound(bytes(CHUNK), 1.0)
        desk.commands.sound(b"", 1.0)
    assert [c.seq for c in desk.sent(topics.AUDIO_PCM)].count(0) == 2


def test_a_button_held_for_ever_does_not_talk_for_ever(desk: Desk) -> None:
    for _ in range(LONGEST + 50):
        desk.commands.sound(bytes(CHUNK), 1.0)
    assert len(desk.sent(topics.AUDIO_PCM)) == LONGEST


def test_half_a_sample_is_refused(desk: Desk) -> None:
    desk.commands.sound(b"\0\0\0", 1.0)
    assert desk.everything() == 0
    assert desk.io.drops[topics.AUDIO_PCM.key] == 1
