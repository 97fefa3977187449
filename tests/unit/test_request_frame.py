"""Frames of requests: what is a courtesy by its words, and what forbids, reports or asks for leave."""

import pytest

from common.language.breaks import without_reason_behind
from common.language.frame import without_frame, without_frame_behind


@pytest.mark.parametrize(
    "frame",
    [
        "would it be at all possible for you to",
        "i was kind of hoping that you might",
        "do you think you could perhaps",
        "if it is not too much trouble",
        "your next job is to",
        "i do not suppose you could",
    ],
)
def test_a_frame_is_taken_off(frame: str) -> None:
    assert without_frame(f"{frame} bring me the apple") == "bring me the apple"


def test_the_verb_behind_a_frame_becomes_a_command() -> None:
    assert without_frame("i would be glad if you fetched the apple") == "fetch the apple"
    assert without_frame("would you mind bringing the apple") == "bring the apple"


@pytest.mark.parametrize(
    "text",
    [
        "i could bring the apple",
        "i would not want you to bring the apple",
        "she asked you to bring the apple",
        "if i were you i would bring the apple",
        "were you going to bring the apple",
        "it would have been nice to get the apple",
        "are you able to fetch things",
    ],
)
def test_what_is_no_request_stays_as_it_is(text: str) -> None:
    assert without_frame(text) == text


def test_an_occasion_behind_a_request_is_no_condition() -> None:
    assert without_frame_behind("bring the apple as soon as you possibly can") == "bring the apple"
    for condition in ("bring the apple if there is one", "bring the apple if you see it", "what rooms can you go to"):
        assert without_frame_behind(condition) == condition


def test_a_reason_behind_a_request_is_left_out_but_not_where_the_thing_is() -> None:
    assert without_reason_behind("get me the bottle i am dying of thirst") == "get me the bottle"
    for text in ("bring me the mug it is on the desk", "bring me the mug i left on the desk"):
        assert without_reason_behind(text) == text
