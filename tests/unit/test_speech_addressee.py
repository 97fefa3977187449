"""Who is meant by an utterance, and what follows from it."""

import pytest

from common import config
from services.speech.config import SpeechConfig
from services.speech.listen.addressee import UtteranceContext, consequence, scope
from services.speech.recognise.front_end import without_wake
from services.speech.recognise.recogniser import Recognition
from tests.support import ROOT

CONFIG = config.load("speech", SpeechConfig, ROOT / "config", {})
SAID = Recognition("bring me the apple", "accept", 0.9)
STRANGER, WOKEN, LISTENING = UtteranceContext(), UtteranceContext(woken=True), UtteranceContext(listening=True)


@pytest.mark.parametrize(
    ("setting", "over", "expected"),
    [
        (STRANGER, True, "interrupt"),
        (LISTENING, True, "command"),
        (LISTENING, False, "interrupt"),
        (WOKEN, True, "woken"),
        (UtteranceContext(window=True), True, "command"),
        (UtteranceContext(addressed=True), True, "command"),
        (UtteranceContext(speaking=True, listening=True), True, "interrupt"),
        (UtteranceContext(speaking=True, woken=True), True, "interrupt"),
    ],
)
def test_what_is_listened_for(setting: UtteranceContext, over: bool, expected: str) -> None:
    assert scope(setting, over) == expected


@pytest.mark.parametrize("setting", [STRANGER, WOKEN, LISTENING, UtteranceContext(speaking=True)])
def test_stop_is_obeyed_in_every_setting(setting: UtteranceContext) -> None:
    assert consequence(Recognition("stop", "accept", 0.9), "stop", scope(setting, True), setting) == "stop"


def test_a_stop_that_was_hardly_understood_is_no_stop() -> None:
    assert consequence(Recognition("stop", "ask", 0.3), "stop", "interrupt", STRANGER) == "nothing"


def test_cancel_answers_the_listening_brain_and_else_ends_what_goes_on() -> None:
    cancel = Recognition("cancel", "accept", 0.9)
    assert consequence(cancel, "cancel", "command", LISTENING) == "answer"
    assert consequence(cancel, "cancel", "interrupt", UtteranceContext(speaking=True)) == "cancel"
    assert consequence(cancel, "cancel", "woken", WOKEN) == "cancel"


def test_commands_need_the_wake_word_or_an_open_window() -> None:
    assert consequence(SAID, None, "woken", WOKEN) == "command"
    assert consequence(SAID, None, "command", UtteranceContext(window=True)) == "command"
    assert consequence(SAID, None, "command", LISTENING) == "answer"
    assert consequence(SAID, None, "command", STRANGER) == "nothing", "the goal was cancelled in the meantime"


def test_a_doubtful_command_goes_to_the_brain_which_asks() -> None:
    assert consequence(Recognition("bring me the apple", "ask", 0.3), None, "woken", WOKEN) == "command"


def test_the_wake_word_alone_opens_the_window_and_nonsense_after_it_keeps_it_open() -> None:
    assert consequence(Recognition("", "accept", 0.9), None, "woken", WOKEN) == "awake"
    assert consequence(Recognition("", "ask", 0.4, "hey charlotte"), None, "woken", WOKEN) == "awake"
    assert (
        consequence(Recognition("take a bowl", "reject", 0.1, "the weather is fine"), None, "woken", WOKEN) == "again"
    )


def test_the_wake_word_is_taken_off() -> None:
    assert without_wake("hey jarvis bring me the apple", CONFIG.wake) == "bring me the apple"
    assert without_wake("hey jarvis", CONFIG.wake) == ""
    assert without_wake("bring me the apple", CONFIG.wake) == "bring me the apple"
