"""The table of wordings: each is well formed, planned or refused, and heard as it is understood."""

from typing import get_args

import pytest

from common.language.clauses import clauses
from common.language.meaning import asks_for, heard_parts, readings
from common.language.pattern import ANY, Node, Sequence, Slot, Word, first_words, parse
from common.language.simplify import simplified
from common.language.wording import Action, Wording
from common.language.wordings import INTERRUPTS, WORDINGS
from services.planner.grammar.rules import ACTIONS


def slots(node: Node) -> set[str]:
    match node:
        case Slot(name):
            return {name}
        case Word(_):
            return set()
        case _:
            return set[str]().union(*map(slots, node.parts if isinstance(node, Sequence) else node.options))


def test_every_action_is_planned_or_has_a_reason_against_it() -> None:
    assert {w.action for w in WORDINGS} == set(get_args(Action))
    assert {w.action for w in WORDINGS if not w.reason} == set(ACTIONS)
    assert not [w for w in WORDINGS if w.reason and w.action in ACTIONS]


def test_a_pattern_names_slots_that_the_planner_knows_and_hears_no_free_words() -> None:
    for wording in WORDINGS:
        assert slots(parse(wording.pattern)) <= {"thing", "spot", "words"}, wording
        assert "words" not in slots(parse(wording.heard)), f"{wording}: free words cannot be searched for"


@pytest.mark.parametrize("wording", [w for w in WORDINGS if w.heard], ids=lambda w: w.heard)
def test_what_is_heard_is_understood(wording: Wording) -> None:
    for sentence in sentences(parse(wording.heard)):
        assert wording.action in {w.action for w, _ in readings(sentence, "command", "reply", "name")}, sentence


FILLED = {"onto": ("on", "the", "table"), "near": ("next", "to", "the", "table")}


def sentences(node: Node) -> list[tuple[str, ...]]:
    """All sentences of a small pattern, each slot with one filling."""
    match node:
        case Word(text):
            return [(text,)]
        case Slot(name):
            return [FILLED.get(name, ("the", "mug"))]
        case Sequence(parts):
            found: list[tuple[str, ...]] = [()]
            for part in parts:
                found = [(*head, *tail) for head in found for tail in sentences(part)]
            return found
        case _:
            return [sentence for option in node.options for sentence in sentences(option)]


@pytest.mark.parametrize(
    ("text", "action"),
    [
        ("stop", "stop"),
        ("please stop it", "stop"),
        ("Stop, stop, stop!", "stop"),
        ("halt", "stop"),
        ("cancel that", "cancel"),
        ("robot, cancel it please", "cancel"),
        ("never mind", "cancel"),
        ("oh no, stop!", "stop"),
        ("hit the brakes", "stop"),
        ("stop what you're doing", "stop"),
        ("don't move", "stop"),
        ("actually, forget about it", "cancel"),
        ("bring me the apple", None),
        ("stop at the table", None),
        ("", None),
    ],
)
def test_stop_and_cancel_have_variants(text: str, action: str | None) -> None:
    assert asks_for(text, "stop", "cancel") == action


def test_what_is_heard_at_any_time_means_what_it_is_heard_for() -> None:
    for action, patterns in INTERRUPTS.items():
        for sentence in (s for pattern in patterns for s in sentences(parse(pattern))):
            assert asks_for(" ".join(sentence), "stop", "cancel") == action


def test_commands_and_what_is_said_by_itself_are_heard_apart() -> None:
    parts = heard_parts()
    assert "find <thing>" in parts["verb"] and "cancel [that] | never mind" in parts["utterance"]
    assert not set(parts["verb"]) & set(parts["utterance"])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("um, bring me, uh, the red mug", ["bring me and the red mug"]),
        ("I was wondering if you could fetch the apple", ["fetch the apple"]),
        ("would you be so kind as to bring me the mug when you get a moment?", ["bring me the mug"]),
        ("if you don't mind, tidy up", ["tidy up"]),
        ("could you, like, get the mug", ["get the mug"]),
        ("say um hello", ["say um hello"]),
        ("do you know where the mug is", ["do you know where the mug is"]),
    ],
)
def test_hesitation_and_politeness_are_no_words_of_a_command(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("take the apple out to the counter", "take the apple to the counter"),
        ("drive on over to the kitchen", "drive to the kitchen"),
        ("bring me over the red mug", "bring me the red mug"),
        ("possibly hand me the green can", "hand me the green can"),
        ("pick up the mug", "pick up the mug"),
        ("really", ""),
    ],
)
def test_a_second_try_leaves_adverbs_and_particles_out(text: str, expected: str) -> None:
    assert " ".join(simplified(tuple(text.split()))) == expected


def test_a_sentence_may_begin_with_a_slot() -> None:
    assert first_words(parse("<thing> belongs here | [now] go")) == {ANY, "now", "go"}
    assert first_words(parse("[please]")) == {"please", ""}
