"""Questions about the known world, as operations on sets of things and places."""

import pytest

from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import understand


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("which room's got no mug in it, as far as you know", "The bedroom, as far as I know."),
        ("which of the tables has nothing red on it: the living table or the bedside table?", "The bedside table"),
        ("which room has most in it", "The kitchen."),
        ("which shelf is empty", "The study shelf, as far as I know."),
        ("what shares a shelf with the ball?", "A blue block is there with the red ball."),
        ("seen from the front, on which side of the bowl is the blue mug?", "to the right of the yellow bowl"),
        ("is the yellow bowl left or right of the red can", "to the left of the red can"),
        ("are there more mugs or more bottles", "There are as many mugs as bottles: 3."),
        ("how many of the mugs aren't in the kitchen", "I know of 2 mugs: the red mug and the white mug."),
        ("how many cans are on the counter", "I know of 1 can: the red can."),
        ("how many tables are there in the whole flat", "I know of 4 tables"),
        ("name all the red things you know of", "The red mug on the living table"),
        ("what besides the mug is on the desk?", "An orange box."),
        ("does the red mug sit with the green can", "Yes, the red mug is on the living table."),
        ("how big's the blue cube roughly", "The blue block is 4 centimetres tall and 4 wide."),
        ("so the orange box is called what, again?", "You call the orange box the vitamin box."),
    ],
)
def test_a_question_is_answered_from_what_is_known(said: str, told: str) -> None:
    found = understand(Sentence("-", said, ""))
    assert [step.action for step in found.steps] == ["say"] and told in found.steps[0].text


def test_how_many_there_are_is_also_told_where_something_was_put_just_now() -> None:
    found = understand(Sentence("last:put the apple on the bookshelf", "how many things does that make up there?", ""))
    assert found.steps[0].text == "3 things: the apple, the red ball and the blue block."


def test_a_question_that_names_something_is_not_answered_by_what_is_in_view() -> None:
    found = understand(Sentence("-", "how come the blue mug looks so glum tonight", ""))
    assert all("From here I see" not in step.text for step in found.steps)
