"""What is said to somebody else by name is asked about before anything moves; what is said to the robot is not."""

import pytest

from common.language.addressee import addressee
from tests.everyday import planned


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
