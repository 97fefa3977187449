"""Who is meant by an utterance, and what follows from it."""

import pytest

from common import config
from services.speech.config import SpeechConfig
from services.speech.listen.addressee import Setting, act, scope
from services.speech.recognise.front_end import without_wake
from services.speech.recognise.recogniser import Heard
from tests.support import ROOT

CONFIG = config.load("speech", SpeechConfig, ROOT / "config", {})
SAID = Heard("bring me the apple", "accept", 0.9)
STRANGER, WOKEN, LISTENING = Setting(), Setting(woken=True), Setting(listening=True)


@pytest.mark.parametrize(
    ("setting", "over", "expected"),
    [
        (STRANGER, True, "interrupt"),
        (LISTENING, True, "command"),
        (LISTENING, False, "interrupt"),
        (WOKEN, True, "woken"),
        (Setting(window=True), True, "command"),
        (Setting(addressed=True), True, "command"),
        (Setting(speaking=True, listening=True), True, "interrupt"),
        (Setting(speaking=True, woken=True), True, "interrupt"),
    ],
)
def test_what_is_listened_for(setting: Setting, over: bool, expected: str) -> None:
    assert scope(setting, over) == expected


@pytest.mark.parametrize("setting", [STRANGER, WOKEN, LISTENING, Setting(speaking=True)])
def test_stop_is_obeyed_in_every_setting(setting: Setting) -> None:
    assert act(Heard("stop", "accept", 0.9), "stop", scope(setting, True), setting) == "stop"


def test_a_stop_that_was_hardly_understood_is_no_stop() -> None:
    assert act(Heard("stop", "ask", 0.3), "stop", "interrupt", STRANGER) == "nothing"


def test_cancel_answers_the_listening_brain_and_else_ends_what_goes_on() -> None:
    cancel = Heard("cancel", "accept", 0.9)
    assert act(cancel, "cancel", "command", LISTENING) == "answer"
    assert act(cancel, "cancel", "interrupt", Setting(speaking=True)) == "cancel"
    assert act(cancel, "cancel", "woken", WOKEN) == "cancel"


def test_commands_need_the_wake_word_or_an_open_ear() -> None:
    assert act(SAID, None, "woken", WOKEN) == "command"
    assert act(SAID, None, "command", Setting(window=True)) == "command"
    assert act(SAID, None, "command", LISTENING) == "answer"
    assert act(SAID, None, "command", STRANGER) == "nothing", "the goal was cancelled in the meantime"


def test_a_doubtful_command_goes_to_the_brain_which_asks() -> None:
    assert act(Heard("bring me the apple", "ask", 0.3), None, "woken", WOKEN) == "command"


def test_the_wake_word_alone_opens_the_ear_and_nonsense_after_it_keeps_it_open() -> None:
    assert act(Heard("", "accept", 0.9), None, "woken", WOKEN) == "awake"
    assert act(Heard("take a bowl", "reject", 0.1, "the weather is fine"), None, "woken", WOKEN) == "again"


def test_the_wake_word_is_taken_off() -> None:
    assert without_wake("hey jarvis bring me the apple", CONFIG.wake) == "bring me the apple"
    assert without_wake("hey jarvis", CONFIG.wake) == ""
    assert without_wake("bring me the apple", CONFIG.wake) == "bring me the apple"
