"""What people say to the robot, as the recogniser expects it."""

import math

import pytest

from bench.word_ngrams import learn
from common import config
from common.household import load_household
from services.speech.config import SpeechConfig
from services.speech.recognise.word_ngrams import WordNgrams, classes

PARAMETERS = config.load("speech", SpeechConfig, config.DEFAULT_DIR, {})
HOME = load_household("apartment")


@pytest.fixture(scope="module")
def cost() -> WordNgrams:
    return WordNgrams(classes(PARAMETERS, HOME, ("theremin",)), PARAMETERS.wake)


@pytest.mark.parametrize(
    ("said", "misheard"),
    [
        ("move all the bottles to the kitchen table", "move on the bottles to the kitchen table"),
        ("count to ten before you go to the kitchen", "count to tin before you water the kitchen"),
        ("could you fetch the blue block", "could you fetch the full block"),
        ("Bring me the theremin.", "Bring me the there a man."),
    ],
)
def test_what_is_said_to_a_robot_is_expected(cost: WordNgrams, said: str, misheard: str) -> None:
    assert cost(said, whole=True) < cost(misheard, whole=True)


def test_the_beginning_of_a_sentence_costs_no_end_and_the_wake_word_nothing(cost: WordNgrams) -> None:
    assert cost("bring me the") < cost("bring me the", whole=True)
    assert cost("Hey Jarvis, bring me the mug") == cost("bring me the mug")


def test_names_of_another_household_are_expected_where_the_learnt_ones_were() -> None:
    learnt = learn([("bring", "the", "mug"), ("bring", "the", "bowl"), ("wash", "the", "car")] * 2, {"mug": "<thing>"})
    cost = WordNgrams({"sextant": "<thing>"}, (), learnt)
    assert cost("bring the sextant") < cost("bring the mug")


def test_what_is_left_for_others_makes_probabilities_sum_to_one() -> None:
    learnt = learn([("bring", "the", "mug"), ("bring", "the", "bowl"), ("wash", "the", "mug")] * 2, {})
    cost = WordNgrams({}, (), learnt)
    words = learnt.words
    for state in ((words["bring"], words["the"]), (words["mug"], words["the"]), (words["bowl"], words["mug"])):
        total = sum(math.exp(cost._log(number, state)) for number in words.values())
        assert total == pytest.approx(1.0, abs=0.01)
