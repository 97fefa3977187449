"""Several things of one text: what `both` and `them` are, how often one is asked for, what is put beside another."""

import pytest

from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import planned, understand


@pytest.mark.parametrize(
    ("said", "right"),
    [
        ("get the red mug and then the blue mug and put both on the desk", "put(red mug, desk); put(blue mug, desk)"),
        ("get the apple, get the blue mug, then put them both on the desk", "put(apple, desk); put(blue mug, desk)"),
        ("get me a can. any can", "fetch(green can/red can/white can)"),
        ("get the apple, bin it, then come back", "put(apple, bin); return()"),
        ("bring me the apple, then put it on the desk", "fetch(apple); put(apple, desk)"),
        ("bring me 2 blocks", "fetch(blue block) & fetch(yellow block)"),
        ("bring me a mug, any mug", "fetch(red mug/blue mug/white mug)"),
    ],
)
def test_things_of_a_text_are_done_with_once(said: str, right: str) -> None:
    assert verdict(Sentence("-", said, right), planned(said)) == "right"


@pytest.mark.parametrize(
    ("context", "said", "right"),
    [
        ("held:red can", "next to the apple please", "put(red can, kitchen table near apple)"),
        ("last:take the red can", "next to the apple please", "put(red can, kitchen table near apple)"),
        ("-", "next to the apple please", "refuse()"),
    ],
)
def test_what_is_held_is_put_beside_a_thing(context: str, said: str, right: str) -> None:
    sentence = Sentence(context, said, right)
    assert verdict(sentence, understand(sentence)) == "right"


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ("hold position 45 seconds", "wait 45 seconds"),
    ],
)
def test_what_most_likely_means_something_else_is_asked_about(said: str, asked: str) -> None:
    found = planned(said)
    assert (found.steps, found.asks) == ([], asked)


@pytest.mark.parametrize(
    ("said", "right"),
    [
        ("remember: all toys belong in the toy box", "rule(toys, toy box)"),
        ("fruit belongs on the kitchen table, please remember that", "rule(fruit, kitchen table)"),
        ("just so you know, mugs go on the desk", "rule(mugs, desk)"),
        ("put the apple on the desk, remember that", "put(apple, desk)"),
        ("scrap the box rule", "refuse()"),
    ],
)
def test_what_is_to_be_remembered_is_a_rule(said: str, right: str) -> None:
    assert verdict(Sentence("-", said, right), planned(said)) == "right"


def test_a_rule_about_one_thing_is_asked_about() -> None:
    assert planned("my charger has its place on the desk now").asks == "my charger always belong on the desk"


@pytest.mark.parametrize(
    ("said", "brought"),
    [
        ("could you get me the blue mug? I want some coffee.", ["blue mug"]),
        ("bring me the red can, I need something to drink", ["red can"]),
        ("bring me the apple. I want some water too.", ["apple", "blue bottle"]),
    ],
)
def test_a_wish_that_is_fulfilled_tells_why(said: str, brought: list[str]) -> None:
    assert [step.object for step in planned(said).steps if step.action == "grasp"] == brought
