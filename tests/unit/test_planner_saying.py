"""What is to be said to people: the words alone, at the place where they are; and questions of what stands where."""

import pytest

from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import understand


@pytest.mark.parametrize(
    ("context", "said", "right"),
    [
        ("-", "go and tell grandpa in the bedroom lunch is ready", "goto(bedroom); say(lunch is ready)"),
        ("-", "could you maybe say good morning to grandpa", "say(good morning)"),
        ("-", "say hello to grandma in the study", "goto(study); say(hello)"),
        ("-", "go and let my wife know the plumber is here", "say(the plumber is here)"),
        ("-", "say happy birthday grandma really loud", "say(happy birthday grandma)"),
        ("-", "fetch the apple, then tell Mia it's building time", "fetch(apple); say(it's building time)"),
        ("-", "go tell Ben in the study that I'm leaving", "goto(study); say(i'm leaving)"),
        ("-", "tell me where the apple is", "answer(kitchen table)"),
        ("-", "go to the study and say hello", "goto(study); say(hello)"),
        ("-", "what stands between the red can and the blue bottle", "answer(yellow bowl)"),
        ("-", "how many things stand on the counter right now", "answer(4|four)"),
        ("-", "is there anything at all on the study shelf", "answer(nothing)"),
        ("last:bring me the red mug", "oh not that one, i meant the blue", "fetch(blue mug)"),
    ],
)
def test_words_for_others_and_what_stands_where(context: str, said: str, right: str) -> None:
    sentence = Sentence(context, said, right)
    assert verdict(sentence, understand(sentence)) == "right"
