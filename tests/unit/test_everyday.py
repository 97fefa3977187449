"""Everyday sentences: at least nine in ten are understood, and none leads to a wrong action."""

import pytest

from common.language.discourse import commands
from common.language.exchange import replaced
from common.language.meaning import is_question
from common.language.quantities import duration
from services.brain.language.interjection import interjection
from services.planner.grammar.spelling import corrected, distance
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.forms import tokens
from services.planner.semantic.parse import parse
from services.planner.world import World
from tests.everyday import CONFIG, HOME, Sentence, planned, sentences, understand, verdict

LISTS = ("everyday_sentences.tsv", "more_everyday_sentences.tsv", "last_everyday_sentences.tsv")
CLOSING = ("sealed_everyday_sentences.tsv", "closing_everyday_sentences.tsv")
LOTS = ("neighbours_everyday_sentences.tsv", "visitors_everyday_sentences.tsv")
SEASONS = tuple(f"{season}_everyday_sentences.tsv" for season in ("spring", "summer", "autumn", "winter", "evening"))
ENOUGH = 0.9


@pytest.mark.parametrize("name", LISTS)
def test_everyday_sentences(name: str) -> None:
    rows = sentences(name)
    verdicts = {row: verdict(row, understand(row)) for row in rows}
    assert not [row for row, v in verdicts.items() if v == "wrong"]
    missed = [row for row, v in verdicts.items() if v != "right"]
    assert len(missed) <= (1 - ENOUGH) * len(rows), "\n".join(map(str, missed))


def test_sentences_that_nobody_worked_on() -> None:
    rows = sentences("unseen_everyday_sentences.tsv")
    verdicts = [verdict(row, understand(row)) for row in rows]
    assert verdicts.count("right") >= 50 and verdicts.count("wrong") <= 1, "50 of 60 when they were first tried"


@pytest.mark.slow
@pytest.mark.parametrize(("name", "right", "wrong"), [(LOTS[0], 90, 2), (LOTS[1], 84, 3)])
def test_two_halves_of_one_list(name: str, right: int, wrong: int) -> None:
    """The first was worked on; the second is sealed: what is lost of it was never won by a look at it."""
    verdicts = [verdict(row, understand(row)) for row in sentences(name)]
    assert verdicts.count("right") >= right and verdicts.count("wrong") <= wrong


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "understood", "wrong"),
    [
        ("porch_everyday_sentences.tsv", 380, 12),
        ("doorstep_everyday_sentences.tsv", 64, 1),
        ("morning_everyday_sentences.tsv", 156, 1),
        ("garden_everyday_sentences.tsv", 95, 0),
        ("attic_everyday_sentences.tsv", 54, 1),
    ],
)
def test_what_is_not_understood_at_once_is_mostly_asked_about(name: str, understood: int, wrong: int) -> None:
    """The first was worked on, but for readings that its notation cannot express; the second was sealed meanwhile."""
    verdicts = [verdict(row, understand(row)) for row in sentences(name)]
    assert verdicts.count("right") + verdicts.count("asked rightly") >= understood
    assert verdicts.count("wrong") <= wrong


def test_what_asks_for_nothing_sets_nothing_in_motion() -> None:
    rows = sentences("nothing_to_do.tsv")
    assert not [row for row in rows if row.right == "none()" and verdict(row, understand(row)) == "wrong"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["seven_lists.tsv", "development_sentences.tsv", *CLOSING, *SEASONS])
def test_lists_of_many_speakers(name: str) -> None:
    rows = sentences(name)
    verdicts = {row: verdict(row, understand(row)) for row in rows}
    wrong = [row for row, v in verdicts.items() if v == "wrong"]
    assert len(wrong) <= 0.01 * len(rows), wrong
    assert len([v for v in verdicts.values() if v == "right"]) >= 0.94 * len(rows)


@pytest.mark.parametrize(
    ("said", "acts"),
    [
        ("if there is a mug on the counter bring it to me", ["find blue mug", "grasp blue mug", "return", "release"]),
        ("if there is a banana on the counter bring it to me", ["navigate counter", "wait", "say"]),
        ("if there is a banana on the counter bring it, otherwise go to the desk", ["navigate desk"]),
    ],
)
def test_a_condition_is_looked_into(said: str, acts: list[str]) -> None:
    found = planned(said)
    done = [*found.looks, *found.steps]
    shown = [" ".join(filter(None, (s.action, s.object or s.target))) for s in done]
    assert shown[-len(acts) :] == acts


def test_the_judge_of_sentences_can_say_no() -> None:
    first = sentences("everyday_sentences.tsv")[0]
    assert verdict(first, understand(first)) == "right"
    assert verdict(first._replace(right="fetch(green can)"), understand(first)) == "wrong"
    assert verdict(first._replace(right="put(red mug, counter)"), understand(first)) == "wrong"
    lost = first._replace(said="sing me a song of the sea and the sky")
    assert verdict(lost, understand(lost)) == "not understood"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("not the red mug, the blue one", ["the blue mug"]),
        ("bring me the red mug no wait the blue one", ["bring me the blue mug"]),
        ("do not bring me the red mug, bring the blue one", ["bring the blue mug"]),
        ("put the apple on the desk, sorry, on the counter", ["put the apple on the counter"]),
        ("bring me the blue one, the block i mean", ["bring me the blue block"]),
        ("bring me the blue one, sorry, the block", ["bring me the block"]),
        ("instead of the red mug bring me the blue one", ["bring me the blue mug"]),
        ("instead of bringing me the apple put it on the counter", ["put the apple on the counter"]),
        ("put the ball in the toy box instead of on the shelf", ["put the ball in the toy box"]),
        ("toys do not belong on the shelf, they go in the toy box", ["toys go in the toy box"]),
        ("not here, on the desk", ["on the desk"]),
        ("whatever you do do not touch the apple", ["do not touch the apple"]),
        ("where is the apple i would like it", ["where is the apple", "i would like it"]),
        ("is there a can if so bring it", ["if there is a can", "bring it"]),
        (
            "are there any blocks on the shelf, put them in the box if there are",
            ["if there is any blocks on the shelf", "put them in the box"],
        ),
        ("bring me the mug wait i have got it here already", ["never mind"]),
        ("take the can to the kitchen, actually forget it", ["never mind"]),
        ("put the mug on the counter and leave it there", ["put the mug on the counter"]),
        ("mum wants to know where the apple is", ["where the apple is"]),
        ("rather than the can i would have the blue bottle", ["i would have the blue bottle"]),
        ("put the apple on the desk, sorry, the counter", ["put the apple on the counter"]),
        ("bring me the mug, I mean go to the kitchen", ["go to the kitchen"]),
        ("before you come back put the mug in the bin", ["put the mug in the bin", "come back"]),
        ("after you have brought me the mug, go to the kitchen", ["bring me the mug", "go to the kitchen"]),
        ("go to the kitchen, wait, and come back", ["go to the kitchen and wait and come back"]),
        ("say sorry, I mean it", ["say sorry, i mean it"]),
        ("bring me a mug or a can", ["bring me a mug or a can"]),
    ],
)
def test_what_is_meant_in_the_end(text: str, expected: list[str]) -> None:
    assert commands(text, lambda words: words == ("counter",)) == expected


@pytest.mark.parametrize(
    ("context", "said", "acts"),
    [
        ("-", "get the box with my vitamins", ["find orange box", "grasp orange box", "return", "release"]),
        ("-", "is there anything to drink if so bring me one",
         ["find green can", "grasp green can", "return", "release"]),
        ("-", "if the red mug is in the kitchen leave it there otherwise bring it to me",
         ["find red mug", "grasp red mug", "return", "release"]),
        ("-", "mugs should always go back to the counter", ["rule mugs"]),
        ("-", "forget that it's called vitamin box", ["forget"]),
        ("failed:put the red mug on the counter", "try the desk",
         ["navigate desk", "find red mug", "grasp red mug", "place red mug"]),
        ("last:put the red mug on the desk", "no next to the apple",
         ["find red mug", "grasp red mug", "place red mug"]),
        ("last:bring me the white mug", "the other one please", []),
        ("busy:put the apple on the desk", "and the ball too", ["find red ball", "grasp red ball", "place red ball"]),
        ("-", "let me put the can in the bin", []),
        ("-", "bring me the apple i don't want it any more", []),
        ("-", "he wants to know if you can bring the mug", []),
        ("-", "are you a machine", ["say"]),
        ("last:bring me the apple", "leave the vitamin box where it is", []),
        ("-", "if there is anything on the desk put it on the counter",
         ["find white mug", "grasp white mug", "place white mug", "find orange box", "grasp orange box",
          "place orange box"]),
    ],
)  # fmt: skip
def test_one_part_tells_what_another_means(context: str, said: str, acts: list[str]) -> None:
    found = understand(Sentence(context, said, ""))
    assert [" ".join(filter(None, (s.action, s.object or s.target))) for s in found.steps] == acts


@pytest.mark.parametrize("said", ["quit putting the apple in the bin", "there is no point in fetching the apple",
                                  "it would be a mistake to throw the can away", "let me get the apple",
                                  "what if i put the ball in the toy box", "no need to bring the mug"])  # fmt: skip
def test_nothing_is_offered_that_was_not_asked_for(said: str) -> None:
    assert not planned(said).asks


def test_what_names_nothing_replaces_nothing() -> None:
    assert replaced("come back", "the blue one") is None
    assert replaced("bring me the mug", "") is None


@pytest.mark.parametrize(
    ("words", "seconds"),
    [
        ("five seconds", 5), ("a minute", 60), ("a minute and a half", 90), ("half a minute", 30), ("90 seconds", 90),
        ("twenty five seconds", 25), ("a couple of minutes", 120), ("a hundred seconds", 100), ("two hours", 7200),
        ("the bus", None), ("five", None), ("seconds", 1), ("", None),
    ],
)  # fmt: skip
def test_durations(words: str, seconds: float | None) -> None:
    assert duration(tuple(words.split())) == seconds


def test_edit_distance_counts_slips() -> None:
    assert [distance("the", w) for w in ("the", "teh", "he", "thee", "tha", "")] == [0, 1, 1, 1, 1, 3]


def test_slips_are_undone_and_names_are_told_apart() -> None:
    plain, names = {"bring", "the", "blue"}, {"bottle", "can", "mug"}
    assert corrected(["brng", "teh", "blu", "bottle"], plain, names) == (["bring", "the", "blue", "bottle"], False)
    assert corrected(["the", "botle"], plain, names) == (["the", "bottle"], True)
    assert corrected(["the", "cat"], plain, names) == (["the", "cat"], False), "short names are left alone"


def test_a_slip_in_a_name_is_asked_about_and_taken_literally_after_a_no() -> None:
    asked = planned("bring me the bowle")
    assert (asked.steps, asked.asks) == ([], "bring me the bowl")
    assert planned("brinng me teh bowl").steps


@pytest.mark.parametrize(
    ("said", "kind", "text"),
    [
        ("stop", "stop", "stop"),
        ("never mind", "cancel", "never mind"),
        ("then go to the kitchen", "queue", "go to the kitchen"),
        ("when you're done, go to the kitchen", "queue", "go to the kitchen"),
        ("go to the kitchen afterwards", "queue", "go to the kitchen"),
        ("bring me the apple", "queue", "bring me the apple"),
        ("no, bring me the apple instead", "replace", "bring me the apple"),
        ("forget that, bring me the apple", "replace", "bring me the apple"),
        ("what are you doing", "aside", "what are you doing"),
        ("where is the apple", "aside", "where is the apple"),
        ("hang on", "stop", "hang on"),
        ("wait for me in the kitchen", "queue", "wait for me in the kitchen"),
        ("do not bring it to me, put it on the desk", "replace", "do not bring it to me, put it on the desk"),
        ("instead of the can bring the mug", "replace", "bring the mug"),
        ("hurry up", "encouragement", "hurry up"),
        ("i meant the toy box", "replace", "i meant the toy box"),
        ("make it the kitchen table instead", "replace", "make it the kitchen table"),
    ],
)
def test_what_is_said_to_a_robot_at_work(said: str, kind: str, text: str) -> None:
    found = interjection(said)
    assert (found.kind, found.text) == (kind, text)


@pytest.mark.parametrize(
    ("said", "kind"),
    [
        ("don't put it on the desk", "cancel"), ("stop putting the apple on the desk", "cancel"),
        ("you needn't bring it", "cancel"), ("leave the apple alone", "cancel"), ("please don't", "stop"),
        ("don't touch the apple", "cancel"), ("no need to put it there", "cancel"), ("don't drop it", "queue"),
        ("don't put the ball in the toy box", "queue"), ("no stop bring me the can", "replace"),
        ("stop what you are doing and come here", "replace"),
    ],
)  # fmt: skip
def test_what_is_forbidden_at_work_is_not_gone_on_with(said: str, kind: str) -> None:
    assert interjection(said, "put the apple on the desk").kind == kind


def test_one_thing_is_spared_of_many_under_way() -> None:
    assert interjection("don't touch the box", "tidy up the desk").text == "tidy up the desk except the box"
    assert interjection("don't tidy the desk", "tidy up the desk").kind == "cancel"


def test_questions_and_orders_are_told_apart() -> None:
    for text in (
        "what's up with the mug",
        "why?",
        "Is the apple there?",
        "did you do it",
        "could you tell me who is there",
    ):
        assert is_question(text), text
    for text in ("how about the apple", "could you bring me the mug", "bring me what is on the table", "go on"):
        assert not is_question(text), text


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("the kitchen table would look better with the red mug on it", "put the red mug on the kitchen table"),
        ("my throat is dry", "bring me something to drink"),
        ("relocate yourself to the bedroom", "go to the bedroom"),
        ("the capital of france is paris", ""),
        ("anything", ""),
    ],
)
def test_a_paraphrase_means_the_likeliest_command(said: str, meant: str) -> None:
    parts = parse(tokens(said), Vocabulary(World(HOME), CONFIG))
    assert next((part.meant.text for part in parts if part.meant.text), "") == meant
