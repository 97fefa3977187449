"""Who is meant by an utterance, and what follows from it."""

import pytest

from common import config
from common.messages import Transcription
from services.speech.config import SpeechConfig
from services.speech.listen.addressee import UtteranceContext, consequence, scope
from services.speech.recognise.free_text import MOST, PLAIN, UNLISTED, as_heard, cost, freely, without_itself
from services.speech.recognise.recogniser import Recognition, Verdict
from services.speech.recognise.sounding import editex, resounded
from services.speech.recognise.wake_text import without_wake
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
        (UtteranceContext(woken=True, window=True), True, "command"),
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


def test_a_stop_that_was_hardly_understood_is_one_for_a_robot_that_was_addressed() -> None:
    perhaps = Recognition("stop", "ask", 0.3)
    assert consequence(perhaps, "stop", "interrupt", STRANGER) == "nothing"
    assert consequence(perhaps, "stop", "interrupt", LISTENING) == "nothing", "there it competes with nothing"
    assert consequence(perhaps, "stop", "command", LISTENING) == "stop"
    assert consequence(perhaps, "stop", "woken", WOKEN) == "stop"
    assert consequence(Recognition("stop", "ask", 0.3, mistaken=True), "stop", "woken", WOKEN) == "mistaken"
    assert consequence(Recognition("stop", "reject", 0.1), "stop", "command", LISTENING) == "answer"


def test_cancel_answers_the_listening_brain_and_else_ends_what_goes_on() -> None:
    cancel = Recognition("cancel", "accept", 0.9)
    assert consequence(cancel, "cancel", "command", LISTENING) == "answer"
    assert consequence(cancel, "cancel", "interrupt", UtteranceContext(speaking=True)) == "cancel"
    assert consequence(cancel, "cancel", "command", WOKEN) == "cancel"


def test_commands_need_the_wake_word_or_an_open_window() -> None:
    assert consequence(SAID, None, "command", WOKEN) == "command"
    assert consequence(SAID, None, "command", UtteranceContext(window=True)) == "command"
    assert consequence(SAID, None, "command", LISTENING) == "answer"
    assert consequence(SAID, None, "command", STRANGER) == "nothing", "the goal was cancelled in the meantime"


def test_a_doubtful_command_goes_to_the_brain_which_asks() -> None:
    assert consequence(Recognition("bring me the apple", "ask", 0.3), None, "command", WOKEN) == "command"


def test_the_wake_word_alone_opens_the_window_and_nonsense_after_it_keeps_it_open() -> None:
    assert consequence(Recognition("", "accept", 0.9), None, "command", WOKEN) == "awake"
    assert consequence(Recognition("", "ask", 0.4, "hey charlotte"), None, "command", WOKEN) == "awake"
    assert (
        consequence(Recognition("take a bowl", "reject", 0.1, "the weather is fine"), None, "command", WOKEN) == "again"
    )


def test_what_only_sounded_like_the_wake_word_has_no_consequence() -> None:
    near = Recognition("bring me the apple", "accept", 0.9, "Hey Travis, bring me the apple.", 0.9, mistaken=True)
    assert consequence(near, None, "woken", WOKEN) == "mistaken"
    assert consequence(near, None, "command", UtteranceContext(window=True)) == "command"
    stop = Recognition("stop", "accept", 0.9, "Hey Travis, stop.", 0.9, mistaken=True)
    assert consequence(stop, "stop", "woken", WOKEN) == "stop", "whoever is meant"


def test_the_wake_word_is_taken_off() -> None:
    assert without_wake("hey jarvis bring me the apple", CONFIG.wake) == "bring me the apple"
    assert without_wake("hey jarvis", CONFIG.wake) == ""
    assert without_wake("bring me the apple", CONFIG.wake) == "bring me the apple"


NAMES = frozenset({"mug", "shelf", "table"})
DOUBT = CONFIG.certain - 0.01


@pytest.mark.parametrize(
    ("found", "text", "verdict", "confidence"),
    [
        (("go to the shelf", "reject", 0.1, "Is the mug on the shelf?", 0.9), "is the mug on the shelf", "accept", 0.9),
        (("go to the shelf", "ask", 0.4, "Is the mug on the shelf?", 0.4), "is the mug on the shelf", "accept", 0.4),
        (("the mug", "reject", 0.1, "Hey Jarvis, bring me my wallet.", 0.9), "bring me my wallet", "accept", UNLISTED),
        (("the mug", "ask", 0.3, "Bring me my wallet.", DOUBT), "the mug", "ask", 0.3),
        (("the mug", "reject", 0.1, "Bring me my wallet.", PLAIN), "bring me my wallet", "accept", UNLISTED),
        (("the mug", "ask", 0.19, "Bring me my wallet.", PLAIN), "bring me my wallet", "accept", UNLISTED),
        (("the mug", "reject", 0.1, "Bring me my wallet.", PLAIN - 0.01), "the mug", "reject", 0.1),
        (("the mug", "reject", 0.1, "The mug was broken in May.", 0.9), "the mug", "reject", 0.1),
        (("hey jarvis put the mug on the table", "accept", 0.7, "Take the mug off the table.", 0.9),
         "take the mug off the table", "accept", UNLISTED),
        (("put the mug on the table", "accept", 0.9, "Take the mug off the table.", 0.7),
         "put the mug on the table", "accept", 0.9),
        (("put the mug there", "accept", 0.9, "Footnote the stair.", 0.4), "put the mug there", "accept", 0.9),
        (("put the mug there", "accept", 0.9, "Footnote the stair.", 0.39), "put the mug there", "accept", UNLISTED),
        (("put the mug on the table", "accept", 0.9, "Put the mug on the table.", 0.3), "put the mug on the table",
         "accept", 0.9),
        (("stop", "accept", 0.9, "Tom", 0.2), "stop", "accept", 0.9),
        (("where is the mug", "accept", 0.4, "Where's the mug?", 0.9), "where is the mug", "accept", 0.4),
        (("put the mug there", "accept", 0.9, "Who put the mug there?", 0.5),
         "who put the mug there", "accept", UNLISTED),
        (("the mug", "reject", 0.1, "Keep hold of that mug for me.", 0.9), "keep hold of that mug for me", "accept",
         UNLISTED),
        (("the mug", "reject", 0.1, "Keep hold of that mug for me.", DOUBT), "the mug", "reject", 0.1),
        (("the mug", "reject", 0.1, "Turn off the light over the table.", 0.9), "the mug", "reject", 0.1),
        (("the mug", "reject", 0.1, "Nobody should keep hold of that mug.", 0.9), "the mug", "reject", 0.1),
        (("the mug", "ask", 0.2, "The bag.", 0.9), "the mug", "ask", 0.2),
        (("the mug", "ask", 0.19, "The bag.", 0.9), "the mug", "reject", 0.19),
        (("hey jarvis", "ask", 0.1, "Hey Jones.", 0.6), "", "ask", 0.1),
        (("the mug", "reject", 0.1, "", 0.9), "the mug", "reject", 0.1),
        (("put the mug next to the mug", "ask", 0.4, "Put the mug next to the...", 0.9), "put the mug next to the mug",
         "reject", 0.4),
        (("put the mug next to the mug", "accept", 0.4, "Put the mug next to the...", 0.9),
         "put the mug next to the mug", "reject", 0.4),
        (("put the mug next to the mug", "accept", 0.9, "Put the mug next to the...", 0.8),
         "put the mug next to the mug", "accept", 0.9),
        (("", "reject", 0.1, "Go to the", 0.9), "", "reject", 0.1),
        (("the mug", "reject", 0.1, "What is on the", 0.9), "the mug", "reject", 0.1),
        (("the mug", "reject", 0.1, "How many things do you know of?", 0.9), "how many things do you know of", "accept",
         0.9),
        (("the mug", "reject", 0.1, "The mug to the table. Then go to the shelf.", 0.9),
         "the mug to the table, then go to the shelf", "accept", 0.9),
        (("hey jarvis stop", "accept", 0.6, "Go to the table.", 0.9), "stop", "accept", 0.6),
        (("hey jarvis", "accept", 0.6, "Go to the table.", 0.9), "", "accept", 0.6),
    ],
)  # fmt: skip
def test_the_sentence_or_the_free_transcription_counts(
    found: tuple[str, Verdict, float, str, float], text: str, verdict: str, confidence: float
) -> None:
    heard = freely(Recognition(*found), NAMES, CONFIG)
    assert (heard.text, heard.verdict, heard.confidence) == (text, verdict, confidence)


@pytest.mark.parametrize(
    ("certainty", "share", "confidence"), [(0.7, 0.0, 0.7), (0.7, 0.95, 0.95), (0.9, 0.4, 0.9), (0.59, 0.95, 0.59)]
)
def test_a_transcription_like_which_nothing_else_sounds_is_surer(
    certainty: float, share: float, confidence: float
) -> None:
    said = "Is the mug on the shelf?"
    found = freely(Recognition("", "reject", 0.0, said, certainty, share=share), NAMES, CONFIG)
    assert (found.text, found.confidence) == ("is the mug on the shelf", confidence)
    unlisted = freely(Recognition("", "reject", 0.0, "Bring me my wallet.", 0.9, share=1.0), NAMES, CONFIG)
    assert unlisted.confidence == UNLISTED, "a word that is on no list may sound like any"


def test_a_transcription_costs_the_more_the_less_is_understood_of_it() -> None:
    said = ("Hey Jarvis, is the mug on the shelf?", "Hey Jarvis, bring me my wallet.", "Hey Jarvis, the stair is foot.")
    costs = [cost(text, NAMES, CONFIG) for text in said]
    assert costs[0] == 0.0 < costs[1] < costs[2]


@pytest.mark.parametrize(
    ("heard", "text"),
    [
        ("go to the kitten", "go to the kitchen"),
        ("put the apple on the conter", "put the apple on the counter"),
        ("don't go to the kitten", ""),
        ("the parliament met in the kitten", ""),
        ("bring me the hammer", "bring me the hammer"),
    ],
)
def test_a_word_that_was_misheard_is_asked_about_as_what_it_sounds_like(heard: str, text: str) -> None:
    names = {"kitchen", "red", "mug", "apple", "counter"}
    found = freely(Recognition("", "reject", 0.0, heard, 0.95), names, CONFIG)
    assert (found.text, found.confidence) == (text, UNLISTED if text else 0.0)


def test_alternatives_are_few_and_mean_something_else_than_what_was_heard() -> None:
    same, *others = (Transcription(text=f"bring me {what}", score=0.1) for what in ("an apple please", *"abcdefg"))
    found = without_itself(Recognition("bring me the apple", "accept", 0.9, alternatives=(same, *others)))
    assert found.alternatives == tuple(others[:MOST])


def test_what_was_no_command_is_handed_on_in_its_own_words_if_it_was_heard_plainly() -> None:
    others = tuple(Transcription(text=text, score=0.1) for text in ("i am hungry", "i am angry"))
    found = as_heard(Recognition("sponge", "reject", 0.04, "I am hungry.", 0.8, alternatives=others), CONFIG)
    assert found is not None and (found.text, found.confidence, found.alternatives) == ("i am hungry", 0.0, others[1:])
    assert as_heard(Recognition("sponge", "reject", 0.04, "I am hungry.", 0.6), CONFIG) is None
    assert as_heard(Recognition("", "silence", 0.0), CONFIG) is None


def test_letters_of_one_group_sound_alike() -> None:
    assert [editex("bottle", word) for word in ("bottle", "boddle", "bole", "mug")] == [0, 1, 2, 9]
    assert resounded(["the", "boll"], {"the"}, {"ball", "bowl"}) is None, "it sounds like both"
