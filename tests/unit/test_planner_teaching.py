"""Sentences that give a thing a name or take it away: which steps they become, and which are no such thing."""

import pytest

from common.messages import WorldObject
from tests.unit.test_planner_grammar import ask, text


@pytest.mark.parametrize(
    ("said", "planned"),
    [
        ("this is my vitamin box", "teach vitamin box"),
        ("that's my vitamin box", "teach vitamin box"),
        ("remember, this is my favourite thing for tea", "teach favourite thing for tea"),
        ("call this the vitamin box please", "teach vitamin box"),
        ("this is called herbert", "teach herbert"),
        ("the red mug is called sunrise", "teach red mug sunrise"),
        ("this red mug is my sunrise", "teach red mug sunrise"),
        ("forget my vitamin box", "forget vitamin box"),
        ("please forget the name vitamin box", "forget vitamin box"),
    ],
)
def test_names_are_taught_and_forgotten(said: str, planned: str) -> None:
    assert text(ask(said)) == planned


@pytest.mark.parametrize("said", ["this is great", "forget it", "this is my kitchen", "the zebra is called tim"])
def test_other_sentences_teach_nothing(said: str) -> None:
    assert not any(s.action in ("teach", "forget") for s in ask(said).steps)


def test_a_name_is_taught_and_used_in_one_breath() -> None:
    assert text(ask("this is my vitamin box. go to the kitchen")) == "teach vitamin box; navigate kitchen"


@pytest.mark.parametrize("said", ["give me my grandmother's can", "bring me grandmother's can"])
def test_a_name_with_an_owner_in_it_is_fetched(said: str) -> None:
    """Names are kept without their apostrophes."""
    name = "grandmother s can"
    taught = WorldObject(
        label=name, kind="can", colour="blue", position=(0, 0, 0), confidence=1.0, size=(0.1, 0.1, 0.1)
    )
    assert text(ask(said, objects=[taught])).startswith(f"find {name}; grasp {name}")
