"""The person in the evaluation: what they answer to what the robot says."""

import pytest

from common.scene import load_scene
from evaluation.person.dialogue import PATIENCE, Manner, SimulatedUser, seen_at
from judge.words import plain

SCENE = load_scene("apartment")


def person(manner: Manner = "correct", command: str = "bring me the red mug", thing: str = "red mug") -> SimulatedUser:
    return SimulatedUser(command, thing, SCENE, manner)


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("Did you say bring me the red mug?", "yes"),
        ("Did you say: Bring me the red mug?", "yes"),
        ("Did you say bring me the red cup?", "yes"),
        ("Did you say bring me the blue mug?", "no, the red mug"),
        ("Did you say bring me the red can?", "no, the red mug"),
        ("Did you say go home?", "no"),
        ("Please say it again.", "bring me the red mug"),
        ("I did not understand. What did you say?", "bring me the red mug"),
        ("Do you mean the red mug or the blue mug?", "the red mug"),
        ("Which mug?", "the red mug"),
        ("Done.", ""),
        ("I could not reach the red mug.", ""),
    ],
)
def test_answers(question: str, answer: str) -> None:
    assert person().answer(question) == answer


def test_who_is_misheard_again_says_it_in_other_words() -> None:
    one = person()
    question = "Did you say bring me the blue mug?"
    assert len({one.answer(question) for _ in range(3)}) == 3


def test_the_rejecting_the_silent_and_the_agreeable() -> None:
    wrong = "Did you say bring me the blue mug?"
    assert [person(m).answer(wrong) for m in ("reject", "silent", "agree")] == ["no", "", "yes"]


def test_patience_ends() -> None:
    one = person()
    answers = [one.answer("Please say it again.") for _ in range(PATIENCE + 3)]
    assert [a for a in answers if a] == answers[:PATIENCE]


def test_a_command_without_an_object_is_never_corrected_with_one() -> None:
    assert person(command="tidy up the living table", thing="").answer("Did you say tidy up the desk?") == "no"


@pytest.mark.parametrize(("about", "answer"), [("red mug", "yes"), ("blue mug", "no"), ("", "no")])
def test_whether_it_is_the_one_is_answered_by_what_is_seen_there(about: str, answer: str) -> None:
    for question in ("I see a pink can on the desk. Is that the red mug you mean?", "Is that the one you mean?"):
        assert person().answer(question, [about]) == answer
        assert person("agree").answer(question, [about]) == "yes"


@pytest.mark.parametrize(("shown", "answer"), [(["blue mug", "red mug"], "the second one"), (["", ""], "none of them")])
def test_which_of_several_it_is_is_answered_by_what_is_seen_at_each(shown: list[str], answer: str) -> None:
    question = "I see a red mug and a can on the desk. Which of them is the red mug you mean, if any?"
    assert person().answer(question, shown) == answer


def test_what_is_seen_where_the_robot_shows() -> None:
    objects = {"red mug": (1.0, 0.0, 0.8), "blue mug": (1.1, 0.0, 0.8)}
    assert seen_at((1.02, 0.01, 0.8), objects) == "red mug" and seen_at((1.08, 0.0, 0.8), objects) == "blue mug"
    assert (
        seen_at((1.05, 0.0, 0.8), objects) == ""
        and seen_at((1.5, 0.0, 0.8), objects) == ""
        and seen_at((1.06, 0.0, 0.8), {"red mug": (1.0, 0.0, 0.8)}) == "red mug"
        and seen_at((1.0, 0.0, 0.8), {}) == ""
    )


def test_plain_words() -> None:
    assert plain("Hey Jarvis, please bring me THE red-mug!") == "bring red mug"


def test_who_has_other_words_for_a_thing_knows_it_when_it_is_shown() -> None:
    one = SimulatedUser("bring me the soap", "red mug", SCENE, called="pink soap")
    assert one.answer("I see a red mug on the desk. Is that the soap you mean?", ["red mug"]) == "yes"
    assert one.answer("Which soap?") == "the pink soap"
