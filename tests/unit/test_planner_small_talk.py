"""What the planner says about itself and in courtesy, as sentences that a person would say."""

import pytest

from common.language.indirect import indirect
from common.messages import History, MissionOutcome
from evaluation.everyday.flat import FLAT
from evaluation.everyday.understanding import planned
from services.planner.commands.going import utterance


def said(command: str, history: History | None = None) -> str:
    found = planned(command, FLAT, "", history)
    return " ".join(s.text for s in found.steps) or found.reason


@pytest.mark.parametrize(
    ("command", "turned"),
    [
        ("could you please bring me my mug?", "bring you your mug"),
        ("put the mug on my desk, then come back to me", "put the mug on your desk, then come back to you"),
        ("find your charger", "find my charger"),
        ("give me what I asked for", "give you what you asked for"),
        ("where is the apple", ""),
        ("the red mug", ""),
        ("bring what you found", ""),
    ],
)
def test_a_command_is_turned_as_the_robot_speaks_of_it(command: str, turned: str) -> None:
    assert indirect(command) == turned


@pytest.mark.parametrize(
    ("step", "answer"),
    [
        ("look for red mug", "Right now I am looking for the red mug."),
        ("return_to_start", "Right now I am on my way back."),
        ("grab", "Right now I am picking it up."),
        ("something else", ""),
    ],
)
def test_what_it_is_doing_is_told_in_words_of_people(step: str, answer: str) -> None:
    told = said("what are you doing", History(doing="bring me the red mug", step=step))
    assert told == f"You asked me to bring you the red mug. {answer}".strip()


def test_what_it_did_is_told_as_what_it_was_asked() -> None:
    last = MissionOutcome(id="m", command="bring me my apple", outcome="delivered", reason="", t=0.0)
    assert said("what did you do", History(last=last)) == "You asked me to bring you your apple, and I have done that."
    lost = MissionOutcome(id="m", command="open sesame", outcome="failed", reason="", spoken="I could not.", t=0.0)
    assert said("why did you fail", History(last=lost)) == 'You said "open sesame". I could not.'


@pytest.mark.parametrize(
    ("command", "answer"),
    [
        ("hello robot", "Hello. What can I do for you?"),
        ("good morning", "Hello. What can I do for you?"),
        ("good night", "Goodbye."),
        ("thank you so much", "You are welcome."),
        ("can you hear me", "Yes, I hear you, and I understand English."),
        ("what's next", "I have nothing to do at the moment."),
        ("give it to me", "I do not understand 'to me'"),
        ("bring me", "I did not hear which thing you mean"),
    ],
)
def test_small_talk_is_answered_in_kind(command: str, answer: str) -> None:
    assert said(command) == answer


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("hello to anna", "Hello, Anna."),
        ("sorry to my wife", "Sorry."),
        ("we have to go", "We have to go."),
    ],
)
def test_whom_a_courtesy_is_for_is_spoken_to(words: str, sentence: str) -> None:
    assert utterance(words) == sentence
