"""Corrections of what was heard: what fits a part of the command replaces it, the rest of the command stays."""

import pytest

from evaluation.everyday.flat import FLAT, HOME
from services.brain.language.choosing import chosen
from services.brain.language.corrections import corrected
from services.brain.language.dialogue import by_wording, reply


@pytest.mark.parametrize(
    ("heard", "said", "meant"),
    [
        ("bring me the white box", "not quite, the orange", "bring me the orange box"),
        ("put the ball in the toy box", "block, blue block, not ball", "put the blue block in the toy box"),
        ("put the apple in the bin", "goodness no, on the desk", "put the apple on the desk"),
        ("put the green can in the bin", "recycling bin, not bin", "put the green can in the recycling bin"),
        ("bring me the red can", "mug! not can", "bring me the red mug"),
        ("put the box on the study shelf", "right box, wrong shelf, the bookshelf", "put the box on the bookshelf"),
        ("bring me the bottle", "yeah but on the bedside table, not to me", "put the bottle on the bedside table"),
        ("wait fifty seconds", "fifteen, not fifty", "wait fifteen seconds"),
        ("put the box on the desk", "no not on the desk on the dresser", "put the box on the dresser"),
        ("bring me the red mug", "no not the mug the can", "bring me the can"),
        ("bring me the keys", "i did not say keys, i said glasses", "bring me the glasses"),
    ],
)  # fmt: skip
def test_what_fits_a_part_of_the_command_replaces_it(heard: str, said: str, meant: str) -> None:
    assert corrected(heard, by_wording(said)[1], HOME) == meant


def test_words_that_fit_no_part_are_not_put_into_the_command() -> None:
    assert (
        corrected("bring me the can", "whatever would you want with that", HOME) == "whatever would you want with that"
    )


def test_who_only_says_what_was_not_meant_denies() -> None:
    assert reply("i never said a word about a can", "bring me the can")[0] == "no"
    assert reply("not the mug the can", "bring me the mug")[0] == "correction"
    assert reply("sure did, and the apple as well", "bring me the box")[0] == "correction"
    assert reply("not the can")[0] == "correction"  # of several, another one


@pytest.mark.parametrize(
    ("said", "options", "meant"),
    [
        ("the last one you named", ["red can", "green can", "white can"], "white can"),
        ("the middle one in your list", ["red mug", "blue mug", "white mug"], "blue mug"),
        ("option 2", ["yellow block", "yellow bowl"], "yellow bowl"),
        ("it's got writing on", ["white can", "green can"], "white can"),
        ("that tall fella", ["white bottle", "green bottle"], "white bottle"),
        ("where the ball lives", ["bookshelf", "study shelf"], "bookshelf"),
        ("neither, the white one", ["red can", "green can", "white can"], "white can"),
        ("not the green the other one", ["blue bottle", "green bottle"], "blue bottle"),
    ],
)
def test_an_option_is_singled_out_by_any_property_that_it_has_alone(said: str, options: list[str], meant: str) -> None:
    assert chosen(said, options, FLAT, HOME) == meant
