"""Replies to questions: pure parts of the VLA pipeline."""

import pytest

from common.household import load_household
from evaluation.everyday.flat import FLAT, HOME
from services.brain.language.choosing import chosen
from services.brain.language.corrections import answered, corrected
from services.brain.language.dialogue import reply

SCENE = load_household("apartment")


@pytest.mark.parametrize(
    ("text", "kind", "rest"),
    [
        ("Yes!", "yes", ""),
        ("that's right", "yes", ""),
        ("no", "no", ""),
        ("never mind", "cancel", ""),
        ("no, the blue mug", "correction", "the blue mug"),
        ("no I said bring me the apple", "correction", "bring me the apple"),
        ("the blue mug", "correction", "the blue mug"),
        ("uh-huh", "yes", ""),
        # Who did not understand has agreed to nothing.
        ("huh?", "correction", "huh"),
        ("mm", "correction", "mm"),
    ],
)
def test_reply(text: str, kind: str, rest: str) -> None:
    assert reply(text) == (kind, rest)


def test_correction_changes_the_object_only() -> None:
    assert corrected("put the red mug in the bin", "the blue mug", SCENE) == "put the blue mug in the bin"
    assert corrected("Bring me the red cup", "blue cup", SCENE) == "bring me the blue cup"
    assert corrected("bring me the red mug", "bring me the apple", SCENE) == "bring me the apple"


def test_a_choice_is_the_one_that_the_words_single_out() -> None:
    options = ["blue mug", "red mug"]
    assert chosen("the red one", options) == "red mug"
    assert chosen("blue", options) == "blue mug"
    assert chosen("the second one please", options) == "red mug"
    three = ["red mug", "blue mug", "white mug"]
    assert chosen("not the red and not the white", three) == chosen("neither red nor white", three) == "blue mug"
    assert chosen("the mug", options) is None
    assert chosen("the green one", options) is None


def test_an_answer_chooses_by_what_only_one_of_the_options_has() -> None:
    mugs = ["red mug", "blue mug"]
    assert chosen("hmm the blue one looks nice today", mugs, FLAT, HOME) == "blue mug"
    assert all(chosen(said, mugs, FLAT, HOME) in mugs for said in ("any of them", "i don't mind", "whichever"))
    assert chosen("did i say red? i meant blue", mugs, FLAT, HOME) == "blue mug"
    for passed_over in ("the red one is dirty", "anything but the red one", "that red thing is not a mug"):
        assert chosen(passed_over, mugs, FLAT, HOME) != "red mug"
    assert chosen("the red or the blue", mugs, FLAT, HOME) is None
    assert chosen("the one i eat", ["apple", "red ball"], FLAT, HOME) == "apple"
    assert chosen("well the one here in the lounge", ["bookshelf", "study shelf"], FLAT, HOME) == "bookshelf"
    assert chosen("no the white one", mugs, FLAT, HOME) == "white mug"
    assert chosen("whichever is in the study", [*mugs, "white mug"], FLAT, HOME) == "white mug"
    assert chosen("whichever is nearest", mugs, FLAT, HOME) is None
    assert reply("neither of them")[0] == "no" and reply("aye, i did, that's right")[0] == "yes"


def test_a_name_alone_answers_what_a_suggestion_is_to_be_done_with() -> None:
    assert answered("bring me the spoon", "spatula", SCENE) == "bring me the spatula"
    assert answered("bring me the spoon", "the blue cup", SCENE) == "bring me the blue cup"
    whole = "go to the study and bring me the spoon"
    assert answered(whole, "the spoon", SCENE) == whole
    for sentence in ("bring me the apple", "where is the apple", "i am fine thanks a lot"):
        assert answered("bring me the spoon", sentence, SCENE) == sentence
