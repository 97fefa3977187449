"""What is said to a robot at work, in words that no wording has."""

import pytest

from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import lists
from evaluation.everyday.understanding import understand
from services.brain.language.dialogue import reply
from services.brain.language.interjection import interjection
from services.brain.language.senses import AT_WORK


@pytest.mark.parametrize(
    ("said", "kind"),
    [
        ("it's turned up, it was in my pocket the whole time", "cancel"),
        ("she is so tall for her age isn't she", "idle"),
        ("could you take the red can to the kitchen once that's sorted", "queue"),
        ("how much longer will you be", "aside"),
    ],
)
def test_it_is_taken_as_it_is_most_likely_meant(said: str, kind: str) -> None:
    assert interjection(said, "find the glasses").kind == kind


@pytest.mark.parametrize("said", ["stop", "stop that", "cancel", "come back", "please stop now"])
def test_plain_words_that_end_a_mission_are_not_left_to_a_model(said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("services.brain.language.senses.AT_WORK.likeliest", lambda *heard: ("idle", 1.0))
    assert interjection(said, "bring me the apple").kind in ("stop", "cancel", "come_back")


def test_a_wording_stands_until_the_model_is_sure(monkeypatch: pytest.MonkeyPatch) -> None:
    for p, kind in ((0.7, "replace"), (0.9, "queue")):
        monkeypatch.setattr("services.brain.language.senses.AT_WORK.likeliest", lambda *heard, p=p: ("queue", p))
        assert interjection("bring me the can instead", "bring me the apple").kind == kind


def test_probabilities_are_of_the_senses() -> None:
    sense, p = AT_WORK.likeliest("never mind, i have found it", "find the glasses", "cancel")
    assert sense in AT_WORK.senses and 1 / len(AT_WORK.senses) < p <= 1


@pytest.mark.slow
def test_sentences_at_work_that_nobody_worked_on() -> None:
    rows = [row for row in lists()["36"] if row.context.startswith("busy:")]
    verdicts = [verdict(row, understand(row)) for row in rows]
    assert verdicts.count("right") >= 0.65 * len(rows) and verdicts.count("wrong") <= 0.2 * len(rows)


@pytest.mark.parametrize(
    ("said", "kind"),
    [("those were my very words", "yes"), ("nae chance", "no"), ("i never said that", "no"), ("bingo!", "yes"),
     ("that's the stuff", "yes"), ("that's the apple", "correction"), ("you dreamt that", "no"), ("huh?", "correction"),
     ("what? no", "no"), ("Huh?! Yes, please", "yes"), ("what? the blue one", "correction"),
     ("the blue one", "correction")],
)  # fmt: skip
def test_an_answer_in_any_words_is_a_yes_or_a_no(said: str, kind: str) -> None:
    assert reply(said, "bring me the apple")[0] == kind


def test_a_yes_has_to_be_surer_than_a_no(monkeypatch: pytest.MonkeyPatch) -> None:
    for sense, kind in (("yes", "correction"), ("no", "no")):
        monkeypatch.setattr("services.brain.language.senses.ANSWERS.likeliest", lambda *said, s=sense: (s, 0.7))
        assert reply("well now then", "bring me the apple")[0] == kind
