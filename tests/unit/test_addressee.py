"""What is said to somebody else by name is asked about before anything moves; what is said to the robot is not."""

import pytest

from common.language.addressee import addressee
from evaluation.everyday.understanding import planned


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("Tom, can you get me the red mug", "tom"),
        ("tom can you get me the red mug", "tom"),
        ("Hey Sarah, bring me the apple", "sarah"),
        ("Mum, could you put the bottle on the counter", "mum"),
        ("Mrs Miller, put the apple on the desk", "mrs miller"),
        ("can you get me the red mug, Tom", "tom"),
        ("robot, bring me the apple", ""),
        ("darling, could you bring me the apple", ""),
        ("please can you get me the red mug", ""),
        ("quickly, bring me the apple", ""),
        ("stapler, can you bring it to me", ""),
        ("bring me the mug, the can", ""),
        ("no, bring me the apple", ""),
        ("where is the apple, do you know", ""),
        ("", ""),
    ],
)
def test_a_name_before_or_behind_a_request_is_whom_it_is_said_to(said: str, name: str) -> None:
    assert addressee(said) == name


def test_what_names_a_thing_addresses_nobody() -> None:
    assert addressee("mug, can you do that", lambda name: name != "mug") == ""


def test_what_is_said_to_somebody_else_is_asked_about_and_answered() -> None:
    found = planned("Tom, can you get me the red mug please")
    assert (found.looks, found.steps, found.asks) == ([], [], "bring me the red mug")
    assert "said that to tom" in found.reason
    assert [step.action for step in planned("Tom, where is the red mug").steps] == ["say"]
    assert planned("robot, can you get me the red mug please").steps


@pytest.mark.parametrize(
    ("said", "names"),
    [
        ("dad, can I have the ball", ["dad"]),
        ("Emma love, could you grab the bottle", ["emma"]),
        ("the ball, can I have it", []),
    ],
)
def test_who_is_asked_to_let_somebody_have_a_thing_is_addressed(said: str, names: list[str]) -> None:
    assert [name for name in [addressee(said)] if name] == names


@pytest.mark.parametrize(
    "said", ["I need two things: the apple and the red ball", "fetch these items: the apple, red ball"]
)
def test_what_announces_an_enumeration_is_no_thing_by_itself(said: str) -> None:
    steps = planned(said).steps
    assert [step.object for step in steps if step.action == "grasp"] == ["apple", "red ball"]
