"""Readings of sentences that no construction fits: by verb class and roles, asked first, never of what is told."""

import pytest

from common.language.mood import forbids, is_told
from common.language.verb_classes import classes
from evaluation.everyday.flat import CONFIG, HOME
from evaluation.everyday.understanding import planned
from services.planner.grammar.chunks import Chunk, chunks
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.parse import parse
from services.planner.world import World

VOCABULARY = Vocabulary(World(HOME), CONFIG)


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


def _plainly(words: tuple[str, ...]) -> list[str]:
    return [part.meant.text for part in parse(words, VOCABULARY) if part.meant.text]


@pytest.mark.parametrize(
    ("verb", "some"),
    [("toddling", "go"), ("lug", "bring"), ("deposited", "put"), ("rid", "discard"), ("scouting", "seek")],
)
def test_verbs_in_any_form_have_classes(verb: str, some: str) -> None:
    assert some in classes(verb)
    assert not classes("sing")


def test_things_and_places_are_found_among_any_words() -> None:
    found = chunks(_words("whisk my red mug off to the kitchen table chum"), VOCABULARY)
    assert found == [Chunk("thing", "my red mug", 1, 4), Chunk("spot", "the kitchen table", 6, 9)]


@pytest.mark.parametrize(
    ("said", "first"),
    [
        ("the recycling bin the red mug into it", "put the red mug on the recycling bin"),
        ("lug the red mug over to the desk", "put the red mug on the desk"),
        ("the red mug sorry the blue mug to the desk", "put the blue mug on the desk"),
        ("shuffle along to the desk", "go to the desk"),
        ("some order on the desk would not hurt", "tidy up the desk"),
        ("sing a song", ""),
    ],
)
def test_parts_make_a_plain_command(said: str, first: str) -> None:
    assert next(iter(_plainly(_words(said))), "") == first


@pytest.mark.parametrize(
    ("said", "plainly"),
    [
        ("red mug where", "where is the red mug"),
        ("what number of mugs is there on the desk", "how many mugs are there on the desk"),
    ],
)
def test_a_question_in_any_words_is_answered_as_the_plain_one(said: str, plainly: str) -> None:
    assert planned(said).steps == planned(plainly).steps != []


@pytest.mark.parametrize(
    "text", ["do not lug the mug", "he said lug the mug", "suppose i lugged the mug", "i lugged the mug here yesterday"]
)
def test_what_forbids_reports_or_supposes_is_seen(text: str) -> None:
    assert forbids(text)


def test_a_negation_of_ability_forbids_nothing() -> None:
    assert not forbids("i can not find the mug")


@pytest.mark.parametrize(("text", "told"), [("he is lugging mugs", True), ("you lugged it", True), ("lug it", False)])
def test_what_others_do_is_told(text: str, told: bool) -> None:
    assert is_told(_words(text)) == told


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ("be so good as to lug the red mug through to the desk", "put the red mug on the desk"),
        ("my nephew adores his red ball schlep it to the desk will you", "put the red ball on the desk"),
    ],
)
def test_a_guess_is_asked_about_and_not_carried_out(said: str, asked: str) -> None:
    found = planned(said)
    assert (found.steps, found.asks) == ([], asked)


def test_a_request_behind_a_question_is_not_dropped_with_an_answer() -> None:
    found = planned("what's standing to the left of the red can on the counter? bring me that")
    assert found.steps == [] and found.reason


@pytest.mark.parametrize(
    "said", ["hurl the mug at the ceiling", "he lugs the mug to the desk", "i plan to lug the mug to the desk"]
)
def test_of_what_is_no_request_nothing_is_guessed(said: str) -> None:
    found = planned(said)
    assert (found.steps, found.asks) == ([], "")


@pytest.mark.parametrize("said", ["bring me luck", "get a grip", "fetch some courage", "bring me a piece of advice"])
def test_what_cannot_be_carried_is_not_looked_for(said: str) -> None:
    assert planned(said).steps == []


@pytest.mark.parametrize("thing", ["tuna can", "watering can", "can of paint"])
def test_a_can_that_nobody_listed_is_looked_for(thing: str) -> None:
    assert [step.object for step in planned(f"can you bring me the {thing}").steps][:2] == [thing, thing]
    assert [step.object for step in planned("bring me the can if you can").steps][:1] == ["red can"]
