"""Things that nobody has listed: where they are said to be, what comes after them, and places that nobody knows."""

import pytest

from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import understand


def steps(said: str) -> list[tuple[str, ...]]:
    """What a sentence comes to, without who does it: action, object, target, text."""
    found = understand(Sentence("-", said, "fetch(duck)"))
    return [tuple(part for part in (s.action, s.object, s.target, s.text) if part) for s in found.steps]


@pytest.mark.parametrize(
    "said",
    [
        "bring me the duck, it's on the desk",
        "Bring me the duck. It is on the desk.",
        "can I have the duck? it should be on the desk",
        "get the duck, it ought to be on the desk",
        "I'd like the duck please, I left it on the desk",
        "hello there. could you bring me the duck? I think I left it on the desk.",
        "I'd like to use the duck, it's on the desk",
    ],
)
def test_a_thing_is_looked_for_where_it_is_said_to_be(said: str) -> None:
    expected = [
        ("navigate", "desk"),
        ("find", "duck", "duck on the desk"),
        ("grasp", "duck"),
        ("return",),
        ("release",),
    ]
    assert steps(said) == expected


@pytest.mark.parametrize(
    "said", ["take the duck from the desk and bring it here", "grab the duck from the desk and bring it to me"]
)
def test_a_command_behind_a_place_is_no_part_of_it(said: str) -> None:
    assert steps(said)[-2:] == [("return",), ("release",)]
    assert ("find", "duck", "duck from the desk") in steps(said)


@pytest.mark.parametrize(
    ("said", "place"),
    [
        ("put the candle on the windowsill", "windowsill"),
        ("bring the notebook to the sofa table", "sofa table"),
        ("move the candle from the desk to the windowsill", "windowsill"),
    ],
)
def test_it_is_the_place_that_is_not_known(said: str, place: str) -> None:
    found = understand(Sentence("-", said, "refuse()"))
    assert found.steps == [] and found.reason == f"I know no {place}"


@pytest.mark.parametrize(
    "said",
    [
        "please put the duck on the bookshelf, it's on the desk",
        "put the duck on the bookshelf. It is on the desk right now.",
        "bring the duck to the bookshelf please, I left it on the desk",
        "put the duck on the bookshelf it is on the desk",
    ],
)
def test_a_thing_is_put_where_it_shall_be_and_taken_from_where_it_is(said: str) -> None:
    expected = [
        ("navigate", "desk"),
        ("find", "duck", "duck from the desk"),
        ("grasp", "duck"),
        ("place", "duck", "bookshelf"),
    ]
    assert steps(said) == expected


@pytest.mark.parametrize(
    ("said", "description"),
    [
        ("I need the duck. can you get it from the study?", "duck from the study"),
        ("bring me the duck, I think it's in the study", "duck in the study"),
        ("get me a duck, the one with the red beak", ""),
        ("bring me the duck over there on the desk", "duck on the desk"),
    ],
)
def test_which_thing_it_is_may_come_late(said: str, description: str) -> None:
    (found,) = [step for step in steps(said) if step[0] == "find"]
    assert found[1:] == (("duck", description) if description else ("duck with the red beak",))


@pytest.mark.parametrize(
    "said",
    [
        "The kitchen sink is blocked. Please get me the duck from the desk.",
        "This shelf won't hold. I'll need the duck from the desk.",
    ],
)
def test_a_place_of_which_something_is_told_is_none_to_go_to(said: str) -> None:
    assert steps(said) == [
        ("navigate", "desk"),
        ("find", "duck", "duck from the desk"),
        ("grasp", "duck"),
        ("return",),
        ("release",),
    ]


def test_something_is_brought_to_where_somebody_is_told_to_be() -> None:
    assert steps("I'm in the kitchen. Bring me the duck.") == [
        ("find", "duck"),
        ("grasp", "duck"),
        ("place", "duck", "counter"),
    ]


@pytest.mark.parametrize(
    "said",
    [
        "Can I have the duck? I want to show it to my sister.",
        "get me the duck, I need to wash it",
        "bring me the duck so that I can wash it",
    ],
)
def test_what_it_is_wanted_for_asks_for_nothing_more(said: str) -> None:
    assert steps(said) == [("find", "duck"), ("grasp", "duck"), ("return",), ("release",)]


def test_a_curse_is_no_part_of_a_name() -> None:
    (found,) = [step for step in steps("bring me that blasted duck") if step[0] == "find"]
    assert found[1] == "duck"


@pytest.mark.parametrize(("said", "fetched"), [("give it a rub", False), ("give me the polish", True)])
def test_a_treatment_is_not_looked_for(said: str, fetched: bool) -> None:
    assert any(step[0] == "grasp" for step in steps(said)) == fetched


@pytest.mark.parametrize(
    ("said", "thing"),
    [
        ("put the toy rabbit on the desk", "toy rabbit"),
        ("there's a china dog on the bed, put it on the desk", "china dog"),
        ("put the pair of scissors on the desk", "scissors"),
    ],
)
def test_figures_of_animals_and_what_comes_in_pairs_are_things(said: str, thing: str) -> None:
    assert steps(said)[-2:] == [("grasp", thing), ("place", thing, "desk")]


@pytest.mark.parametrize("said", ["put the rabbit on the desk", "bring me the big dog"])
def test_animals_are_not_picked_up(said: str) -> None:
    assert steps(said) == []


def test_two_of_a_kind_are_a_pair() -> None:
    assert [step[1] for step in steps("bring me a pair of mugs") if step[0] == "grasp"] == ["red mug", "white mug"]
