"""Always listening: the wake word, stop and cancel, push-to-talk; with real models on the robot's own voice."""

from collections.abc import Iterator

import msgspec
import numpy as np
import pytest

from common import config, topics
from common import messages as m
from common.household import load_household
from common.language.normalise import normalise
from common.sound import RATE, Samples
from services.speech.config import SpeechConfig
from services.speech.listen.segmenter import Segment, Segmenter
from services.speech.recognise.free_text import UNLISTED
from services.speech.recognise.front_end import FrontEnd
from services.speech.recognise.recogniser import grammars
from services.speech.service import SpeechService
from services.speech.speak.voice import Voice
from tests.node import Node
from tests.support import ROOT

pytestmark = pytest.mark.long

SCENE = load_household("apartment")
CONFIG = config.load("speech", SpeechConfig, ROOT / "config", config.overrides({}, ["speech.preload=false"]))
BREATH, PAUSE = np.zeros(RATE // 2, np.int16), np.zeros(RATE, np.int16)
SENTENCES = (
    "hey jarvis", "hey jarvis, bring me the red mug", "hey jarvis, the weather is nice today", "hey jarvis, stop",
    "bring me the red mug", "the weather is nice today", "stop", "cancel", "yes",
    "hey jarvis, bring me the vitamin box", "hey jarvis, this is my vitamin box",
    "hey jarvis, bring me the oat milk", "hey travis, bring me the red mug",
    "put the apple next to", "the red mug",
)  # fmt: skip


@pytest.fixture(scope="module")
def said() -> dict[str, Samples]:
    voice = Voice()
    return {text: np.concatenate([BREATH, voice.speak(text), PAUSE]) for text in SENTENCES}


class Robot(Node):
    """The service in lockstep, and what it published."""

    def __init__(self, **changes: object) -> None:
        super().__init__(SpeechService, msgspec.structs.replace(CONFIG, **changes), SCENE)
        self.commands = self.bus.tap(topics.VOICE_COMMAND)
        self.unclear = self.bus.tap(topics.SPEECH_UNCLEAR)
        self.stops = self.bus.tap(topics.ROBOT_STOP)
        self.results = self.bus.tap(topics.SPEECH_RESULT)
        self.sound = self.bus.tap(topics.AUDIO_OUT)
        self.statuses = self.bus.tap(topics.SPEECH_STATUS)

    def ask(self, text: str, goal_id: str) -> None:
        self.bus.send(topics.SPEECH_GOAL, m.SpeechGoal(goal=text, id=goal_id))
        self.step()

    def hear(self, samples: Samples, addressed: bool = False, after: float = 1.0) -> None:
        for start in range(0, len(samples), RATE // 10):
            data = samples[start : start + RATE // 10].tobytes()
            self.bus.send(topics.AUDIO_PCM, m.AudioChunk(t=self.now, data=data, addressed=addressed))
            self.step()
        self.step(after)

    def commanded(self) -> list[str]:
        return [msgspec.json.decode(p, type=m.VoiceCommand).text for p in self.commands]

    def answered(self) -> list[str]:
        return [msgspec.json.decode(p, type=m.SpeechResult).text for p in self.results]

    def states(self) -> list[str]:
        return [msgspec.json.decode(p, type=m.SpeechStatus).state for p in self.statuses]

    def published(self) -> tuple[list[bytes], ...]:
        return self.commands, self.stops, self.results, self.statuses, self.sound


@pytest.fixture
def robot() -> Iterator[Robot]:
    made = Robot()
    yield made
    made.io.shutdown()


def test_the_wake_word_and_a_command_in_one_breath(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["hey jarvis, bring me the red mug"])
    assert robot.commanded() == ["bring me the red mug"]
    command = msgspec.json.decode(robot.commands[0], type=m.VoiceCommand)
    assert 0.5 < command.confidence <= 1.0 and not command.confirmed
    assert not robot.stops and not robot.results


@pytest.mark.slow
def test_a_command_may_follow_the_wake_word_after_a_pause_but_only_one(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["hey jarvis"])
    assert robot.states()[-1] == "listening" and not robot.commands
    robot.hear(said["bring me the red mug"])
    assert robot.commanded() == ["bring me the red mug"]
    assert robot.states()[-1] == "idle"
    robot.hear(said["bring me the red mug"])
    assert len(robot.commands) == 1


@pytest.mark.slow
def test_a_command_may_pause_in_the_middle(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["hey jarvis"])
    parts = [said["put the apple next to"], said["the red mug"], PAUSE]
    robot.hear(np.concatenate(parts), after=4.0)
    assert robot.commanded() == ["put the apple next to the red mug"]
    assert "speaking" not in robot.states()


@pytest.mark.slow
def test_who_says_it_again_after_nonsense_is_understood(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["hey jarvis"])
    robot.hear(said["the weather is nice today"], after=0.0)
    robot.hear(said["bring me the red mug"], after=4.0)
    assert len(robot.commands) == 1 and robot.commanded()[0].endswith("bring me the red mug")


def test_speech_to_somebody_else_is_ignored(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["bring me the red mug"])
    robot.hear(said["the weather is nice today"])
    robot.hear(said["yes"])
    assert not robot.commands and not robot.results and not robot.stops
    assert robot.states() == [], "no change from the idle it began with"


@pytest.mark.slow
def test_what_is_no_command_after_the_wake_word_the_brain_weighs_once_and_the_window_stays(
    robot: Robot, said: dict[str, Samples]
) -> None:
    robot.hear(said["hey jarvis, the weather is nice today"], after=4.0)
    assert not robot.commands
    words = msgspec.json.decode(robot.unclear[0], type=m.VoiceCommand)
    assert (words.text, words.confidence) == ("the weather is nice today", 0.0)
    robot.ask(f"say {m.NOT_UNDERSTOOD}", "g1")
    robot.step(6.0)
    statuses = [msgspec.json.decode(p, type=m.SpeechStatus) for p in robot.statuses]
    assert [s.code for s in statuses if s.code] == ["NO_COMMAND"]
    assert robot.states()[-2:] == ["speaking", "listening"]
    robot.hear(said["the weather is nice today"])
    assert len(robot.unclear) == 1, "no television is talked to for ever"
    robot.hear(said["bring me the red mug"])
    assert robot.commanded() == ["bring me the red mug"]
    robot.step(CONFIG.wake_window + 1)
    assert robot.states()[-1] == "idle"


def test_what_the_detector_took_for_the_wake_word_is_verified_by_what_else_was_heard(said: dict[str, Samples]) -> None:
    robot = Robot(wake_threshold=1e-9)
    robot.hear(said["bring me the red mug"])
    assert robot.states()[-1] == "idle" and not robot.commands, "nothing is said about it either"
    robot.hear(said["hey jarvis, bring me the red mug"])
    assert robot.commanded() == ["bring me the red mug"]
    robot.io.shutdown()


@pytest.mark.slow
def test_a_verified_wake_word_is_no_part_of_what_was_transcribed(said: dict[str, Samples]) -> None:
    front_end = FrontEnd(CONFIG, SCENE, grammars(CONFIG, SCENE))
    right = front_end.recognise(said["hey jarvis, bring me the red mug"], "woken", 0.5)
    assert (right.mistaken, normalise(right.free)) == (False, "bring me the red mug")
    near = front_end.recognise(said["hey travis, bring me the red mug"], "woken", 0.5)
    assert near.mistaken and normalise(near.free).endswith("bring me the red mug")
    assert len(normalise(near.free)) > len("bring me the red mug")
    alone = front_end.recognise(said["hey jarvis"], "woken", 0.5)
    assert (alone.mistaken, alone.text, alone.free) == (False, "", "")


def test_stop_needs_no_wake_word_and_goes_to_the_motors_directly(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["stop"])
    assert [msgspec.json.decode(p, type=m.RobotStop).source for p in robot.stops] == ["speech"]
    assert robot.commanded() == ["stop"]


def test_stop_after_the_wake_word_is_one_stop(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["hey jarvis, stop"])
    assert len(robot.stops) == 1 and robot.commanded() == ["stop"]


def test_stop_is_acted_on_before_the_utterance_is_over(robot: Robot, said: dict[str, Samples]) -> None:
    sound = said["stop"]
    voiced = int(np.flatnonzero(np.abs(sound) > 500)[-1])
    wait = CONFIG.interrupt_pause + CONFIG.interrupt_seconds + 0.3
    robot.hear(sound[: voiced + int(wait * RATE)], after=0.1)
    assert len(robot.stops) == 1


def test_cancel_needs_no_wake_word_and_does_not_stop_the_motors(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["cancel"])
    assert robot.commanded() == ["cancel"] and not robot.stops


def test_while_the_robot_speaks_only_stop_and_cancel_are_heard(robot: Robot, said: dict[str, Samples]) -> None:
    long = "say " + "I am looking for the red mug in the kitchen and then in the living room. " * 3
    robot.ask(long, "a.1")
    robot.step(0.5)
    robot.hear(said["hey jarvis, bring me the red mug"][: 3 * RATE], after=0.1)
    assert robot.states()[-1] == "speaking"
    robot.hear(said["stop"], after=0.0)
    assert robot.commanded() == ["stop"] and len(robot.stops) == 1
    assert robot.states()[-1] == "idle", "it falls silent"
    before = len(robot.sound)
    robot.step(2.0)
    assert len(robot.sound) == before
    assert not any(msgspec.msgpack.decode(p, type=m.AudioChunk).end for p in robot.sound), "in mid-sentence"


@pytest.mark.slow
def test_the_brain_listening_needs_no_wake_word_and_gets_the_answer(robot: Robot, said: dict[str, Samples]) -> None:
    robot.ask("listen", "a.1")
    robot.hear(said["yes"])
    assert robot.answered() == ["yes"] and not robot.commands
    robot.ask("listen", "a.2")
    robot.hear(said["hey jarvis, bring me the red mug"])
    assert robot.answered() == ["yes", "bring me the red mug"] and not robot.commands
    robot.ask("listen", "a.3")
    robot.hear(said["cancel"])
    assert robot.answered()[2:] == ["cancel"] and not robot.commands and not robot.stops
    robot.ask("listen", "a.4")
    robot.hear(said["stop"])
    assert robot.answered()[3:] == ["stop"] and robot.commanded() == ["stop"] and len(robot.stops) == 1


@pytest.mark.slow
def test_an_answer_begun_just_before_the_brain_listens_counts(robot: Robot, said: dict[str, Samples]) -> None:
    sound = said["bring me the red mug"]
    half = RATE + RATE // 10
    robot.hear(sound[:half], after=0.1)
    robot.ask("listen", "a.1")
    robot.hear(sound[half:])
    assert robot.answered() == ["bring me the red mug"]


@pytest.mark.slow
def test_a_recognition_for_a_goal_that_was_cancelled_is_dropped(robot: Robot, said: dict[str, Samples]) -> None:
    robot.ask("listen", "a.1")
    robot.hear(said["bring me the red mug"][: -RATE // 2], after=0.1)
    assert robot.states()[-1] == "transcribing"
    robot.ask("cancel", "a.2")
    robot.step(2.0)
    assert not robot.results and not robot.commands


def test_push_to_talk_needs_no_wake_word(robot: Robot, said: dict[str, Samples]) -> None:
    robot.hear(said["bring me the red mug"], addressed=True)
    assert robot.commanded() == ["bring me the red mug"]


@pytest.mark.slow
def test_without_wake_word_everything_is_meant_for_the_robot(said: dict[str, Samples]) -> None:
    robot = Robot(wake_word=False)
    robot.hear(said["bring me the red mug"])
    assert robot.commanded() == ["bring me the red mug"]
    robot.io.shutdown()


def test_typed_stop_works_at_any_time(robot: Robot) -> None:
    robot.bus.put(topics.SPEECH_TEXT, b"Stop!")
    robot.step()
    assert len(robot.stops) == 1 and robot.commanded() == ["stop"]


@pytest.mark.slow
def test_the_same_sound_gives_the_same_messages(said: dict[str, Samples]) -> None:
    outcomes = []
    for _ in range(2):
        robot = Robot()
        robot.hear(said["hey jarvis, bring me the red mug"])
        robot.ask("say all right", "a.1")
        robot.hear(said["stop"])
        outcomes.append(robot.published())
        robot.io.shutdown()
    assert outcomes[0] == outcomes[1] and outcomes[0][0]


def test_a_segment_pauses_ends_and_carries_the_wake_word(said: dict[str, Samples]) -> None:
    segmenter = Segmenter(CONFIG)
    found: list[Segment] = []
    for text in ("yes", "hey jarvis"):
        for start in range(0, len(said[text]), 1600):
            found += segmenter.push(said[text][start : start + 1600])
    assert [s.over for s in found] == [False, True, False, True]
    assert found[1].examined and found[3].examined
    assert found[1].wake < CONFIG.wake_threshold < 0.5 < found[3].wake


# --- names that people teach
def test_a_taught_name_is_heard_at_once_and_asked_about_when_it_is_forgotten(
    robot: Robot, said: dict[str, Samples]
) -> None:
    wanted = "bring me the vitamin box"
    robot.send(topics.HOUSEHOLD_NAMES, m.TaughtNames(names=[m.TaughtName(name="vitamin box")]))
    robot.hear(said["hey jarvis, bring me the vitamin box"])
    assert robot.commanded() == [wanted]
    robot.send(topics.HOUSEHOLD_NAMES, m.TaughtNames())
    robot.hear(said["hey jarvis, bring me the vitamin box"])
    known, forgotten = (msgspec.json.decode(c, type=m.VoiceCommand).confidence for c in robot.commands)
    assert known > UNLISTED >= forgotten


@pytest.mark.parametrize(
    "text", [pytest.param("this is my vitamin box", marks=pytest.mark.slow), "bring me the oat milk"]
)
def test_what_is_on_no_list_is_taken_as_it_was_heard_and_to_be_asked_about(
    robot: Robot, said: dict[str, Samples], text: str
) -> None:
    robot.hear(said[f"hey jarvis, {text}"])
    assert robot.commanded() == [text]
    assert msgspec.json.decode(robot.commands[0], type=m.VoiceCommand).confidence <= UNLISTED
