"""The learnt reading of sentences: candidates of the things they name, cuts, and what is learnt from."""

from importlib.resources import files

import pytest

from bench.semantic import examples
from evaluation.everyday.flat import CONFIG, HOME
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import planned, understand
from services.planner.grammar.chunks import Chunk
from services.planner.grammar.guess import Guess, contradicted
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.forms import NONE, OTHER, candidates, tokens
from services.planner.semantic.parse import LONGEST, parse
from services.planner.semantic.ranker import WEIGHTS, rank
from services.planner.world import World

VOCABULARY = Vocabulary(World(HOME), CONFIG)
MUG, DESK, SHELF = Chunk("thing", "the mug", 1, 3), Chunk("spot", "the desk", 4, 6), Chunk("spot", "the shelf", 7, 9)
MOST_BYTES = 1_000_000
"""Largest model that the repository is to carry [bytes] (chosen)."""


def _meant(text: str) -> list[str]:
    return [part.meant.text or part.meant.form for part in parse(tokens(text), VOCABULARY)]


def test_every_form_is_tried_with_every_thing_and_place() -> None:
    texts = [c.text for c in candidates((), [MUG, DESK, SHELF])]
    assert {"bring me the mug", "put the mug on the desk on the shelf", "tidy up the desk", "come back"} <= set(texts)
    assert "put the mug on the desk on the desk" not in texts and len(texts) == len(set(texts)) + 1
    assert [c.form for c in candidates((), [])][:2] == [NONE, OTHER]


def test_things_of_one_command_are_named_together() -> None:
    can = Chunk("thing", "the can", 4, 6)
    texts = [c.text for c in candidates((), [MUG, can, can._replace(text="the ball")])]
    assert {"bring me the mug and the can", "bring me the mug and the can and the ball"} <= set(texts)
    assert "put the mug next to the can" in texts and "put the mug next to the mug" not in texts


def test_probabilities_sum_to_one_and_the_likeliest_is_first() -> None:
    ranked = rank(tokens("fetch me the red mug"), VOCABULARY)
    assert sum(r.p for r in ranked) == pytest.approx(1.0)
    assert [r.p for r in ranked] == sorted((r.p for r in ranked), reverse=True)
    assert ranked[0].candidate.text == "bring me the red mug"


def test_a_sentence_of_two_requests_is_cut() -> None:
    assert _meant("right then, apple to me, and after that you can clear the desk") == [
        "bring me the apple", "tidy up the desk",
    ]  # fmt: skip


@pytest.mark.parametrize("text", ["", ",", "and", " ".join(f"word{n}" for n in range(LONGEST + 1))])
def test_what_is_no_sentence_means_nothing(text: str) -> None:
    assert _meant(text) == []


@pytest.mark.parametrize("said", ["she never wanted the apple", "my uncle paints mugs", "mow the lawn"])
def test_of_what_asks_for_nothing_nothing_is_guessed(said: str) -> None:
    found = planned(said)
    assert (found.steps, found.asks) == ([], "")


def test_the_model_is_small() -> None:
    assert len((files("services.planner.semantic") / WEIGHTS).read_bytes()) < MOST_BYTES


def test_examples_know_what_is_right_of_their_candidates() -> None:
    rows = examples(
        {
            "x": [
                Sentence("-", "fetch me the red mug", "fetch(red mug)"),
                Sentence("held:apple", "what lovely weather", "none()"),
            ]
        }
    )
    assert [[c.text or c.form for c, right in zip(e.meant, e.right, strict=True) if right] for e in rows] == [
        ["bring me the red mug"], [NONE],
    ]  # fmt: skip
    assert [e.situation for e in rows] == [(), ("holding", "apple")]


def test_a_plan_that_does_something_else_is_asked_about() -> None:
    def is_doubted(said: str, likely: str, p: float) -> bool:
        guess = Guess([likely], planned(likely).steps, answers=False, p=p)
        return contradicted(tokens(said), planned(said).steps, guess, {"red mug", "blue mug", "red can"})

    assert is_doubted("bring me the blue mug", "bring me the red mug", 0.9)
    assert not is_doubted("bring me the blue mug", "bring me the red mug", 0.7), "hardly likely"
    assert not is_doubted("bring me the blue mug", "bring me the blue mug", 0.9)
    assert is_doubted("bring me the stapler", "bring me the red mug", 0.6), "nobody knows it"
    assert not is_doubted("bring me the can of paint", "bring me the red can", 0.9), "a part of the name"
    assert not is_doubted("where is the red mug", "bring me the red mug", 0.8), "words do no harm"
    assert is_doubted("where is the red mug", "bring me the red mug", 0.95), "an answer is no help"
    assert is_doubted("put the red mug on the desk", "mugs always belong on the desk", 0.9), "a rule moves nothing"
    assert is_doubted("bring me the position 45 seconds", "wait 45 seconds", 0.9), (
        "the likeliest knows the name as a time"
    )


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ("robot vacuum go to the kitchen", "go to the kitchen"),
        ("bring me my keys", ""),
        ("put my keys on the counter", ""),
        ("bring me the purple cup", ""),
        ("I need the stapler, bring it to me", ""),
    ],
)
def test_a_thing_nobody_knows_is_doubted_beside_a_likelier_request(said: str, asked: str) -> None:
    found = planned(said)
    assert (bool(found.steps), found.asks) == (not asked, asked)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("please just be still for three minutes with me", "wait 180 seconds"),
        ("stay in the kitchen a minute and a half", "go to the kitchen and wait 90 seconds"),
        ("let everybody hear: the cake is ready", "say the cake is ready"),
        ("for the future, that's the lemonade", "this is my lemonade"),
        ("this spot here, we'll call it the atelier", "name this place the atelier"),
        ("tissues, please", "bring me the tissues"),
    ],
)
def test_times_words_to_say_and_names_are_asked_about(said: str, meant: str) -> None:
    found = planned(said)
    assert found.asks == meant and not found.steps
    assert planned(meant).steps and not planned(meant).asks


@pytest.mark.parametrize(
    ("context", "said", "meant"),
    [
        (
            "busy:put the red mug on the dining table",
            "changed my mind, kitchen counter please",
            "put the red mug on the counter",
        ),
        ("last:bring me the apple", "and the ball from up there", "bring me the red ball"),
        ("failed:bring me the remote", "look again, try the living table", "bring me the remote"),
    ],
)
def test_a_part_of_the_command_before_is_exchanged(context: str, said: str, meant: str) -> None:
    assert understand(Sentence(context, said, "")).asks == meant


def test_a_sentence_with_a_verb_of_its_own_exchanges_nothing() -> None:
    for words, exchanges in ((("the", "desk"), True), (("fetch", "the", "desk"), False)):
        found = candidates(words, [Chunk("spot", "the desk", len(words) - 2, len(words))], "put the mug on the shelf")
        assert ("put the mug on the desk" in [c.text for c in found]) is exchanges
