"""Which of the offered things an answer means, in words that name none of them."""

import pytest

from evaluation.everyday.flat import FLAT, HOME
from services.brain.language.choosing import chosen
from services.brain.language.offered import likeliest


@pytest.mark.parametrize(
    ("said", "options", "meant"),
    [
        ("the one by the bed", ["green bottle", "white bottle"], "green bottle"),
        ("where the apple is", ["kitchen table", "living table"], "kitchen table"),
        ("whichever has soup in it", ["red can", "white can"], "white can"),
        ("the red's fine", ["red mug", "blue mug"], "red mug"),
        ("the first will do", ["counter", "kitchen table"], "counter"),
        ("the one I can hardly see, it's so tiny", ["yellow block", "blue block"], "blue block"),
        ("the big'un", ["blue block", "yellow block"], "yellow block"),
        ("anything but the green'un", ["green bottle", "white bottle"], "white bottle"),
        ("the massive one, I think", ["blue block", "yellow block"], "yellow block"),
    ],
)
def test_an_option_is_told_by_what_only_that_one_has(said: str, options: list[str], meant: str) -> None:
    assert chosen(said, options, FLAT, HOME) == meant


def test_the_same_words_choose_by_where_things_stand() -> None:
    first, second = (
        chosen("the one on the counter", o, FLAT, HOME) for o in (["red mug", "blue mug"], ["red can", "green can"])
    )
    assert (first, second) == ("blue mug", "red can")


@pytest.mark.parametrize("said", ["what a lovely day", "hm", "neither of those, forget it", "by the big bottle"])
def test_words_that_tell_nothing_apart_choose_nothing(said: str) -> None:
    assert chosen(said, ["red mug", "blue mug"], FLAT, HOME) is None


def test_probabilities_are_of_the_options_and_none() -> None:
    label, p = likeliest("the one on the desk", ["white mug", "red mug"], FLAT, HOME)
    assert label in ("white mug", "red mug", "") and 1 / 3 < p <= 1
