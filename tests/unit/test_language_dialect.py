"""Dialect and clipped spellings are read as plain ones; plain English stays as it is."""

import pytest

from common.language.contractions import expand
from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import understand
from services.planner.grammar.asides import with_tales_apart


@pytest.mark.parametrize(
    ("said", "plain"),
    [
        ("whaur's ma mug", "where is my mug"),
        ("tha'd best shift t'box owt's fine", "you would best shift the box anything is fine"),
        ("stick it in the recyclin for me, hen", "stick it in the recycling for me, hen"),
        ("i've lost me keys again", "i have lost my keys again"),
        ("bring yon wee cup eh", "bring that wee cup"),
        ("take yourself off to the study", "go to the study"),
    ],
)
def test_dialect_is_written_plainly(said: str, plain: str) -> None:
    assert expand(said) == plain


@pytest.mark.parametrize("said", ["bring me the tin basin", "give me water", "say aye lah", "look in the cabin"])
def test_plain_english_and_what_is_to_be_said_stay(said: str) -> None:
    assert expand(said) == said


@pytest.mark.parametrize(
    ("said", "apart"),
    [
        ("my hands are cold, the mug would help", "the mug would help"),
        ("tom has left his ball here, put it away", "tom has left his ball here . put it away"),
        ("the mug please, i am thirsty", "the mug please"),
        ("i am tired", "i am tired"),
    ],
)
def test_what_is_told_is_set_apart_from_what_is_asked(said: str, apart: str) -> None:
    assert with_tales_apart(said, lambda words: bool({"ball", "mug"}.intersection(words))) == apart


@pytest.mark.parametrize(
    ("said", "right"),
    [
        ("nah then lad, shift yon white bottle onto t'desk", "put(white bottle, desk)"),
        ("fetch the can labelled tomato soup", "fetch(white can)"),
        ("he's asleep so i can't move, bring the apple", "fetch(apple)"),
        ("you're wanted in the bedroom", "goto(bedroom)"),
        ("the bookshelf is where the white mug should live", "put(white mug, bookshelf)"),
        ("i'm doing a puzzle, the yellow bowl would be lovely", "fetch(yellow bowl)"),
        ("go to the desk, take the mug there and come back", "goto(desk); take(white mug); return()"),
        ("nip to the kitchen for the red can", "fetch(red can)"),
        ("put the ball in the box of the toys", "put(red ball, toy box)"),
        ("bring grandma her apple", "fetch(apple)"),
        ("bring a drink, the green bottle will do", "fetch(green bottle)"),
        ("gran needs the apple and the red ball, bring them", "fetch(apple) & fetch(red ball)"),
    ],
)
def test_request_is_understood(said: str, right: str) -> None:
    sentence = Sentence("-", said, right)
    assert verdict(sentence, understand(sentence)) == "right"


@pytest.mark.parametrize("said", ["bring me the a pull from the kitchen table", "i've mislaid it, please look for it"])
def test_what_was_misheard_or_left_open_moves_nothing_unasked(said: str) -> None:
    assert not understand(Sentence("-", said, "none()")).steps
