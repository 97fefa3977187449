"""What is understood of free transcriptions; times and conditions as commands in order."""

import pytest

from common.household import load_household
from common.language.discourse import commands
from common.language.spoken import turns, understood
from evaluation.everyday.understanding import planned
from services.speech.config import SpeechConfig
from services.speech.recognise.grammar import known_names

NAMES = known_names(SpeechConfig(objects=("mug",)), load_household("apartment"), ("vitamin box",))


@pytest.mark.parametrize(
    "text",
    [
        "could you possibly bring me the red mug",
        "my knees are bad, could you fetch the ball from the bookshelf",
        "if the apple is on the kitchen table put it on the desk, otherwise leave it",
        "in half a minute bring me the vitamin boxes",
        "is there a can on the counter",
    ],
)
def test_commands_and_questions_about_what_is_known_are_understood(text: str) -> None:
    assert understood(text, NAMES) == "listed"


@pytest.mark.parametrize(
    "text",
    [
        "this is my lunch bag",
        "say good night to everybody",
        "bring me the screwdriver",
        "could you get the tape measure from the desk",
        "where did i leave my reading glasses",
        "put the portable record player on the counter and come back",
        "there should be a white buttle somewhere, find it and bring it to the counter",
    ],
)
def test_of_things_that_nobody_has_listed_something_is_understood(text: str) -> None:
    assert understood(text, NAMES) == "unlisted"


@pytest.mark.parametrize(
    "text",
    ["", "otherwise", "he said bring me the mug", "who put the mug on the desk", "the mug is red", "hm",
     "bring law and order", "pass the exam and you can go to the party", "bring the mug to the piazza",
     "bring me the unspeakably wonderful emerald hummingbird feeder", "get me the red", "fetch me the blue"],
)  # fmt: skip
def test_other_words_are_not(text: str) -> None:
    assert not understood(text, NAMES)


def test_a_question_about_a_command_is_none() -> None:
    assert turns("who put the mug there", "put the mug there")
    assert not turns("put the mug there", "put the mug there")
    assert not turns("the mug who put there", "put the mug there")
    assert not turns("bring me the the mug now", "bring me the mug")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("in one minute go to the kitchen", ["wait one minute", "go to the kitchen"]),
        ("bring me the can in ten seconds", ["wait ten seconds", "bring me the can"]),
        ("stay in the kitchen for ten seconds then return", ["go to the kitchen", "wait ten seconds", "return"]),
        ("unless the desk is empty tidy it", ["unless the desk is empty", "tidy it"]),
        ("is the ball on the shelf if so bring it", ["if the ball is on the shelf", "bring it"]),
    ],
)
def test_times_and_conditions_come_in_order(text: str, expected: list[str]) -> None:
    assert commands(text) == expected


@pytest.mark.parametrize(
    ("said", "acts"),
    [
        ("unless the desk is empty go to the sofa", ["navigate"]),
        ("if the desk is empty go to the sofa", ["say"]),
        ("if there is no apple on the desk go to the sofa", ["navigate"]),
        ("if there is no ball on the bookshelf come back", ["say"]),
        ("do not under any circumstances take the bowl", []),
    ],
)
def test_what_must_be_so_decides(said: str, acts: list[str]) -> None:
    assert [s.action for s in planned(said).steps] == acts
