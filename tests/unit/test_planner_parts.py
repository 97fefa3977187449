"""Forms, choices, words and plan checks by themselves."""

import pytest

from common.household import load_household
from common.language.clauses import clauses
from common.language.discourse import commands
from common.language.normalise import infinitive
from common.language.pattern import Pattern, PatternError, needed, parse
from common.messages import KnownWorld, PlanStep
from services.planner.choice_points import MAX_RUNS, ChoicePoints, every
from services.planner.config import PlannerConfig
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.language_model.prompt import Impossible, checked
from services.planner.world import believed

SCENE = load_household("apartment")


def readings(pattern: str, text: str) -> list[dict[str, str]]:
    return [{k: " ".join(v) for k, v in found.items()} for found in Pattern(pattern).matches(tuple(text.split()))]


def test_a_form_gives_every_reading_the_shortest_slot_first() -> None:
    found = readings("put <thing> (on | in) <spot>", "put the mug on the table in the kitchen")
    assert found == [
        {"thing": "the mug", "spot": "the table in the kitchen"},
        {"thing": "the mug on the table", "spot": "the kitchen"},
    ]
    assert readings("go [back] to <spot>", "go back to it") == [{"spot": "it"}]
    assert readings("come (here | back)", "come here") == [{}]
    assert readings("come (here | back)", "come") == []


def test_a_pattern_knows_which_words_it_cannot_do_without() -> None:
    assert needed(parse("(put | set) <thing> [down] on <spot>")) == {"on"}
    assert needed(parse("(go | drive) <spot>")) == {"go", "drive"}
    assert needed(parse("<thing> | stop")) == frozenset()


@pytest.mark.parametrize("pattern", ["go (home", "go [home", "go home)", "go ] home"])
def test_a_bad_form_is_named(pattern: str) -> None:
    with pytest.raises(PatternError, match="pattern"):
        Pattern(pattern)


def test_choices_run_through_every_combination_in_order() -> None:
    def run(choices: ChoicePoints) -> str:
        first = choices.pick("ab")
        return first + choices.pick("xyz") if first == "a" else first

    assert list(every(run)) == ["ax", "ay", "az", "b"]
    assert len(list(every(lambda c: [c.pick(range(9)) for _ in range(9)]))) == MAX_RUNS


def test_a_trial_that_is_dropped_leaves_no_choice_behind() -> None:
    choices = ChoicePoints()
    trial = choices.fork()
    trial.pick("abc")
    assert choices.taken == [] and trial.taken == [(0, 3)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Hey Jarvis, could you please bring me the mug?", ["bring me the mug"]),
        ("go home, then wait; come back!", ["go home", "wait", "come back"]),
        ("take the mug, the can, and the ball", ["take the mug and the can and the ball"]),
        ("say hello, then goodbye", ["say hello, then goodbye"]),
        ("what's that", ["what is that"]),
        ("please", []),
        ("...", []),
    ],
)
def test_sentences_are_cut_into_commands(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


def test_verbs_lose_their_ing() -> None:
    verbs = {"bring", "take", "put", "tidy"}
    assert [infinitive(w, verbs) for w in ("bringing", "taking", "putting", "tidying", "king", "bring")] == [
        "bring", "take", "put", "tidy", "king", "bring",
    ]  # fmt: skip


def steps_of(*rows: tuple[str, str, str]) -> list[PlanStep]:
    return [PlanStep(action=a, object=o, target=t) for a, o, t in rows]  # type: ignore[arg-type]


def check(*rows: tuple[str, str, str], held: str = "") -> list[PlanStep]:
    world = believed(SCENE, KnownWorld(held=held), [])
    return checked(steps_of(*rows), world, Vocabulary(world, PlannerConfig()), 10)


def test_checked_steps_carry_the_names_of_the_scene() -> None:
    steps = check(("find", "Red Cup", ""), ("grasp", "red mug", ""), ("place", "", "worktop"), ("navigate", "", "dock"))
    assert steps == steps_of(
        ("find", "red mug", ""), ("grasp", "red mug", ""), ("place", "", "counter"), ("return", "", "")
    )
    assert check(("navigate", "apple", ""))[0].object == "apple"
    assert check(("find", "mug", ""))[0].object == "mug"


@pytest.mark.parametrize(
    ("rows", "reason"),
    [
        ([("find", "", "")], "no object is named"),
        ([("grasp", "red mug", "")], "must be found"),
        ([("find", "red mug", ""), ("grasp", "red mug", ""), ("release", "", ""), ("release", "", "")], "step 4"),
        ([("wait", "", "")] * 11, "11 steps"),
    ],
)
def test_impossible_steps_are_named(rows: list[tuple[str, str, str]], reason: str) -> None:
    with pytest.raises(Impossible, match=reason):
        check(*rows)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("do not bring me the mug until you have tidied the desk", ["tidy the desk", "bring me the mug"]),
        ("do not bring me the mug until i say so", ["do not bring me the mug until i say so"]),
        ("bring me the can. scratch that. go to the desk", ["go to the desk"]),
        ("the blue can. scratch that. the red one. final answer, the green one", ["the green can"]),
        ("go to the desk and say hello when you get there", ["go to the desk and say hello"]),
        ("go to the desk and when you are there look around", ["go to the desk and look around"]),
        ("bring me the can. the green one is mine", ["bring me the can", "the green one is mine"]),
    ],
)
def test_what_is_put_off_or_taken_back_is_not_done_first(text: str, expected: list[str]) -> None:
    assert commands(text) == expected
