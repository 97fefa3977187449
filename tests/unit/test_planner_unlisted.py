"""Things that nobody has listed: where they are said to be, what comes after them, and places that nobody knows."""

import pytest

from tests.everyday import Sentence, understand


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
