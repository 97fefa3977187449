"""What is told of a thing before it is asked for: by which words and where it is looked for."""

import pytest

from evaluation.everyday.understanding import planned


@pytest.mark.parametrize(
    ("said", "thing", "described"),
    [
        ("there's a hammer on the desk, bring it to me", "hammer", "hammer on the desk"),
        ("there is a toy helicopter lying on the bedroom floor, can you bring it to me", "toy helicopter",
         "toy helicopter lying on the bedroom floor"),
        ("bring me the pink dumbbell, it's on the floor in the living room", "pink dumbbell",
         "pink dumbbell on the living room floor"),
        ("get me the owl from the top of the tall cabinet", "owl", "owl from the tall cabinet"),
        ("my camera should be on the study shelf, go and get it for me", "camera", "camera on the study shelf"),
        ("the scissors are probably on the counter, fetch them", "scissors", "scissors on the counter"),
        ("i think my keys are on the desk, could you get them", "keys", "keys on the desk"),
        ("the red mug should be on the living table, bring it here", "red mug", ""),
    ],
)  # fmt: skip
def test_a_thing_is_looked_for_where_it_was_said_to_be(said: str, thing: str, described: str) -> None:
    found = planned(said)
    finds = [(step.object, step.text) for step in found.steps if step.action == "find"]
    assert finds == [(thing, described)], found
    assert [step.action for step in found.steps][-3:] == ["grasp", "return", "release"]


def test_a_thought_is_no_thing() -> None:
    found = planned("i can't find my glasses case, i think it's by the bed, can you bring it here")
    assert {step.object for step in found.steps if step.object} == {"glasses case"}


def test_done_is_no_place() -> None:
    assert [step.target for step in planned("put the apple on the desk when you are done").steps][-1] == "desk"
