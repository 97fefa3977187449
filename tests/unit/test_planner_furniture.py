"""Furniture that is no place for things: what stands by it is one, and things lie on its top."""

import pytest

from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import understand


@pytest.mark.parametrize(
    ("context", "said", "right"),
    [
        ("-", "put the apple by the bed", "put(apple, bedside table)"),
        ("held:blue bottle", "next to my bed please", "put(blue bottle, bedside table)"),
        ("-", "put the apple next to the sofa", "refuse()"),
        ("-", "bring me the pillow on the bed", "fetch(pillow on the bed)"),
        ("-", "bring me the bottle on the bed", "fetch(bottle on the bed)"),
        ("-", "bring me the bottle by the bed", "fetch(green bottle)"),
    ],
)
def test_a_bed_is_a_place_of_things(context: str, said: str, right: str) -> None:
    sentence = Sentence(context, said, right)
    assert verdict(sentence, understand(sentence)) == "right"
